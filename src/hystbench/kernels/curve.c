/* The curve through the samples of a record: weights of a window of samples, and linear
 * systems that it drives. v holds n samples and those of the window's rest; the window
 * of sample k begins at v[k], its oldest sample first. */
#include "lanes.h"

/* out[row][k] = sum_j weights[row][j] v[k + j] */
EXPORT void hb_weighed(index_t n, index_t points, index_t rows, const double *weights,
                       const double *v, double *out)
{
    for (index_t row = 0; row < rows; row++) {
        const double *own = weights + row * points;
        double *to = out + row * n;
        index_t k = 0;
        for (; k + LANES <= n; k += LANES) {
            lanes even = {0}, odd = {0};
            for (index_t j = 0; j + 1 < points; j += 2) {
                even += load(v + k + j) * own[j];
                odd += load(v + k + j + 1) * own[j + 1];
            }
            if (points % 2) even += load(v + k + points - 1) * own[points - 1];
            store(to + k, even + odd);
        }
        for (; k < n; k++) {
            double even = 0, odd = 0;
            for (index_t j = 0; j + 1 < points; j += 2) {
                even += v[k + j] * own[j];
                odd += v[k + j + 1] * own[j + 1];
            }
            if (points % 2) even += v[k + points - 1] * own[points - 1];
            to[k] = even + odd;
        }
    }
}

/* out[k] = sum_j taps[j] v[step k + j]: a symmetrical filter, read every step samples. */
EXPORT void hb_decimated(index_t n, index_t step, index_t points, const double *taps,
                         const double *v, double *out)
{
    for (index_t k = 0; k < n; k++) {
        const double *own = v + step * k;
        lanes even = {0}, odd = {0};
        index_t j = 0;
        for (; j + 2 * LANES <= points; j += 2 * LANES) {
            even += load(taps + j) * load(own + j);
            odd += load(taps + j + LANES) * load(own + j + LANES);
        }
        double rest = 0;
        for (; j < points; j++) rest += taps[j] * own[j];
        out[k] = sum(even + odd) + rest;
    }
}

/* Both systems below begin at rest at the first sample:
 * x(k) = A x(k-1) + sum_j drive[j] v[k + j], y(k) = C x(k) + D v[k + now].
 * All vectors of states are padded with zeros to a multiple of WIDTH. */
INLINE lanes driven(const double *drive, const double *v, index_t points, index_t size)
{
    lanes even = {0}, odd = {0};
    for (index_t j = 0; j < points; j += 2) {
        even += load(drive + j * size) * v[j];
        odd += load(drive + (j + 1) * size) * v[j + 1];
    }
    return even + odd;
}

INLINE index_t curve_modes(index_t n, index_t points, index_t now, const double *factors,
                           const double *drive, const double *c, double d,
                           const double *v, double *y, index_t vectors)
{
    const index_t size = vectors * LANES;
    double x[size] ALIGNED;
    for (index_t j = 0; j < size; j++) x[j] = 0;
    for (index_t k = 0; k < n; k++) {
        lanes output = {0};
        UNROLL
        for (index_t j = 0; j < size; j += LANES) {
            if (k > 0)
                store(x + j, load(factors + j) * load(x + j) +
                                 driven(drive + j, v + k, points, size));
            output += load(c + j) * load(x + j);
        }
        y[k] = sum(output) + d * v[k + now];
    }
    return n;
}

/* A is diagonal, factors holds its diagonal; points is even. */
EXPORT index_t hb_curve_modes(index_t n, index_t points, index_t now, index_t wide,
                              const double *factors, const double *drive,
                              const double *c, double d, const double *v, double *y)
{
#define CALL(size) curve_modes(n, points, now, factors, drive, c, d, v, y, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

INLINE index_t curve_space(index_t n, index_t points, index_t now, const double *a,
                           const double *drive, const double *c, double d,
                           const double *v, double *y, index_t vectors)
{
    const index_t size = vectors * LANES;
    double x[size] ALIGNED;
    lanes next[vectors];
    for (index_t j = 0; j < size; j++) x[j] = 0;
    for (index_t k = 0; k < n; k++) {
        lanes output = {0};
        if (k > 0) {
            UNROLL
            for (index_t j = 0; j < vectors; j++) {
                const double *column = a + j * LANES;
                lanes even = driven(drive + j * LANES, v + k, points, size), odd = {0};
                UNROLL
                for (index_t i = 0; i < size; i += 2) {
                    even += load(column + i * size) * x[i];
                    odd += load(column + (i + 1) * size) * x[i + 1];
                }
                next[j] = even + odd;
            }
            UNROLL
            for (index_t j = 0; j < vectors; j++) store(x + j * LANES, next[j]);
        }
        UNROLL
        for (index_t j = 0; j < size; j += LANES) output += load(c + j) * load(x + j);
        y[k] = sum(output) + d * v[k + now];
    }
    return n;
}

/* a holds the columns of A; points is even. */
EXPORT index_t hb_curve_space(index_t n, index_t points, index_t now, index_t wide,
                              const double *a, const double *drive, const double *c,
                              double d, const double *v, double *y)
{
#define CALL(size) curve_space(n, points, now, a, drive, c, d, v, y, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

/* The curve through the samples of a record: weights of a window of samples, and linear
 * systems that it drives. v holds n samples and those of the window's rest; the window
 * of sample k begins at v[k], its oldest sample first. */
#include "lanes.h"

/* sum_j weights[j] v[j], and the same of the samples behind it, LANES or several times
 * as many at once. Even and odd j are summed apart, whatever is taken at once. */
INLINE double weighed(index_t points, const double *weights, const double *v)
{
    double even = 0, odd = 0;
    for (index_t j = 0; j + 1 < points; j += 2) {
        even += v[j] * weights[j];
        odd += v[j + 1] * weights[j + 1];
    }
    if (points % 2) even += v[points - 1] * weights[points - 1];
    return even + odd;
}
#define AT_ONCE 4
INLINE void weighed_many(index_t points, const double *weights, const double *v,
                         double *out, index_t vectors)
{
    lanes even[AT_ONCE] = {{0}}, odd[AT_ONCE] = {{0}};
    for (index_t j = 0; j + 1 < points; j += 2) {
        UNROLL
        for (index_t i = 0; i < vectors; i++) {
            even[i] += load(v + i * LANES + j) * weights[j];
            odd[i] += load(v + i * LANES + j + 1) * weights[j + 1];
        }
    }
    if (points % 2)
        for (index_t i = 0; i < vectors; i++)
            even[i] += load(v + i * LANES + points - 1) * weights[points - 1];
    UNROLL
    for (index_t i = 0; i < vectors; i++) store(out + i * LANES, even[i] + odd[i]);
}
INLINE void weighed_all(index_t n, index_t points, const double *weights,
                        const double *v, double *out)
{
    index_t k = 0;
    for (; k + AT_ONCE * LANES <= n; k += AT_ONCE * LANES)
        weighed_many(points, weights, v + k, out + k, AT_ONCE);
    for (; k + LANES <= n; k += LANES) weighed_many(points, weights, v + k, out + k, 1);
    for (; k < n; k++) out[k] = weighed(points, weights, v + k);
}

/* out[row][k] = sum_j weights[row][j] v[k + j] */
EXPORT void hb_weighed(index_t n, index_t points, index_t rows, const double *weights,
                       const double *v, double *out)
{
    for (index_t row = 0; row < rows; row++)
        weighed_all(n, points, weights + row * points, v, out + row * n);
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

/* The same for LANES states of diagonal A and a piece of samples: what they add to the
 * output. The drive is read once for several samples. */
#define PIECE 128
INLINE void modes_piece(index_t count, index_t points, index_t size, index_t rests,
                        const double *factors, const double *drive, const double *c,
                        const double *v, double *state, lanes *outputs)
{
    const lanes factor = load(factors), weight = load(c);
    lanes x = load(state);
    for (index_t k = 0; k < count; k += AT_ONCE) {
        lanes even[AT_ONCE] = {{0}}, odd[AT_ONCE] = {{0}};
        const index_t many = count - k < AT_ONCE ? count - k : AT_ONCE;
        if (many == AT_ONCE)
            for (index_t j = 0; j < points; j += 2) {
                const lanes first = load(drive + j * size);
                const lanes second = load(drive + (j + 1) * size);
                UNROLL
                for (index_t i = 0; i < AT_ONCE; i++) {
                    even[i] += first * v[k + i + j];
                    odd[i] += second * v[k + i + j + 1];
                }
            }
        else
            for (index_t i = 0; i < many; i++)
                even[i] = driven(drive, v + k + i, points, size);
        for (index_t i = 0; i < many; i++) {
            if (k + i >= rests) x = factor * x + (even[i] + odd[i]);
            outputs[k + i] += weight * x;
        }
    }
    store(state, x);
}

INLINE index_t curve_modes(index_t n, index_t points, index_t now, const double *factors,
                           const double *drive, const double *c, double d,
                           const double *v, double *y, index_t vectors)
{
    const index_t size = vectors * LANES;
    double x[size] ALIGNED;
    lanes outputs[PIECE];
    for (index_t j = 0; j < size; j++) x[j] = 0;
    for (index_t start = 0; start < n; start += PIECE) {
        const index_t count = n - start < PIECE ? n - start : PIECE;
        for (index_t k = 0; k < count; k++) outputs[k] = (lanes){0};
        for (index_t j = 0; j < size; j += LANES)
            modes_piece(count, points, size, start == 0, factors + j, drive + j, c + j,
                        v + start, x + j, outputs);
        for (index_t k = 0; k < count; k++)
            y[start + k] = sum(outputs[k]) + d * v[start + k + now];
    }
    return n;
}

/* So few states would leave most lanes idle: there these take samples instead. */
#define FEW 3
#define WINDOW 64
INLINE index_t curve_few(index_t n, index_t points, index_t now, const double *a,
                         const double *drive, const double *c, double d,
                         const double *v, double *y, index_t states, int apart)
{
    double taps[FEW][WINDOW], driven_by[FEW][PIECE], x[FEW] = {0};
    for (index_t i = 0; i < states; i++)
        for (index_t j = 0; j < points; j++) taps[i][j] = drive[j * WIDTH + i];
    for (index_t start = 0; start < n; start += PIECE) {
        const index_t count = n - start < PIECE ? n - start : PIECE;
        for (index_t i = 0; i < states; i++)
            weighed_all(count, points, taps[i], v + start, driven_by[i]);
        if (start == 0) /* at rest */
            for (index_t i = 0; i < states; i++) driven_by[i][0] = 0;
        for (index_t k = 0; k < count; k++) {
            double output = 0, next[FEW];
            UNROLL
            for (index_t i = 0; i < states; i++) {
                next[i] = driven_by[i][k];
                for (index_t j = 0; j < states; j++)
                    if (!apart || i == j) next[i] += a[apart ? i : j * WIDTH + i] * x[j];
                output += c[i] * next[i];
            }
            copy(states, next, x);
            y[start + k] = output + d * v[start + k + now];
        }
    }
    return n;
}

#define FOR_FEW(states, a, apart)                                                       \
    if (points <= WINDOW) switch (states) {                                             \
        case 1: return curve_few(n, points, now, a, drive, c, d, v, y, 1, apart);       \
        case 2: return curve_few(n, points, now, a, drive, c, d, v, y, 2, apart);       \
        case FEW: return curve_few(n, points, now, a, drive, c, d, v, y, FEW, apart);   \
        }

/* A is diagonal, factors holds its diagonal of so many modes; points is even. */
EXPORT index_t hb_curve_modes(index_t n, index_t points, index_t now, index_t modes,
                              const double *factors, const double *drive,
                              const double *c, double d, const double *v, double *y)
{
    FOR_FEW(modes, factors, 1)
    const index_t wide = (modes + WIDTH - 1) / WIDTH;
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
EXPORT index_t hb_curve_space(index_t n, index_t points, index_t now, index_t states,
                              const double *a, const double *drive, const double *c,
                              double d, const double *v, double *y)
{
    FOR_FEW(states, a, 0)
    const index_t wide = (states + WIDTH - 1) / WIDTH;
#define CALL(size) curve_space(n, points, now, a, drive, c, d, v, y, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

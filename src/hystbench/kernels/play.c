/* Play operators and the Prandtl-Ishlinskii models made of them. */
#include "lanes.h"

/* Eq. 12 as Eq. 4: where the input rises the left envelope is taken out of the
 * way, where it falls the right one, where it rests both. */
EXPORT void hb_follow_direction(index_t n, const double *v, double *left, double *right)
{
    for (index_t k = 1; k < n; k++) {
        double change = v[k] - v[k - 1];
        left[k] = change < 0 ? left[k] : INFINITY;
        right[k] = change > 0 ? right[k] : -INFINITY;
    }
}

/* Outputs (n, m) of m operators; state (m) goes in and out. */
EXPORT void hb_play(index_t n, index_t m, const double *left, const double *right,
                    const double *restrict r, double *restrict state,
                    double *restrict out)
{
    for (index_t k = 0; k < n; k++)
        for (index_t i = 0; i < m; i++) {
            double low = right[k] - r[i], high = left[k] + r[i];
            double w = high < state[i] ? high : state[i];
            w = low > w ? low : w;
            state[i] = out[k * m + i] = w;
        }
}

INLINE index_t prandtl_ishlinskii(index_t n, const double *left, const double *right,
                                  const double *r, const double *weights, double *state,
                                  double *y, index_t vectors)
{
    lanes own[6];
    lanes *w = vectors <= 6 ? own : (lanes *)state;
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) w[j] = load(state + j * WIDTH);
    for (index_t k = 0; k < n; k++) {
        lanes total = {0}, gl = fill(left[k]), gr = fill(right[k]);
#pragma GCC unroll 6
        for (index_t j = 0; j < vectors; j++) {
            w[j] = play_step(gl, gr, load(r + j * WIDTH), w[j]);
            total += w[j] * load(weights + j * WIDTH);
        }
        y[k] = sum(total);
    }
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) store(state + j * WIDTH, w[j]);
    return n;
}

/* Eq. 9: y = sum of weight times operator; r, weights, state padded to WIDTH. */
EXPORT index_t hb_prandtl_ishlinskii(index_t n, index_t vectors, const double *left,
                                     const double *right, const double *r,
                                     const double *weights, double *state, double *y)
{
#define CALL(size) prandtl_ishlinskii(n, left, right, r, weights, state, y, size)
    FOR_VECTORS(vectors, CALL)
#undef CALL
}

INLINE index_t rate_dependent(index_t n, index_t first, index_t count, const double *left,
                              const double *right, const double *spacing,
                              const double *ratio, double *state, double *y,
                              index_t vectors)
{
    lanes own[6];
    lanes *w = vectors <= 6 ? own : (lanes *)state;
    const lanes number = {0, 1, 2, 3, 4, 5, 6, 7};
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) w[j] = load(state + j * WIDTH);
    for (index_t k = 0; k < n; k++) {
        lanes gl = fill(left[k]), gr = fill(right[k]), total = {0};
        double q = ratio[k], q2 = q * q, q4 = q2 * q2;
        lanes power = {1, q, q2, q2 * q, q4, q4 * q, q4 * q2, q4 * q2 * q};
        if (first) power *= q;
#pragma GCC unroll 6
        for (index_t j = 0; j < vectors; j++) {
            lanes place = number + (double)(j * WIDTH);
            masks used = place < (double)count;
            w[j] = play_step(gl, gr, (place + (double)first) * spacing[k], w[j]);
            w[j] = choose(used, w[j], (lanes){0});
            total += w[j] * power;
            power *= q4 * q4;
        }
        y[k] = sum(total);
    }
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) store(state + j * WIDTH, w[j]);
    return n;
}

/* y = sum over i = first .. first + count - 1 of ratio^i times the operator of
 * threshold i * spacing, both changing from sample to sample. */
EXPORT index_t hb_rate_dependent(index_t n, index_t vectors, index_t first, index_t count,
                                 const double *left, const double *right,
                                 const double *spacing, const double *ratio,
                                 double *state, double *y)
{
#define CALL(size) \
    rate_dependent(n, first, count, left, right, spacing, ratio, state, y, size)
    FOR_VECTORS(vectors, CALL)
#undef CALL
}

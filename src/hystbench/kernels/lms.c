/* The LMS loop, Eqs. 13 and 18: predict, compare, correct.
 *
 * Each function returns the number of samples it took: fewer than n where the
 * error grew past the limit or is not a number at all.  Weights are then those
 * that made the bad prediction.
 */
#include "lanes.h"


INLINE index_t lms_rows(index_t n, const double *rows, index_t stride, const double *d,
                        const double *step, double regularization, double limit,
                        double *weights, double *y, double *e, index_t vectors)
{
    lanes own[6];
    lanes *w = vectors <= 6 ? own : (lanes *)weights;
    index_t k;
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) w[j] = load(weights + j * WIDTH);
    for (k = 0; k < n; k++) {
        const double *h = rows + k * stride;
        lanes total = {0};
#pragma GCC unroll 6
        for (index_t j = 0; j < vectors; j++) total += w[j] * load(h + j * WIDTH);
        double output = sum(total), error = d[k] - output;
        if (diverged(error, limit)) break;
        y[k] = output;
        e[k] = error;
        if (regularization >= 0) {
            lanes power = {0};
#pragma GCC unroll 6
            for (index_t j = 0; j < vectors; j++) {
                lanes used = choose(load(step + j * WIDTH) != 0.0,
                                    load(h + j * WIDTH), (lanes){0});
                power += used * used;
            }
            error /= regularization + sum(power);
        }
#pragma GCC unroll 6
        for (index_t j = 0; j < vectors; j++)
            w[j] += error * (load(step + j * WIDTH) * load(h + j * WIDTH));
    }
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) store(weights + j * WIDTH, w[j]);
    return k;
}

/* Regressor k is rows[k * stride], padded to WIDTH; with stride 1 a delay line.
 * step is 2 mu for each weight and zero in the padding.  A regularization of
 * zero or more makes it the normalized LMS. */
EXPORT index_t hb_lms_rows(index_t n, index_t vectors, const double *rows, index_t stride,
                           const double *d, const double *step, double regularization,
                           double limit, double *weights, double *y, double *e)
{
#define CALL(size) \
    lms_rows(n, rows, stride, d, step, regularization, limit, weights, y, e, size)
    FOR_VECTORS(vectors, CALL)
#undef CALL
}

INLINE index_t lms_play(index_t n, const double *left, const double *right, int delayed,
                        const double *d, const double *r, double step,
                        double regularization, double limit, double *state,
                        double *weights, double *y, double *e, index_t vectors)
{
    lanes own_w[6], own_h[6];
    lanes *w = vectors <= 6 ? own_w : (lanes *)weights;
    lanes *h = vectors <= 6 ? own_h : (lanes *)state;
    index_t k;
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) {
        w[j] = load(weights + j * WIDTH);
        h[j] = load(state + j * WIDTH);
    }
    for (k = 0; k < n; k++) {
        lanes total = {0};
#pragma GCC unroll 6
        for (index_t j = 0; j < vectors; j++) {
            lanes gl = delayed ? load(left + k + j * WIDTH) : fill(left[k]);
            lanes gr = delayed ? load(right + k + j * WIDTH) : fill(right[k]);
            h[j] = play_step(gl, gr, load(r + j * WIDTH), h[j]);
            total += w[j] * h[j];
        }
        double output = sum(total), error = d[k] - output;
        if (diverged(error, limit)) break;
        y[k] = output;
        e[k] = error;
        double change = step * error;
        if (regularization >= 0) {
            lanes power = {0};
#pragma GCC unroll 6
            for (index_t j = 0; j < vectors; j++) power += h[j] * h[j];
            change /= regularization + sum(power);
        }
#pragma GCC unroll 6
        for (index_t j = 0; j < vectors; j++) w[j] += change * h[j];
    }
#pragma GCC unroll 6
    for (index_t j = 0; j < vectors; j++) {
        store(weights + j * WIDTH, w[j]);
        store(state + j * WIDTH, h[j]);
    }
    return k;
}

/* Regressor = outputs of play operators.  Lane j at sample k reads the envelopes
 * at [k + j] (delayed: they run along the delay line) or all at [k].  Operators
 * in the padding have an infinite threshold and so stay at zero. */
EXPORT index_t hb_lms_play(index_t n, index_t vectors, const double *left,
                           const double *right, index_t delayed, const double *d,
                           const double *r, double step, double regularization,
                           double limit, double *state, double *weights, double *y,
                           double *e)
{
#define ALONG(size)                                                              \
    lms_play(n, left, right, 1, d, r, step, regularization, limit, state, weights, \
             y, e, size)
#define TOGETHER(size)                                                           \
    lms_play(n, left, right, 0, d, r, step, regularization, limit, state, weights, \
             y, e, size)
    if (delayed) FOR_VECTORS(vectors, ALONG)
    FOR_VECTORS(vectors, TOGETHER)
#undef ALONG
#undef TOGETHER
}

/* Outputs of those operators as rows, for the correlation matrix of Eq. 19. */
EXPORT void hb_play_rows(index_t n, index_t vectors, const double *left,
                         const double *right, index_t delayed, const double *r,
                         double *state, double *rows)
{
    for (index_t k = 0; k < n; k++)
        for (index_t j = 0; j < vectors * WIDTH; j += WIDTH) {
            lanes gl = delayed ? load(left + k + j) : fill(left[k]);
            lanes gr = delayed ? load(right + k + j) : fill(right[k]);
            lanes h = play_step(gl, gr, load(r + j), load(state + j));
            store(state + j, h);
            store(rows + k * vectors * WIDTH + j, h);
        }
}

/* The LMS loop, Eqs. 13 and 18: predict, compare, correct.
 *
 * Written as it stands, each prediction would wait for the whole sum of the one
 * before.  Instead w(k)'H(k) is had as w(k-1)'H(k) + c(k-1) H(k-1)'H(k), where
 * w(k) = w(k-1) + c(k-1) H(k-1): both sums run beside the loop, and from one error
 * to the next there is a single product.  Each function returns the number of
 * samples it took: fewer than n where the error grew past the limit or is not a
 * number at all; weights are then those that made the bad prediction.
 */
#include "lanes.h"

INLINE index_t lms_rows(index_t n, const double *rows, index_t stride, const double *d,
                        const double *step, double limit,
                        double *weights, double *y, double *e, index_t vectors)
{
    lanes w[vectors], last[vectors];
    double correction = 0;
    index_t k;
    UNROLL
    for (index_t j = 0; j < vectors; j++) {
        w[j] = load(weights + j * LANES);
        last[j] = (lanes){0};
    }
    for (k = 0; k < n; k++) {
        const double *row = rows + k * stride;
        lanes before = {0}, overlap = {0};
        UNROLL
        for (index_t j = 0; j < vectors; j++) {
            lanes h = load(row + j * LANES);
            before += w[j] * h;
            overlap += last[j] * h;
            w[j] += correction * last[j];
            last[j] = load(step + j * LANES) * h;
        }
        double output = sum(before) + correction * sum(overlap);
        double error = d[k] - output;
        correction = 0;
        if (diverged(error, limit)) break;
        y[k] = output;
        e[k] = error;
        correction = error;
    }
    UNROLL
    for (index_t j = 0; j < vectors; j++)
        store(weights + j * LANES, w[j] + correction * last[j]);
    return k;
}

/* Regressor k is rows[k * stride], padded to WIDTH; with stride 1 a delay line.
 * step is 2 mu for each weight and zero in the padding. */
EXPORT index_t hb_lms_rows(index_t n, index_t wide, const double *rows,
                           index_t stride, const double *d, const double *step,
                           double limit, double *weights,
                           double *y, double *e)
{
#define CALL(size)                                                                     \
    lms_rows(n, rows, stride, d, step, limit, weights, y, e, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

INLINE index_t lms_play(index_t n, const double *left, const double *right,
                        index_t pace, const double *d, const double *r, double step,
                        double limit, double *state,
                        double *weights, double *y, double *e, index_t vectors)
{
    const index_t size = vectors * LANES;
    double h[size] ALIGNED, own_r[size] ALIGNED;
    lanes w[vectors], last[vectors];
    double correction = 0;
    index_t k;
    copy(size, state, h);
    copy(size, r, own_r);
    UNROLL
    for (index_t j = 0; j < vectors; j++) {
        w[j] = load(weights + j * LANES);
        last[j] = (lanes){0};
    }
    for (k = 0; k < n; k++) {
        lanes before = {0}, overlap = {0};
        play_step(size, left + k, right + k, pace, own_r, h);
        UNROLL
        for (index_t j = 0; j < vectors; j++) {
            lanes now = load(h + j * LANES);
            before += w[j] * now;
            overlap += last[j] * now;
            w[j] += correction * last[j];
            last[j] = now;
        }
        double output = sum(before) + correction * sum(overlap);
        double error = d[k] - output;
        correction = 0;
        if (diverged(error, limit)) break;
        y[k] = output;
        e[k] = error;
        correction = step * error;
    }
    copy(size, h, state);
    UNROLL
    for (index_t j = 0; j < vectors; j++)
        store(weights + j * LANES, w[j] + correction * last[j]);
    return k;
}

static index_t lms_one_play(index_t n, index_t wide, const double *left,
                            const double *right, index_t pace, const double *d,
                            const double *r, double step,
                            double limit, double *state, double *weights, double *y,
                            double *e)
{
#define ALONG(size)                                                                \
    lms_play(n, left, right, 1, d, r, step, limit, state, weights, \
             y, e, size)
#define TOGETHER(size)                                                             \
    lms_play(n, left, right, 0, d, r, step, limit, state, weights, \
             y, e, size)
    if (pace) FOR_SIZES(wide, ALONG)
    FOR_SIZES(wide, TOGETHER)
#undef ALONG
#undef TOGETHER
}

/* Regressor = outputs of play operators.  Operator j at sample k reads the
 * envelopes at [k + j] (pace 1: they run along the delay line) or all at [k]
 * (pace 0).  In the padding the threshold is infinite: outputs stay zero.
 *
 * Runs count filters that differ in step alone, one after the other: each has its
 * row of state and weights, and of y and e with stride numbers a row.  taken is the
 * samples that each took. */
EXPORT void hb_lms_play(index_t count, index_t n, index_t wide, const double *left,
                        const double *right, index_t pace, const double *d,
                        const double *r, const double *step,
                        double limit, double *state, double *weights, double *y,
                        double *e, index_t stride, double *taken)
{
    const index_t size = wide * WIDTH;
    for (index_t i = 0; i < count; i++)
        taken[i] = lms_one_play(n, wide, left, right, pace, d, r, step[i],
                                limit, state + i * size,
                                weights + i * size, y + i * stride, e + i * stride);
}

/* Outputs of those operators as rows, for the correlation matrix of Eq. 19. */
EXPORT void hb_play_rows(index_t n, index_t wide, const double *left,
                         const double *right, index_t pace, const double *restrict r,
                         double *restrict state, double *restrict rows)
{
    const index_t size = wide * WIDTH;
    for (index_t k = 0; k < n; k++) {
        play_step(size, left + k, right + k, pace, r, state);
        copy(size, state, rows + k * size);
    }
}

/* Play operators and the Prandtl-Ishlinskii models made of them. */
#include "lanes.h"
#include "tangent.h"

/* Eq. 12 as Eq. 4: where the input rises the left envelope is taken out of the
 * way, where it falls the right one, where it rests both. */
EXPORT void hb_follow_direction(index_t n, const double *restrict v,
                                double *restrict left, double *restrict right)
{
    for (index_t k = 1; k < n; k++) {
        left[k] = v[k] < v[k - 1] ? left[k] : INFINITY;
        right[k] = v[k] > v[k - 1] ? right[k] : -INFINITY;
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
            double lower = high < state[i] ? high : state[i];
            out[k * m + i] = state[i] = low > lower ? low : lower;
        }
}

INLINE index_t prandtl_ishlinskii(index_t n, const double *left, const double *right,
                                  const double *r, const double *weights,
                                  double *state, double *y, index_t vectors)
{
    const index_t size = vectors * LANES;
    double w[size] ALIGNED, own_r[size] ALIGNED;
    copy(size, state, w);
    copy(size, r, own_r);
    for (index_t k = 0; k < n; k++) {
        lanes total = {0};
        play_step(size, left + k, right + k, 0, own_r, w);
        UNROLL
        for (index_t j = 0; j < size; j += LANES)
            total += load(w + j) * load(weights + j);
        y[k] = sum(total);
    }
    copy(size, w, state);
    return n;
}

/* Eq. 9: y = sum of weight times operator, all padded to WIDTH. */
EXPORT index_t hb_prandtl_ishlinskii(index_t n, index_t wide, const double *left,
                                     const double *right, const double *r,
                                     const double *weights, double *state, double *y)
{
#define CALL(size) prandtl_ishlinskii(n, left, right, r, weights, state, y, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

/* The same from rest on the envelopes of an input, a0 to a3 and a4 to a7, which are
 * computed a piece at a time and never stored. */
#define PIECE 256
EXPORT index_t hb_enveloped_plays(index_t n, index_t wide, const double *a,
                                  const double *v, const double *r,
                                  const double *weights, double *y)
{
    double left[PIECE], right[PIECE], state[wide * WIDTH];
    for (index_t i = 0; i < wide * WIDTH; i++) state[i] = 0;
    for (index_t start = 0; start < n; start += PIECE) {
        const index_t count = n - start < PIECE ? n - start : PIECE;
        envelope(count, a[0], a[1], a[2], a[3], v + start, left);
        envelope(count, a[4], a[5], a[6], a[7], v + start, right);
        hb_prandtl_ishlinskii(count, wide, left, right, r, weights, state, y + start);
    }
    return n;
}

INLINE index_t rate_dependent(index_t n, const double *number, const double *used,
                              const double *left, const double *right,
                              const double *spacing, const double *ratio, double *state,
                              double *y, index_t vectors)
{
    const index_t size = vectors * LANES;
    const int from_one = number[0] > 0;
    double w[size] ALIGNED, r[size] ALIGNED, place[size] ALIGNED;
    copy(size, state, w);
    copy(size, number, place);
    for (index_t k = 0; k < n; k++) {
        const double q = ratio[k], q2 = q * q, q4 = q2 * q2, q6 = q4 * q2;
        const double powers[] = {1, q, q2, q2 * q, q4, q4 * q, q6, q6 * q, q4 * q4};
        lanes total = {0}, power;
        UNROLL
        for (index_t j = 0; j < LANES; j++) power[j] = powers[j];
        if (from_one) power *= q;
        for (index_t i = 0; i < size; i++) r[i] = place[i] * spacing[k];
        play_step(size, left + k, right + k, 0, r, w);
        UNROLL
        for (index_t j = 0; j < size; j += LANES) {
            total += load(w + j) * (power * load(used + j));
            power *= powers[LANES];
        }
        y[k] = sum(total);
    }
    copy(size, w, state);
    return n;
}

/* y = sum of ratio^i times the operator of threshold i * spacing, both changing
 * from sample to sample.  number holds the i, from 0 or 1 on; used is 1 for an
 * operator that counts and 0 in the padding. */
EXPORT index_t hb_rate_dependent(index_t n, index_t wide, const double *number,
                                 const double *used, const double *left,
                                 const double *right, const double *spacing,
                                 const double *ratio, double *state, double *y)
{
#define CALL(size) \
    rate_dependent(n, number, used, left, right, spacing, ratio, state, y, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

/* Outputs (n, m) of m play operators whose thresholds are r times growth at each
 * sample. */
EXPORT void hb_growing_play(index_t n, index_t m, const double *v,
                            const double *restrict r, const double *growth,
                            double *restrict state, double *restrict out)
{
    for (index_t k = 0; k < n; k++)
        for (index_t i = 0; i < m; i++) {
            double low = v[k] - r[i] * growth[k], high = v[k] + r[i] * growth[k];
            double lower = high < state[i] ? high : state[i];
            out[k * m + i] = state[i] = low > lower ? low : lower;
        }
}

INLINE index_t growing(index_t n, const double *left, const double *right,
                       const double *thresholds, const double *weights,
                       const double *growth, double *y, index_t vectors)
{
    const index_t size = vectors * LANES;
    double w[size] ALIGNED, r[size] ALIGNED;
    for (index_t i = 0; i < size; i++) w[i] = 0;
    for (index_t k = 0; k < n; k++) {
        lanes total = {0};
        for (index_t i = 0; i < size; i++) r[i] = thresholds[i] * growth[k];
        play_step(size, left + k, right + k, 0, r, w);
        UNROLL
        for (index_t j = 0; j < size; j += LANES)
            total += load(w + j) * load(weights + j);
        y[k] = sum(total);
    }
    return n;
}

/* Eq. 9 from rest, with thresholds that are r times growth at each sample; padding
 * has weight 0. */
EXPORT index_t hb_growing_prandtl_ishlinskii(index_t n, index_t wide,
                                             const double *left, const double *right,
                                             const double *r, const double *weights,
                                             const double *growth, double *y)
{
#define CALL(size) growing(n, left, right, r, weights, growth, y, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

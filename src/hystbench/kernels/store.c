/* Stores: what flows in, and what flows out as the level says. */
#include "lanes.h"

/* What flows out of a store; a general power takes ten times as long as a root. */
static inline double hb_outflow(double rate, double exponent, double h)
{
    if (!(h > 0)) return 0;
    if (exponent == 1) return rate * h;
    return rate * (exponent == 0.5 ? sqrt(h) : pow(h, exponent));
}

/* fmax is a call of a library's. */
static inline double hb_above_zero(double h) { return h > 0 ? h : 0; }

/* A level above a rim after a time t in which nothing else moves it, and what it changes
 * by for each unit of the level before, and of the weir's.  x = h - height falls by
 * x' = -weir x^1.5, to x / (1 + weir t sqrt(x) / 2)^2, and at once for a weir of 1e30. */
typedef struct { double level, kept, weir; } hb_rim_t;

static inline hb_rim_t hb_over_rim(double h, double height, double weir, double t)
{
    if (weir >= 1e30) return (hb_rim_t){height, 0, 0};
    const double x = h - height, root = sqrt(x), by = 1 / (1 + 0.5 * weir * t * root);
    return (hb_rim_t){height + x * by * by, by * by * by, -t * x * root * by * by * by};
}

/* Level h of a store, h' = inflow - rate h^exponent - weir max(0, h - height)^1.5; with a
 * weir of 1e30 it is held below the height, as what would rise above it is spilt.  What
 * is spilt is a mean over the interval before each sample.  Runge-Kutta of second order
 * (midpoint) in equal parts of each interval, with half of the spill before and half
 * after; with an exponent of one and no rim (a height of 1e30) it is exact. The inflow
 * moves by the share ramp of a straight line in each interval (1: straight, 0: a
 * staircase). */
EXPORT void hb_store(index_t n, index_t parts, double dt, double ramp, double rate,
                     double exponent, double height, double weir, const double *z,
                     double *level, double *outflow, double *spilt)
{
    const double t = dt / parts, lost = rate * t;
    const int sharp = weir >= 1e30;
    /* Of a level, and what a steady inflow and a rising one bring, in one part. */
    const double kept = exp(-lost), steady = lost > 1e-5 ? (1 - kept) / rate : t;
    const double rising = lost > 1e-5 ? (t - steady) / lost : t / 2;
    spilt[0] = 0;
    outflow[0] = hb_outflow(rate, exponent, level[0]);
    for (index_t k = 0; k + 1 < n; k++) {
        const double slope = ramp * (z[k + 1] - z[k]) / parts;
        double h = level[k], over = 0;
        for (index_t s = 0; s < parts; s++) {
            const double from = z[k] + s * slope;
            if (h > height) {
                const double left = hb_over_rim(h, height, weir, t / 2).level;
                over += h - left, h = left;
            }
            if (exponent == 1 && height >= 1e30) {
                h = hb_above_zero(kept * h + steady * from + rising * slope);
            } else {
                const double rise = from - hb_outflow(rate, exponent, h);
                const double half = hb_above_zero(h + t / 2 * rise);
                const double middle = sharp && half > height ? height : half;
                const double left = hb_outflow(rate, exponent, middle);
                h = hb_above_zero(h + t * (from + slope / 2 - left));
            }
            if (h > height) {
                const double left = hb_over_rim(h, height, weir, t / 2).level;
                over += h - left, h = left;
            }
        }
        level[k + 1] = h;
        outflow[k + 1] = hb_outflow(rate, exponent, h);
        spilt[k + 1] = over / dt;
    }
}

/* An outflow, and what it changes by for each unit of the level, rate and exponent. */
typedef struct { double flow, level, rate, exponent; } hb_slopes_t;

static inline hb_slopes_t hb_outflow_slopes(double rate, double exponent, double h,
                                            int bends)
{
    if (!(h > 0)) return (hb_slopes_t){0, 0, 0, 0};
    const double unit = hb_outflow(1, exponent, h), flow = rate * unit;
    return (hb_slopes_t){flow, exponent * flow / h, unit, bends ? flow * log(h) : 0};
}

/* What a store near another has above its rim, and has spilt, to first order. */
static inline void hb_spill_near(hb_rim_t rim, double height, double weir, double *level,
                                 double *over)
{
    const double left = height + rim.kept * (*level - height) + rim.weir * weir;
    *over += *level - left;
    *level = left;
}

/* A store as in hb_store, and by how much others near it differ, to first order: their
 * numbers and inflows differ by rates, exponents, heights, weirs and inflows, which are
 * small.
 * Tables have a row a sample and a column for each of the others; the first row of
 * levels is given. */
EXPORT void hb_store_near(index_t n, index_t parts, double dt, double ramp, double rate,
                          double exponent, double height, double weir, const double *z,
                          double *level, double *outflow, double *spilt, index_t count,
                          const double *restrict rates, const double *restrict exponents,
                          const double *restrict heights, const double *restrict weirs,
                          const double *inflows, double *levels, double *outflows,
                          double *spills)
{
    const double t = dt / parts;
    const int sharp = weir >= 1e30;
    int bends = 0; /* whether an exponent differs: else no logarithm is needed */
    for (index_t i = 0; i < count; i++) bends |= exponents[i] != 0;
    for (index_t k = 0; k < n; k++) {
        const hb_slopes_t out = hb_outflow_slopes(rate, exponent, level[k], bends);
        const double *restrict now = inflows + k * count, *restrict then = now + count;
        double *restrict d = levels + k * count, *restrict next = d + count;
        double *restrict over = spills + (k + 1) * count;
        outflow[k] = out.flow;
        for (index_t i = 0; i < count; i++)
            outflows[k * count + i] = out.level * d[i] + out.rate * rates[i]
                                      + out.exponent * exponents[i];
        if (k + 1 == n) break;
        const double slope = ramp * (z[k + 1] - z[k]) / parts;
        double h = level[k], lost = 0;
        for (index_t i = 0; i < count; i++) next[i] = d[i], over[i] = 0;
        for (index_t s = 0; s < parts; s++) {
            const double from = z[k] + s * slope;
            if (h > height) {
                const hb_rim_t rim = hb_over_rim(h, height, weir, t / 2);
                for (index_t i = 0; i < count; i++)
                    hb_spill_near(rim, heights[i], weirs[i], next + i, over + i);
                lost += h - rim.level, h = rim.level;
            }
            const hb_slopes_t first = hb_outflow_slopes(rate, exponent, h, bends);
            const double to = h + t / 2 * (from - first.flow);
            const double half = hb_above_zero(!sharp || to < height ? to : height);
            const hb_slopes_t second = hb_outflow_slopes(rate, exponent, half, bends);
            const double reached = h + t * (from + slope / 2 - second.flow);
            const double held = sharp && to >= height, moves = to > 0 && !held;
            const double stays = reached > 0;
            for (index_t i = 0; i < count; i++) {
                const double rise = ramp * (then[i] - now[i]) / parts;
                const double inflow = now[i] + s * rise;
                const double left = first.level * next[i] + first.rate * rates[i]
                                    + first.exponent * exponents[i];
                const double middle = moves * (next[i] + t / 2 * (inflow - left))
                                      + held * heights[i];
                const double leaves = second.level * middle + second.rate * rates[i]
                                      + second.exponent * exponents[i];
                next[i] = stays * (next[i] + t * (inflow + rise / 2 - leaves));
            }
            h = hb_above_zero(reached);
            if (h > height) {
                const hb_rim_t rim = hb_over_rim(h, height, weir, t / 2);
                for (index_t i = 0; i < count; i++)
                    hb_spill_near(rim, heights[i], weirs[i], next + i, over + i);
                lost += h - rim.level, h = rim.level;
            }
        }
        for (index_t i = 0; i < count; i++) over[i] /= dt;
        level[k + 1] = h;
        spilt[k + 1] = lost / dt;
    }
}

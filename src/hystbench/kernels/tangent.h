/* The hyperbolic tangent, several at a time. */
#ifndef HYSTBENCH_TANGENT_H
#define HYSTBENCH_TANGENT_H

#include <string.h>

#include "lanes.h"

/* e^r - 1 for |r| <= log(2) / 2: a Taylor series, whose rest is below 1e-17 of it. */
INLINE double near_zero(double r)
{
    double p = 1.0 / 6227020800.0;
    p = p * r + 1.0 / 479001600.0;
    p = p * r + 1.0 / 39916800.0;
    p = p * r + 1.0 / 3628800.0;
    p = p * r + 1.0 / 362880.0;
    p = p * r + 1.0 / 40320.0;
    p = p * r + 1.0 / 5040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    return p * r * r + r;
}

/* Written so that a compiler takes several samples at once: no branch, no call. */
INLINE double hyperbolic_tangent(double x)
{
    const double log2e = 1.4426950408889634074;
    const double high = 6.93147180369123816490e-01, low = 1.90821492927058770002e-10;
    const double shift = 6755399441055744.0; /* 1.5 * 2^52: rounds, bits at the end */
    double t = x > 20.0 ? 40.0 : 2.0 * x;    /* beyond, it is one to the last digit */
    t = t < -40.0 ? -40.0 : t;
    const double place = t * log2e + shift;
    const double k = place - shift;
    const double q = near_zero((t - k * high) - k * low);
    unsigned long long bits;
    memcpy(&bits, &place, sizeof bits);
    bits = (bits + 1023) << 52; /* 2^k: the sum's lowest bits are k */
    double power;
    memcpy(&power, &bits, sizeof power);
    const double grown = power * q + (power - 1.0);
    return grown / (grown + 2.0);
}

/* out = height * tanh(slope * v + place) + offset */
INLINE void envelope(index_t n, double height, double slope, double place, double offset,
                     const double *restrict v, double *restrict out)
{
    for (index_t k = 0; k < n; k++)
        out[k] = height * hyperbolic_tangent(slope * v[k] + place) + offset;
}

#endif

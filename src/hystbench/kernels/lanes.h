/* Eight numbers at a time, in GCC's portable vector notation.
 *
 * The order of every sum is the order written here, whatever the alignment of
 * the data and the width of the machine's registers: so a run gives the same
 * bytes each time.  The compiler lowers eight lanes to what the machine has.
 */
#ifndef HYSTBENCH_LANES_H
#define HYSTBENCH_LANES_H

#include <math.h>
#include <stddef.h>

#define INLINE static inline __attribute__((always_inline))
#define EXPORT __attribute__((visibility("default")))
#define WIDTH 8 /* lanes of a vector; the Python side pads to it */
#define QUAD 4
#define ALIGNED __attribute__((aligned(64))) /* no load or store across cache lines */

typedef ptrdiff_t index_t;
typedef double lanes __attribute__((vector_size(64)));
typedef double quad __attribute__((vector_size(32)));
typedef double pair __attribute__((vector_size(16)));

/* Arrays lie anywhere: a copy is one unaligned instruction. */
INLINE lanes load(const double *p)
{
    lanes v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
INLINE quad load_quad(const double *p)
{
    quad v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
INLINE void store(double *p, lanes v) { __builtin_memcpy(p, &v, sizeof v); }
INLINE void store_quad(double *p, quad v) { __builtin_memcpy(p, &v, sizeof v); }

INLINE double sum_quad(quad v)
{
    pair p = __builtin_shufflevector(v, v, 0, 1) + __builtin_shufflevector(v, v, 2, 3);
    return p[0] + p[1];
}
INLINE double sum(lanes v)
{
    return sum_quad(__builtin_shufflevector(v, v, 0, 1, 2, 3)
                    + __builtin_shufflevector(v, v, 4, 5, 6, 7));
}

/* Eq. 4: every generalized play operator to max(gr - r, min(gl + r, w)).
 * Operator i reads the envelopes at [i * pace], pace being 0 or 1. */
INLINE void play_step(index_t size, const double *left, const double *right,
                      index_t pace, const double *restrict r, double *restrict w)
{
    for (index_t i = 0; i < size; i++) {
        double low = right[i * pace] - r[i], high = left[i * pace] + r[i];
        double lower = high < w[i] ? high : w[i];
        w[i] = low > lower ? low : lower;
    }
}

INLINE void copy(index_t size, const double *from, double *to)
{
    for (index_t i = 0; i < size; i++) to[i] = from[i];
}

/* An error beyond the limit, or one that compares with nothing. */
INLINE int diverged(double error, double limit) { return !(fabs(error) <= limit); }

/* Call a body with a constant for the usual sizes, so that the compiler keeps
 * weights and states in registers. */
#define FOR_VECTORS(vectors, call) \
    switch (vectors) {             \
    case 1: return call(1);        \
    case 2: return call(2);        \
    case 3: return call(3);        \
    case 4: return call(4);        \
    case 5: return call(5);        \
    case 6: return call(6);        \
    default: return call(vectors); \
    }
#define UNROLL _Pragma("GCC unroll 8")

#endif

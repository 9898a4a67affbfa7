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
#include <stdint.h>

#define INLINE static inline __attribute__((always_inline))
#define EXPORT __attribute__((visibility("default")))
#define WIDTH 8 /* lanes of a vector; the Python side pads to it */

typedef ptrdiff_t index_t;
typedef double lanes __attribute__((vector_size(64), aligned(8), may_alias));
typedef int64_t masks __attribute__((vector_size(64), aligned(8), may_alias));
typedef double quad __attribute__((vector_size(32), aligned(8), may_alias));
typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));

INLINE lanes load(const double *p) { return *(const lanes *)p; }
INLINE void store(double *p, lanes v) { *(lanes *)p = v; }
INLINE quad load_quad(const double *p) { return *(const quad *)p; }
INLINE void store_quad(double *p, quad v) { *(quad *)p = v; }
INLINE lanes fill(double a) { return (lanes){a, a, a, a, a, a, a, a}; }

INLINE lanes choose(masks m, lanes a, lanes b)
{
    return (lanes)((m & (masks)a) | (~m & (masks)b));
}
INLINE lanes smaller(lanes a, lanes b) { return choose(a < b, a, b); }
INLINE lanes larger(lanes a, lanes b) { return choose(a > b, a, b); }

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

/* Eq. 4: the generalized play operator f(v, w) = max(gr - r, min(gl + r, w)). */
INLINE lanes play_step(lanes left, lanes right, lanes r, lanes w)
{
    return larger(right - r, smaller(left + r, w));
}

/* An error beyond the limit, or one that compares with nothing. */
INLINE int diverged(double error, double limit) { return !(fabs(error) <= limit); }

/* Call body(..., vectors) with a constant for the usual sizes, so that the
 * compiler keeps weights and states in registers. */
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

#endif

/* Several numbers at a time, in GCC's portable vector notation.
 *
 * The order of every sum is the order written here, whatever the alignment of the
 * data: so on one machine a run gives the same bytes each time.
 */
#ifndef HYSTBENCH_LANES_H
#define HYSTBENCH_LANES_H

#include <math.h>
#include <stddef.h>
#if defined(__AVX__)
#include <immintrin.h>
#endif

#define INLINE static inline __attribute__((always_inline))
#define EXPORT __attribute__((visibility("default")))
#define ALIGNED __attribute__((aligned(64))) /* no load or store across cache lines */
#define UNROLL _Pragma("GCC unroll 32")

#define WIDTH 8 /* the Python side pads operators and weights to it */
#define TILE 4  /* rows and columns of the tiles of second-order weights */

/* Lanes of this machine's registers, and of those that a tile's row is made of. */
#if defined(__AVX512F__)
#define LANES 8
#define PART 4
#elif defined(__AVX__)
#define LANES 4
#define PART 4
#else
#define LANES 2
#define PART 2
#endif

typedef ptrdiff_t index_t;
typedef double pair __attribute__((vector_size(16)));
typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef double part __attribute__((vector_size(8 * PART)));

/* Arrays lie anywhere: a copy is one unaligned instruction. */
INLINE lanes load(const double *p)
{
    lanes v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
INLINE part load_part(const double *p)
{
    part v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
INLINE void store(double *p, lanes v) { __builtin_memcpy(p, &v, sizeof v); }
INLINE void store_part(double *p, part v) { __builtin_memcpy(p, &v, sizeof v); }

/* The halves of several numbers. GCC before 12 goes by way of memory. */
#if defined(__clang__) || __GNUC__ >= 12
#define LOW_2(v) __builtin_shufflevector(v, v, 0, 1)
#define HIGH_2(v) __builtin_shufflevector(v, v, 2, 3)
#define LOW_4(v) __builtin_shufflevector(v, v, 0, 1, 2, 3)
#define HIGH_4(v) __builtin_shufflevector(v, v, 4, 5, 6, 7)
#else
#define LOW_2(v) ((union { part whole; pair half[2]; }){ v }).half[0]
#define HIGH_2(v) ((union { part whole; pair half[2]; }){ v }).half[1]
#define LOW_4(v) ((union { lanes whole; part half[2]; }){ v }).half[0]
#define HIGH_4(v) ((union { lanes whole; part half[2]; }){ v }).half[1]
#endif

INLINE double sum_part(part v)
{
#if PART == 4
    pair p = LOW_2(v) + HIGH_2(v);
    return p[0] + p[1];
#else
    return v[0] + v[1];
#endif
}
INLINE double sum(lanes v)
{
#if LANES == 8
    return sum_part(LOW_4(v) + HIGH_4(v));
#else
    return sum_part(v);
#endif
}

/* a < b ? a : b and a > b ? a : b, lane by lane. */
#if defined(__AVX512F__)
INLINE lanes lesser(lanes a, lanes b) { return (lanes)_mm512_min_pd(a, b); }
INLINE lanes greater(lanes a, lanes b) { return (lanes)_mm512_max_pd(a, b); }
#elif defined(__AVX__)
INLINE lanes lesser(lanes a, lanes b) { return (lanes)_mm256_min_pd(a, b); }
INLINE lanes greater(lanes a, lanes b) { return (lanes)_mm256_max_pd(a, b); }
#else
INLINE lanes lesser(lanes a, lanes b)
{
    for (int i = 0; i < LANES; i++) a[i] = a[i] < b[i] ? a[i] : b[i];
    return a;
}
INLINE lanes greater(lanes a, lanes b)
{
    for (int i = 0; i < LANES; i++) a[i] = a[i] > b[i] ? a[i] : b[i];
    return a;
}
#endif

/* Eq. 4: every generalized play operator to max(gr - r, min(gl + r, w)).
 * Operator i reads the envelopes at [i * pace], pace being 0 or 1. */
INLINE void play_step(index_t size, const double *left, const double *right,
                      index_t pace, const double *restrict r, double *restrict w)
{
    UNROLL
    for (index_t i = 0; i < size; i += LANES) {
        lanes gl = pace ? load(left + i) : (lanes){0} + left[0];
        lanes gr = pace ? load(right + i) : (lanes){0} + right[0];
        lanes own = load(r + i);
        store(w + i, greater(gr - own, lesser(gl + own, load(w + i))));
    }
}

INLINE void copy(index_t size, const double *from, double *to)
{
    for (index_t i = 0; i < size; i++) to[i] = from[i];
}

/* An error beyond the limit, or one that compares with nothing. */
INLINE int diverged(double error, double limit) { return !(fabs(error) <= limit); }

/* Call a body with a constant number of vectors for the usual sizes, so that the
 * compiler keeps weights and states in registers. */
#define FOR_SIZES(wide, call)                   \
    switch (wide) {                             \
    case 1: return call(1 * WIDTH / LANES);     \
    case 2: return call(2 * WIDTH / LANES);     \
    case 3: return call(3 * WIDTH / LANES);     \
    case 4: return call(4 * WIDTH / LANES);     \
    case 5: return call(5 * WIDTH / LANES);     \
    case 6: return call(6 * WIDTH / LANES);     \
    default: return call(wide * WIDTH / LANES); \
    }

#endif

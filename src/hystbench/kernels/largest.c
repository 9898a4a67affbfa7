/* The largest magnitude of an array, and whether all of it is finite. */
#include "lanes.h"

#define SIDE 32 /* numbers taken side by side, so that none waits for another */

INLINE void widen(index_t count, const double *x, double *largest, double *nothing)
{
    for (index_t i = 0; i < count; i++) {
        double size = fabs(x[i]);
        largest[i] = size > largest[i] ? size : largest[i];
        nothing[i] += size - size; /* zero, or NaN where x is not finite */
    }
}

/* largest: one number, NaN where one of x is not finite. */
EXPORT void hb_largest(index_t n, const double *x, double *largest)
{
    double sizes[SIDE] ALIGNED = {0}, nothing[SIDE] ALIGNED = {0}, found = 0, rest = 0;
    index_t k = 0;
    for (; k + SIDE <= n; k += SIDE) widen(SIDE, x + k, sizes, nothing);
    widen(n - k, x + k, sizes, nothing);
    for (index_t i = 0; i < SIDE; i++) {
        found = sizes[i] > found ? sizes[i] : found;
        rest += nothing[i];
    }
    *largest = found + rest;
}

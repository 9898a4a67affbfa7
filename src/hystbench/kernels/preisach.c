/* Scalar Preisach operator by its Everett function. */
#include "lanes.h"

/* Mass of the density below x and below y, both counted in cells: bilinear within a
 * cell, which is exact for a density that is constant there. */
INLINE double mass(const double *table, index_t cells, double x, double y)
{
    index_t i = (index_t)x, j = (index_t)y;
    if (i == cells) i--;
    if (j == cells) j--;
    const double *low = table + i * (cells + 1) + j, *high = low + cells + 1;
    const double q = y - (double)j;
    const double below = low[0] + q * (low[1] - low[0]);
    const double above = high[0] + q * (high[1] - high[0]);
    return below + (x - (double)i) * (above - below);
}

/* Output of n samples, from negative saturation on, where it is zero.
 *
 * table, (cells + 1)^2, holds at its nodes the mass of the density that was continued
 * symmetrically beyond the diagonal; half of it over the square from one turn to
 * another is Everett's integral over the triangle.
 *
 * The turns that are not wiped out lie in turns, minima at even and maxima at odd
 * places, the output there in outputs: room for n + 1 of each. */
EXPORT void hb_preisach(index_t n, index_t cells, double limit, const double *table,
                        const double *v, double *turns, double *outputs, double *y)
{
    index_t depth = 0;
    double last = 0, now = 0;
    turns[0] = outputs[0] = 0;
    for (index_t k = 0; k < n; k++) {
        double x = (v[k] + limit) / (2 * limit) * (double)cells;
        x = x > 0 ? (x < (double)cells ? x : (double)cells) : 0;
        const int rose = depth % 2 == 0;
        if (rose ? x < last : x > last) {
            depth++;
            turns[depth] = last;
            outputs[depth] = now;
        }
        if (depth % 2 == 0) {
            while (depth >= 2 && x >= turns[depth - 1]) depth -= 2;
        } else {
            while (depth >= 3 && x <= turns[depth - 1]) depth -= 2;
            if (depth == 1 && x <= turns[0]) depth = 0;
        }
        const double turn = turns[depth];
        const double own = mass(table, cells, turn, turn);
        const double everett =
            0.5 * (mass(table, cells, x, x) + own) - mass(table, cells, x, turn);
        now = outputs[depth] + (depth % 2 ? -everett : everett);
        last = x;
        y[k] = now;
    }
}

/* Magnetic diffusion into a slab or a rod: tau dh/dt = div grad h on 0 <= x <= 1. */
#include <stddef.h>
#include <stdlib.h>

#define EXPORT __attribute__((visibility("default")))

/* Finite volumes of equal width, Crank-Nicolson in time; the surface field is given
   and the mean field comes out. power: 0 slab (x^0), 1 rod (x^1 dx). */
EXPORT ptrdiff_t hc_diffusion(ptrdiff_t n, ptrdiff_t cells, ptrdiff_t power, double dt,
                              double tau, const double *u, double *y)
{
    double *work = calloc(6 * (size_t)cells, sizeof *work);
    if (!work)
        return -1;
    double *lower = work, *upper = work + cells, *share = work + 2 * cells;
    double *gamma = work + 3 * cells, *pivot = work + 4 * cells, *h = work + 5 * cells;
    double dx = 1.0 / (double)cells, surface = 0.0;
    for (ptrdiff_t i = 0; i < cells; i++) {
        double in = (double)i * dx, out = in + dx;
        double volume = power ? 0.5 * (out * out - in * in) : dx;
        double left = power ? in : (i > 0), right = power ? out : 1.0;
        if (i == 0)
            left = 0.0; /* symmetry plane or axis */
        lower[i] = left / (dx * volume);
        /* half a cell to the surface */
        upper[i] = (i + 1 < cells ? 1.0 : 2.0) * right / (dx * volume);
        share[i] = volume * (power ? 2.0 : 1.0);
    }
    surface = upper[cells - 1];
    double c = 0.5 * dt / tau;
    /* elimination is the same at every step: done once */
    for (ptrdiff_t i = 0; i < cells; i++) {
        double diagonal = 1.0 + c * (lower[i] + upper[i]);
        if (i)
            diagonal -= c * lower[i] * gamma[i - 1];
        pivot[i] = 1.0 / diagonal;
        gamma[i] = c * upper[i] * pivot[i];
    }
    double before = u[0];
    y[0] = 0.0;
    for (ptrdiff_t k = 1; k < n; k++) {
        double last = 0.0, carried = 0.0, mean = 0.0;
        for (ptrdiff_t i = 0; i < cells; i++) {
            double next = i + 1 < cells ? h[i + 1] : 0.0, here = h[i];
            double right = here + c * (lower[i] * (last - here)
                                       + upper[i] * (next - here));
            if (i + 1 == cells)
                right += c * surface * (before + u[k]);
            carried = (right + c * lower[i] * carried) * pivot[i];
            last = here;
            h[i] = carried;
        }
        for (ptrdiff_t i = cells - 1; i >= 0; i--) {
            if (i + 1 < cells)
                h[i] += gamma[i] * h[i + 1];
            mean += share[i] * h[i];
        }
        before = u[k];
        y[k] = mean;
    }
    free(work);
    return n;
}

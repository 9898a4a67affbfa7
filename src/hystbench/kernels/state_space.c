/* Simulation of a discrete linear state-space system, one input, one output. */
#include "lanes.h"

INLINE void simulate(index_t n, const double *a, const double *b, const double *c,
                     double d, const double *u, double *state, double *y,
                     index_t vectors)
{
    const index_t size = vectors * WIDTH;
    double x[size];
    for (index_t i = 0; i < size; i++) x[i] = state[i];
    for (index_t k = 0; k < n; k++) {
        lanes next[vectors], out = {0};
        for (index_t j = 0; j < vectors; j++) {
            out += load(c + j * WIDTH) * load(x + j * WIDTH);
            next[j] = load(b + j * WIDTH) * u[k];
        }
        y[k] = sum(out) + d * u[k];
        for (index_t i = 0; i < size; i++)
            for (index_t j = 0; j < vectors; j++)
                next[j] += load(a + i * size + j * WIDTH) * x[i];
        for (index_t j = 0; j < vectors; j++) store(x + j * WIDTH, next[j]);
    }
    for (index_t i = 0; i < size; i++) state[i] = x[i];
}

/* x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k); a holds the columns of A,
 * and all is padded with zeros to a multiple of WIDTH states. */
EXPORT void hb_state_space(index_t n, index_t vectors, const double *a, const double *b,
                           const double *c, double d, const double *u, double *state,
                           double *y)
{
    if (vectors == 1) simulate(n, a, b, c, d, u, state, y, 1);
    else if (vectors == 2) simulate(n, a, b, c, d, u, state, y, 2);
    else simulate(n, a, b, c, d, u, state, y, vectors);
}

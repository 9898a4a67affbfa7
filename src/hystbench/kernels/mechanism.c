/* One coordinate with forces inside: m q'' + c q' + k q + F(q, q') = p. */
#include "forces.c"
#include "lanes.h"

/* Motion q, v and force F of the samples, from q[0], v[0].  step holds, for one of
 * `parts` equal parts of an interval of dt: q and v after it of q, v, and of p at its
 * beginning and its end (two rows of four); then the same for an eighth of a part.  Over a part the forces count with their
 * mean over the way, which does their exact work: so a passive force never gives energy,
 * however stiff it is, and the method is of second order.  p moves by the share ramp of
 * a straight line in each interval (1: straight, 0: a staircase).
 * Returns the samples taken: fewer than n where the motion runs away; the rest is NaN. */
EXPORT index_t hb_mechanism(index_t n, index_t parts, double dt, double ramp,
                            const double *step, index_t count, const double *forces,
                            double *memory, const double *p, double *q, double *v,
                            double *out)
{
    const int all = (int)count;
    index_t k = 0;
    out[0] = hb_all_forces(all, forces, q[0], v[0], 0, 0, memory);
    for (; k + 1 < n; k++) {
        const double slope = ramp * (p[k + 1] - p[k]) / parts;
        double x = q[k], w = v[k];
        for (index_t s = 0; s < parts; s++) {
            const double from = p[k] + s * slope;
            hb_moved(all, forces, memory, step, dt / parts, from, from + slope, &x, &w);
            if (!(fabs(x) < 1e100)) break;
        }
        if (!(fabs(x) < 1e100 && fabs(w) < 1e100)) break;
        q[k + 1] = x, v[k + 1] = w;
        out[k + 1] = hb_all_forces(all, forces, x, w, 0, 0, memory);
    }
    for (index_t rest = k + 1; rest < n; rest++) q[rest] = v[rest] = out[rest] = NAN;
    return k + 1;
}

/* Forces against a given motion, sample by sample. */
EXPORT void hb_forces(index_t n, double dt, index_t count, const double *forces,
                      double *memory, const double *q, const double *v, double *out)
{
    const int all = (int)count;
    for (index_t k = 0; k < n; k++) {
        const double way = k ? q[k] - q[k - 1] : 0;
        out[k] = hb_all_forces(all, forces, q[k], v[k], way, k ? dt : 0, memory);
    }
}

/* Where springs hold a force p, of which the linear one has a stiffness; memory: zeros. */
EXPORT void hb_settle(double stiffness, double p, index_t count, const double *forces,
                      const double *memory, double *q)
{
    *q = hb_balance(stiffness, p, (int)count, forces, memory);
}

/* Level h of a store, h' = inflow - rate h^exponent, held below the height: what would
 * rise above it is spilt, as a mean over the interval before each sample.  Runge-Kutta
 * of second order (midpoint) in equal parts of each interval; the inflow moves as in
 * hb_mechanism. */
EXPORT void hb_store(index_t n, index_t parts, double dt, double ramp, double rate,
                     double exponent, double height, const double *z, double *level,
                     double *outflow, double *spilt)
{
#define FLOW(h) ((h) > 0 ? rate * pow(h, exponent) : 0)
    const double t = dt / parts;
    spilt[0] = 0;
    outflow[0] = FLOW(level[0]);
    for (index_t k = 0; k + 1 < n; k++) {
        const double slope = ramp * (z[k + 1] - z[k]) / parts;
        double h = level[k], over = 0;
        for (index_t s = 0; s < parts; s++) {
            const double from = z[k] + s * slope;
            const double half = fmin(height, fmax(0, h + t / 2 * (from - FLOW(h))));
            h = fmax(0, h + t * (from + slope / 2 - FLOW(half)));
            if (h > height) over += h - height, h = height;
        }
        level[k + 1] = h;
        outflow[k + 1] = FLOW(h);
        spilt[k + 1] = over / dt;
    }
#undef FLOW
}

/* A mode whose stiffness grows with its displacement. */
#include "lanes.h"

/* Displacement x of x'' + 2 damping w x' + w^2 (x + alpha x^3) = w^2 z from rest, with
 * phase = w dt and time in units of 1 / w.  z moves by the share ramp of a straight
 * line in each interval (1: straight, 0: a staircase).  Classical Runge-Kutta method, in
 * steps of at most step radians of the stiffened mode.  Returns the samples taken: fewer
 * than n where the mode has run away, as one that softens can; the rest is NaN. */
EXPORT index_t hb_hardening(index_t n, double phase, double damping, double alpha,
                            double ramp, double step, const double *z, double *out)
{
#define FORCE(at) (now + (at) * slope)
#define BEND(x, v, f) ((f) - (x) * (1 + alpha * (x) * (x)) - 2 * damping * (v))
    const double most = step / phase; /* times the linear mode's rate, in one step */
    double x = 0, v = 0;
    index_t k = 0;
    for (; k < n; k++) {
        out[k] = x;
        if (k + 1 == n) continue;
        const double now = z[k], slope = ramp * (z[k + 1] - now);
        const double reach = fmax(fabs(x), fabs(z[k + 1]));
        const double square = 1 + 3 * fabs(alpha) * reach * reach;
        double steps = 1; /* as most often: nothing then waits for a root or a ratio */
        if (!(fmax(square, damping * damping) <= most * most))
            steps = ceil(fmax(sqrt(square), damping) / most);
        if (!(steps < 1e5)) break;
        const double part = steps == 1 ? 1 : 1 / steps, h = phase * part;
        for (double s = 0; s < steps; s++) {
            const double f1 = FORCE(s * part), f2 = FORCE((s + .5) * part);
            const double f4 = FORCE((s + 1) * part);
            const double a1 = BEND(x, v, f1);
            const double v2 = v + h / 2 * a1, x2 = x + h / 2 * v;
            const double a2 = BEND(x2, v2, f2);
            const double v3 = v + h / 2 * a2, x3 = x + h / 2 * v2;
            const double a3 = BEND(x3, v3, f2);
            const double v4 = v + h * a3, x4 = x + h * v3;
            const double a4 = BEND(x4, v4, f4);
            x += h / 6 * (v + 2 * (v2 + v3) + v4);
            v += h / 6 * (a1 + 2 * (a2 + a3) + a4);
        }
    }
    for (index_t rest = k; rest < n; rest++) out[rest] = NAN;
    return k;
#undef FORCE
#undef BEND
}

/* One coordinate with forces inside: m q'' + c q' + k q + F(q, q') = p. */
#include <string.h>

#include "lanes.h"

#define NUMBERS 6 /* of a force: its kind is the first, its memory the last */
#define ROUNDS 60 /* of the search for the force at the end of a step */

enum { STIFFNESS, SINH, STOP, FRICTION, DRAG, HYSTERETIC, GRAVITY, SLIDER, SMOOTH };

static double dead_zone(double q, double gap)
{
    return q > gap ? q - gap : q < -gap ? q + gap : 0;
}

static double held(double z, double reach) { return fmax(-reach, fmin(reach, z)); }

/* Bouc-Wen's operator with exponent 1, solved exactly: z of a reach of one after a way
 * dq in units of the yield distance; share (0 to 1) is how much less stiff unloading is
 * than in Dahl's form, where it is 0.5. */
static double bouc_wen(double z, double dq, double share)
{
    const double sign = dq < 0 ? -1 : 1;
    double way = fabs(dq), x = sign * z;
    if (x < 0) { /* unloading: x' = 1 + b x with b = 2 share - 1 */
        const double b = 2 * share - 1;
        const double until = fabs(b) < 1e-9 ? -x : b * x > -1 ? -log1p(b * x) / b : INFINITY;
        if (way <= until)
            return sign * (fabs(b) < 1e-9 ? x + way : x * exp(b * way) + expm1(b * way) / b);
        way -= until;
        x = 0;
    }
    return sign * (1 + (x - 1) * exp(-way)); /* loading: x' = 1 - x */
}

/* A force at q and v, where q was `before` at the beginning of the step. */
static double force(const double *f, double q, double v, double before, double memory,
                    double *after)
{
    *after = memory;
    switch ((int)f[0]) {
    case STIFFNESS:
        return q * q * (f[1] + f[2] * q);
    case SINH:
        return f[1] * (f[2] * sinh(q / f[2]) - q);
    case STOP: {
        const double way = q - f[3], out = dead_zone(way, f[2]);
        return f[4] * way < 0 ? 0 : f[1] * out;
    }
    case FRICTION: {
        const double z = *after = held(memory + q - before, f[4]);
        const double more = f[3] > 0 ? f[2] * exp(-(v / f[3]) * (v / f[3])) : 0;
        return (f[1] + more) * z / f[4];
    }
    case DRAG:
        return f[1] * v * fabs(v);
    case HYSTERETIC:
        return f[1] * (*after = bouc_wen(memory, (q - before) / f[2], f[3]));
    case GRAVITY:
        return f[1] * (sin(q + f[2]) - sin(f[2]));
    case SMOOTH:
        return f[1] * tanh(v / f[2]);
    case SLIDER:
        return f[1] * dead_zone(*after = held(memory + q - before, f[2]), f[3]);
    }
    return NAN;
}

static double all_forces(index_t count, const double *forces, double q, double v,
                         double before, const double *memory, double *after)
{
    double sum = 0;
    for (index_t i = 0; i < count; i++)
        sum += force(forces + i * NUMBERS, q, v, before, memory[i], after + i);
    return sum;
}

/* Motion q, v and force F of the samples, from q[0], v[0].  step holds, for one of
 * `parts` equal parts of an interval: q and v after it of q, v, and of p at its
 * beginning and its end (two rows of four).  Over a part the forces count with the mean
 * of their values at both ends: stable however stiff they are, of second order.  p moves
 * by the share ramp of a straight line in each interval (1: straight, 0: a staircase).
 * Returns the samples taken: fewer than n where the motion runs away; the rest is NaN. */
EXPORT index_t hb_mechanism(index_t n, index_t parts, double ramp, const double *step,
                            index_t count, const double *forces, double *memory,
                            const double *p, double *q, double *v, double *out)
{
    double after[count + 1], trial[count + 1];
    index_t k = 0;
    out[0] = all_forces(count, forces, q[0], v[0], q[0], memory, after);
    memcpy(memory, after, count * sizeof *after);
    for (; k + 1 < n; k++) {
        const double slope = ramp * (p[k + 1] - p[k]) / parts;
        double x = q[k], w = v[k], f = out[k];
        for (index_t s = 0; s < parts; s++) {
            const double from = p[k] + s * slope, to = from + slope;
            const double bq = step[2] + step[3], bv = step[6] + step[7];
            const double fq = step[0] * x + step[1] * w + step[2] * from + step[3] * to;
            const double fv = step[4] * x + step[5] * w + step[6] * from + step[7] * to;
#define MISS(g) (all_forces(count, forces, fq - bq * (f + (g)) / 2, fv - bv * (f + (g)) / 2, \
                            x, memory, trial) - (g))
            /* The miss falls as g grows where the forces are passive: one root. */
            double low = f, high = f, at_low = MISS(f), at_high = at_low;
            double root = f;
            if (count && at_low != 0) {
                double reach = at_low;
                for (int i = 0; i < ROUNDS && at_low * at_high > 0; i++, reach *= 2) {
                    low = high, at_low = at_high;
                    high = f + reach, at_high = MISS(high);
                }
                /* Illinois's rule of false position: it keeps the root between. */
                root = high;
                const double near = 1e-13 * (fabs(f) + fabs(reach));
                for (int i = 0, side = 0; i < ROUNDS && at_low * at_high < 0; i++) {
                    root = (low * at_high - high * at_low) / (at_high - at_low);
                    if (fabs(high - low) <= near) break;
                    const double miss = MISS(root);
                    if (miss == 0) break;
                    if (miss * at_high > 0) {
                        high = root, at_high = miss;
                        if (side == 1) at_low /= 2;
                        side = 1;
                    } else {
                        low = root, at_low = miss;
                        if (side == -1) at_high /= 2;
                        side = -1;
                    }
                }
            }
            const double mean = (f + root) / 2, before = x;
            x = fq - bq * mean;
            w = fv - bv * mean;
            f = all_forces(count, forces, x, w, before, memory, after);
            memcpy(memory, after, count * sizeof *after);
#undef MISS
        }
        if (!(fabs(x) < 1e100 && fabs(w) < 1e100)) break;
        q[k + 1] = x, v[k + 1] = w, out[k + 1] = f;
    }
    for (index_t rest = k + 1; rest < n; rest++) q[rest] = v[rest] = out[rest] = NAN;
    return k + 1;
}

/* Forces against a given motion, sample by sample. */
EXPORT void hb_forces(index_t n, index_t count, const double *forces, double *memory,
                      const double *q, const double *v, double *out)
{
    double after[count + 1];
    for (index_t k = 0; k < n; k++) {
        out[k] = all_forces(count, forces, q[k], v[k], q[k ? k - 1 : 0], memory, after);
        memcpy(memory, after, count * sizeof *after);
    }
}

/* Level h of a store, h' = inflow - rate h^exponent, held below the height: what would
 * rise above it is spilt.  Runge-Kutta of second order (midpoint) in equal parts of each interval;
 * the inflow moves as in hb_mechanism. */
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
            const double half = fmax(0, h + t / 2 * (from - FLOW(h)));
            h = fmax(0, h + t * (from + slope / 2 - FLOW(half)));
            if (h > height) over += h - height, h = height;
        }
        level[k + 1] = h;
        outflow[k + 1] = FLOW(h);
        spilt[k + 1] = over / dt;
    }
#undef FLOW
}

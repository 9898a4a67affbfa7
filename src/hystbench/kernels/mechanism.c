/* One coordinate with forces inside: m q'' + c q' + k q + F(q, q') = p. */
#include "lanes.h"

#define NUMBERS 6 /* of a force: its kind is the first */
#define ROUNDS 100 /* of the search for the way of a step, at most */

enum { STIFFNESS, SINH, STOP, FRICTION, DRAG, HYSTERETIC, GRAVITY, SLIDER, SMOOTH };

static double dead_zone(double q, double gap)
{
    return q > gap ? q - gap : q < -gap ? q + gap : 0;
}

static double held(double z, double reach) { return fmax(-reach, fmin(reach, z)); }

/* Mean of a dead zone between two places. */
static double mean_dead_zone(double from, double to, double gap)
{
    const double a = dead_zone(from, gap), b = dead_zone(to, gap);
    return a * b > 0 || from == to ? (a + b) / 2 : (b - a) / (to - from) * (b + a) / 2;
}

/* Mean of a dead zone over a way on which z moves along until it is held at its reach. */
static double mean_held(double z, double way, double reach, double gap)
{
    const double from = held(z, reach), to = held(z + way, reach), moved = to - from;
    if (way == 0) return dead_zone(from, gap);
    const double rest = way - moved;
    return (mean_dead_zone(from, to, gap) * moved + dead_zone(to, gap) * rest) / way;
}

/* (exp(y) - 1) / y, and (exp(y) - 1 - y) / y^2, whose series is that of its first terms. */
static double phi1(double y) { return fabs(y) < 1e-8 ? 1 + y / 2 : expm1(y) / y; }

static double phi2(double y)
{
    if (fabs(y) > 0.3) return (expm1(y) - y) / (y * y);
    double sum = 0;
    for (int k = 14; k > 1; k--) sum = (1 + y * sum) / k;
    return sum;
}

/* Moves x, which follows x' = 1 + a x, and gives its integral over the way. */
static double integral_of(double *x, double a, double way)
{
    const double slope = 1 + a * *x, from = *x;
    if (!(slope > 0)) return from * way; /* it rests there */
    *x += slope * way * phi1(a * way);
    return way * (from + slope * way * phi2(a * way));
}

/* Bouc-Wen's operator with exponent 1, solved exactly: z of a reach of one after a way
 * in units of the yield distance, and its integral over the way.  Unloading is
 * 2 share |z| less stiff than in Dahl's form, which has a share of zero. */
static double bouc_wen(double z, double way, double share, double *integral)
{
    const double sign = way < 0 ? -1 : 1, b = 2 * share - 1, length = fabs(way);
    double x = sign * z, until = 0;
    *integral = 0;
    if (x < 0) { /* unloading, until x is zero */
        until = fabs(b) < 1e-9 ? -x : b * x > -1 ? -log1p(b * x) / b : length;
        until = fmin(until, length);
        *integral += integral_of(&x, b, until);
    }
    *integral += integral_of(&x, -1, length - until); /* loading */
    return sign * x;
}

/* The largest force of friction at a velocity, the largest at all being f[1] + f[2]. */
static double sliding(const double *f, double v)
{
    return f[1] + (f[3] > 0 ? f[2] * exp(-(v / f[3]) * (v / f[3])) : 0);
}

/* How far friction gives way; its stiffness is that of the largest force at rest. */
static double friction_reach(const double *f, double v)
{
    const double most = sliding(f, 0);
    return most > 0 ? f[4] * (sliding(f, v) / most) : 0;
}

/* What a force remembers after a way, of its memory before it; v is that at its end. */
static double remembered(const double *f, double way, double v, double memory)
{
    double integral;
    switch ((int)f[0]) {
    case FRICTION:
        return held(memory + way, friction_reach(f, v));
    case HYSTERETIC:
        return bouc_wen(memory, way / f[2], f[3], &integral);
    case SLIDER:
        return held(memory + way, f[2]);
    }
    return memory;
}

static double force(const double *f, double q, double v, double memory)
{
    switch ((int)f[0]) {
    case STIFFNESS:
        return q * q * (f[1] + f[2] * q);
    case SINH:
        return f[1] * (f[2] * sinh(q / f[2]) - q);
    case STOP: {
        const double way = q - f[3];
        return f[4] * way < 0 ? 0 : f[1] * dead_zone(way, f[2]);
    }
    case FRICTION:
        return sliding(f, 0) * memory / f[4];
    case DRAG:
        return f[1] * v * fabs(v);
    case HYSTERETIC:
        return f[1] * memory;
    case GRAVITY:
        return f[1] * (sin(q + f[2]) - sin(f[2]));
    case SMOOTH:
        return f[1] * tanh(v / f[2]);
    case SLIDER:
        return f[1] * dead_zone(memory, f[3]);
    }
    return NAN;
}

/* A force's mean over a way from q, which is its work over the way; v is the mean
 * velocity. */
static double mean_force(const double *f, double q, double way, double v, double memory)
{
    const double to = q + way, middle = q + way / 2, half = way / 2;
    switch ((int)f[0]) {
    case STIFFNESS:
        return f[1] * (q * q + q * to + to * to) / 3 + f[2] * middle * (q * q + to * to) / 2;
    case SINH: {
        const double y = half / f[2];
        return f[1] * (f[2] * sinh(middle / f[2]) * (y == 0 ? 1 : sinh(y) / y) - middle);
    }
    case STOP: {
        double from = q - f[3], end = to - f[3];
        if (f[4] != 0) { /* a side without contact counts as the middle */
            from = f[4] * fmax(0, f[4] * from);
            end = f[4] * fmax(0, f[4] * end);
        }
        const double mean = mean_dead_zone(from, end, f[2]);
        return f[1] * (way == 0 ? mean : mean * ((end - from) / way));
    }
    case FRICTION:
        return sliding(f, 0) * mean_held(memory, way, friction_reach(f, v), 0) / f[4];
    case SMOOTH:
        return f[1] * tanh(v / f[2]);
    case DRAG:
        return f[1] * v * fabs(v);
    case HYSTERETIC: {
        double integral;
        if (way == 0) return f[1] * memory;
        bouc_wen(memory, way / f[2], f[3], &integral);
        return f[1] * integral / (way / f[2]);
    }
    case GRAVITY:
        return f[1] * (sin(middle + f[2]) * (half == 0 ? 1 : sin(half) / half) - sin(f[2]));
    case SLIDER:
        return f[1] * mean_held(memory, way, f[2], f[3]);
    }
    return NAN;
}

/* Moves all memories by a way and gives the sum of the forces at its end. */
static double all_forces(index_t count, const double *forces, double q, double v,
                         double way, double *memory)
{
    double sum = 0;
    for (index_t i = 0; i < count; i++) {
        const double *f = forces + i * NUMBERS;
        memory[i] = remembered(f, way, v, memory[i]);
        sum += force(f, q, v, memory[i]);
    }
    return sum;
}

/* One part of an interval: from q, without forces by a way of `alone`, and less by
 * `gives` for each unit of force. */
struct part {
    index_t count;
    const double *forces, *memory;
    double q, alone, gives, h;
};

/* By how much a way is too long for the mean force over it. */
static double miss(const struct part *p, double way)
{
    double sum = 0;
    for (index_t i = 0; i < p->count; i++)
        sum += mean_force(p->forces + i * NUMBERS, p->q, way, way / p->h, p->memory[i]);
    return way - p->alone + p->gives * sum;
}

/* The way of a part, by Chandrupatla's method; NaN where there is none.  The miss grows
 * with the way at least as fast where no force falls: between zero and the way without
 * forces, or the one with the force of the beginning, there is then one root. */
static double way_of(const struct part *p)
{
    double a = 0, at_a = miss(p, 0), b = p->alone, at_b = miss(p, b);
    if (at_a == 0) return 0;
    if (at_b == 0) return b;
    if ((at_a > 0) == (at_b > 0)) b = -at_a, at_b = miss(p, b);
    for (int i = 0; i < ROUNDS && (at_a > 0) == (at_b > 0); i++) {
        a = b, at_a = at_b;
        b *= 2, at_b = miss(p, b);
    }
    if (!((at_a > 0) != (at_b > 0))) return NAN;
    double t = at_a / (at_a - at_b);
    for (int i = 0; i < ROUNDS; i++) {
        double c = b, at_c = at_b;
        const double x = a + (t > 0 && t < 1 ? t : 0.5) * (b - a), at_x = miss(p, x);
        if ((at_x > 0) == (at_a > 0))
            c = a, at_c = at_a;
        else
            b = a, at_b = at_a;
        a = x, at_a = at_x;
        const double best = fabs(at_a) < fabs(at_b) ? a : b, apart = fabs(b - a);
        const double near = 4e-16 * fabs(best) + 1e-16 * fabs(p->alone);
        if (at_a == 0 || apart <= near) return at_a == 0 ? a : best;
        const double xi = (a - b) / (c - b);
        const double phi = at_c == at_b ? 1 : (at_a - at_b) / (at_c - at_b);
        t = 0.5;
        if (phi != 1 && phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)
            t = at_a / (at_b - at_a) * at_c / (at_b - at_c) +
                (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b);
        t = fmax(near / apart / 2, fmin(1 - near / apart / 2, t));
    }
    return fabs(at_a) < fabs(at_b) ? a : b;
}

/* Motion q, v and force F of the samples, from q[0], v[0].  step holds, for one of
 * `parts` equal parts of an interval of dt: q and v after it of q, v, and of p at its
 * beginning and its end (two rows of four).  Over a part the forces count with their
 * mean over the way, which does their exact work: so a passive force never gives energy,
 * however stiff it is, and the method is of second order.  p moves by the share ramp of
 * a straight line in each interval (1: straight, 0: a staircase).
 * Returns the samples taken: fewer than n where the motion runs away; the rest is NaN. */
EXPORT index_t hb_mechanism(index_t n, index_t parts, double dt, double ramp,
                            const double *step, index_t count, const double *forces,
                            double *memory, const double *p, double *q, double *v,
                            double *out)
{
    struct part part = {count, forces, memory, 0, 0, step[2] + step[3], dt / parts};
    const double brakes = step[6] + step[7];
    index_t k = 0;
    out[0] = all_forces(count, forces, q[0], v[0], 0, memory);
    for (; k + 1 < n; k++) {
        const double slope = ramp * (p[k + 1] - p[k]) / parts;
        double x = q[k], w = v[k], f = out[k];
        for (index_t s = 0; s < parts; s++) {
            const double from = p[k] + s * slope, to = from + slope;
            const double driven = step[2] * from + step[3] * to;
            const double alone = step[0] * x + step[1] * w + driven;
            w = step[4] * x + step[5] * w + step[6] * from + step[7] * to;
            if (!count) {
                x = alone;
                continue;
            }
            part.q = x;
            part.alone = alone - x;
            const double way = way_of(&part);
            x += way;
            w -= brakes * ((part.alone - way) / part.gives);
            f = all_forces(count, forces, x, w, way, memory);
            if (!(fabs(x) < 1e100)) break;
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
    for (index_t k = 0; k < n; k++)
        out[k] = all_forces(count, forces, q[k], v[k], k ? q[k] - q[k - 1] : 0, memory);
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

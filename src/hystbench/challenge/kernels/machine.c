/* One moving part with forces inside, and tanks in a row.

   A mass takes half a kick, drifts, and takes the other half (velocity Verlet). Dry
   friction is set-valued: after each kick it takes away as much speed as it can, but
   never turns the motion round (Moreau). So a mass that the friction holds stands
   still. Springs with a memory follow the distance alone. */
#include <math.h>
#include <stddef.h>

#define EXPORT __attribute__((visibility("default")))

struct part {
    double mass, damping, stiffness;
    double quadratic, cubic, sinh_force, sinh_reach, pendulum, angle;
    double wall_right, wall_left, wall_stiffness;
    double coulomb, surplus, stribeck_speed, presliding, drag;
    double remembered, yield, sharpness, unloading;
    double slider_stiffness, slip, clearance;
    double coil_width, coil_shift, ripple, ripple_rate, ripple_phase;
    double loose_stiffness, loose, wear;
};

struct memory {
    double asperity, loop, slider, way, time;
};

static double clip(double x, double limit) { return fmax(-limit, fmin(limit, x)); }

static double friction_level(const struct part *p, double v)
{
    if (p->surplus == 0.0)
        return p->coulomb;
    double ratio = v / p->stribeck_speed;
    return p->coulomb + p->surplus * exp(-ratio * ratio);
}

/* Force of all springs that have no memory. */
static double spring(const struct part *p, double q)
{
    double f = q * (p->stiffness + q * (p->quadratic + q * p->cubic));
    if (p->sinh_force != 0.0)
        f += p->sinh_force * (sinh(q / p->sinh_reach) - q / p->sinh_reach);
    if (p->pendulum != 0.0)
        f += p->pendulum * (sin(q + p->angle) - sin(p->angle) - q * cos(p->angle));
    if (p->wall_stiffness != 0.0)
        f += p->wall_stiffness * (fmax(0.0, q - p->wall_right)
                                  - fmax(0.0, -p->wall_left - q));
    return f;
}

/* Force of all that remembers, and of drag. */
static double other(const struct part *p, const struct memory *m, double v)
{
    double f = p->drag * v * fabs(v) + p->remembered * m->loop;
    if (p->presliding > 0.0)
        f += friction_level(p, v) * m->asperity / p->presliding;
    if (p->slider_stiffness != 0.0)
        f += p->slider_stiffness * (m->slider - clip(m->slider, p->clearance));
    return f;
}

/* Force of what changes as time and way go by: a spring whose stiffness swings, and one
   behind a clearance that every way rubs wider. */
static double ageing(const struct part *p, const struct memory *m, double q)
{
    double f = 0.0;
    if (p->ripple != 0.0)
        f += p->stiffness * p->ripple * q
             * sin(p->ripple_rate * m->time + p->ripple_phase);
    if (p->loose_stiffness != 0.0)
        f += p->loose_stiffness * (q - clip(q, p->loose + p->wear * m->way));
    return f;
}

/* Share of its largest force that a coil has off the middle of its magnet. */
static double force_factor(const struct part *p, double q)
{
    if (p->coil_width == 0.0)
        return 1.0;
    double off = (q - p->coil_shift) / p->coil_width;
    return 1.0 / (1.0 + off * off);
}

/* Slope of the Bouc-Wen loop over the distance. */
static double loop_slope(const struct part *p, double z, double way)
{
    double turned = way * z < 0.0 ? 1.0 - 2.0 * p->unloading : 1.0;
    return (1.0 - pow(fabs(z), p->sharpness) * turned) / p->yield;
}

static void remember(const struct part *p, struct memory *m, double dq, double dt)
{
    m->way += fabs(dq);
    m->time += dt;
    if (p->presliding > 0.0)
        m->asperity = clip(m->asperity + dq, p->presliding);
    if (p->slider_stiffness != 0.0)
        m->slider = clip(m->slider + dq, p->slip);
    if (p->remembered != 0.0) {
        double begun = loop_slope(p, m->loop, dq);
        double ended = loop_slope(p, m->loop + dq * begun, dq);
        m->loop += 0.5 * dq * (begun + ended);
    }
}

/* Half a kick of length h by a force; then dry friction brakes. */
static double kicked(const struct part *p, double v, double force, double h)
{
    double brake = 0.5 * p->damping * h / p->mass;
    double free = (v * (1.0 - brake) + force * h / p->mass) / (1.0 + brake);
    if (p->presliding > 0.0)
        return free;
    double most = friction_level(p, v) * h / p->mass / (1.0 + brake);
    return free - clip(free, most);
}

/* The part moves under drive[k] or, where gain is above zero, under
   gain (drive - q) + rate_gain (drive' - v): drive is then a reference. */
EXPORT void hc_mass(ptrdiff_t n, double dt, double q, double v, double gain,
                    double rate_gain, const double *numbers, const double *drive,
                    double *force, double *position, double *velocity,
                    double *acceleration)
{
    const struct part *p = (const struct part *)numbers;
    struct memory m = {0.0, 0.0, 0.0, 0.0, 0.0};
    double before = v;
    for (ptrdiff_t k = 0; k < n; k++) {
        double u = drive[k];
        if (gain > 0.0) {
            double behind = drive[k > 0 ? k - 1 : k];
            double ahead = drive[k + 1 < n ? k + 1 : k];
            u = gain * (drive[k] - q)
                + rate_gain * (0.5 * (ahead - behind) / dt - before);
        }
        double held = u * force_factor(p, q) - spring(p, q) - ageing(p, &m, q);
        if (k > 0)
            v = kicked(p, before, held - other(p, &m, before), 0.5 * dt);
        force[k] = u;
        position[k] = q;
        velocity[k] = v;
        double after = kicked(p, v, held - other(p, &m, v), 0.5 * dt);
        acceleration[k] = k > 0 ? (after - before) / dt : (after - v) / (0.5 * dt);
        q += dt * after;
        remember(p, &m, dt * after, dt);
        before = after;
    }
}

/* Force that a prescribed motion takes. */
EXPORT void hc_impedance(ptrdiff_t n, double dt, const double *numbers,
                         const double *position, double *force)
{
    const struct part *p = (const struct part *)numbers;
    struct memory m = {0.0, 0.0, 0.0, 0.0, 0.0};
    for (ptrdiff_t k = 0; k < n; k++) {
        ptrdiff_t i = k < 1 ? 1 : (k + 2 > n ? n - 2 : k);
        double behind = position[i - 1], here = position[i], ahead = position[i + 1];
        double v = 0.5 * (ahead - behind) / dt;
        double a = (ahead - 2.0 * here + behind) / (dt * dt);
        if (k > 0)
            remember(p, &m, position[k] - position[k - 1], dt);
        force[k] = p->mass * a + p->damping * v + spring(p, position[k]) + other(p, &m, v);
        force[k] += ageing(p, &m, position[k]);
        if (p->presliding == 0.0)
            force[k] += friction_level(p, v) * ((v > 0.0) - (v < 0.0));
    }
}

struct tank {
    double area, coefficient, exponent, rim, caught, back, leak, leak_time;
};

/* Where the next tank stands against the outlet, the difference of levels drives it. */
static void flows(const struct tank *tank, ptrdiff_t count, double inflow,
                  const double *level, const double *wet, double *rate)
{
    for (ptrdiff_t i = 0; i < count; i++) {
        double head = fmax(level[i], 0.0), sign = 1.0;
        if (tank[i].back != 0.0 && i + 1 < count) {
            head = level[i] - level[i + 1];
            sign = head < 0.0 ? -1.0 : 1.0;
        }
        double out = sign * tank[i].coefficient * pow(fabs(head), tank[i].exponent);
        double lost = tank[i].leak * tank[i].coefficient * wet[i] * level[i];
        rate[i] = (inflow - out - lost) / tank[i].area;
        inflow = out;
    }
}

/* One or two tanks, each emptied by coefficient level^exponent into the next, by the
   classical Runge-Kutta method. What stands above the rim runs over after each step,
   and of it the share caught falls into the next tank. The inflow is that of the
   middle of a step, taken from both ends. A seal leaks by the level and by how wet it
   is, which follows the level slowly. */
EXPORT void hc_tanks(ptrdiff_t n, ptrdiff_t count, double dt, const double *numbers,
                     const double *begun, const double *inflow, double *last)
{
    const struct tank *tank = (const struct tank *)numbers;
    double h[2] = {begun[0], count > 1 ? begun[1] : 0.0}, g[2], r[4][2];
    double wet[2] = {h[0], h[1]};
    last[0] = h[count - 1];
    for (ptrdiff_t k = 0; k + 1 < n; k++) {
        double middle = 0.5 * (inflow[k] + inflow[k + 1]);
        flows(tank, count, inflow[k], h, wet, r[0]);
        for (ptrdiff_t i = 0; i < count; i++)
            g[i] = h[i] + 0.5 * dt * r[0][i];
        flows(tank, count, middle, g, wet, r[1]);
        for (ptrdiff_t i = 0; i < count; i++)
            g[i] = h[i] + 0.5 * dt * r[1][i];
        flows(tank, count, middle, g, wet, r[2]);
        for (ptrdiff_t i = 0; i < count; i++)
            g[i] = h[i] + dt * r[2][i];
        flows(tank, count, inflow[k + 1], g, wet, r[3]);
        double spilt = 0.0;
        for (ptrdiff_t i = 0; i < count; i++) {
            h[i] += dt / 6.0 * (r[0][i] + 2.0 * (r[1][i] + r[2][i]) + r[3][i]);
            h[i] = fmax(h[i] + spilt / tank[i].area, 0.0);
            double over = fmax(h[i] - tank[i].rim, 0.0);
            h[i] -= over;
            spilt = tank[i].caught * over * tank[i].area;
            if (tank[i].leak != 0.0)
                wet[i] += dt / tank[i].leak_time * (h[i] - wet[i]);
        }
        last[k + 1] = h[count - 1];
    }
}

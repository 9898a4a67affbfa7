/* One function for each kind of step: constants, states, then what enters.
 *
 * Plain C99: no allocation, no pointer that is kept, no number that is not a double or
 * an int. States are arrays that are all zero at the start. hystbench copies what a
 * model needs of this file into the model's own, behind what it needs of forces.c.
 */
#include <string.h>

#define HB_PI 3.14159265358979323846
#define HB_POINTS 32 /* samples that a curve goes through at most */

static double hb_weighted(int count, const double *weights, const double *values)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += weights[i] * values[i];
    return sum;
}

/* Go on, before the first of the known samples, with what came after it turned about
 * it, as the simulation does; behind that straight on. */
static void hb_continue(int count, int known, double *values)
{
    const int first = known - 1;
    for (int i = known; i < count; i++) {
        if (i <= 2 * first)
            values[i] = 2 * values[first] - values[2 * first - i];
        else
            values[i] = 2 * values[i - 1] - values[i > 1 ? i - 2 : 0];
    }
}

/* history[0] counts the samples, up to points; then come the samples, the newest first. */
static void hb_remember(int points, double *history, double v)
{
    double *values = history + 1;
    for (int i = points - 1; i > 0; i--) values[i] = values[i - 1];
    values[0] = v;
    if (history[0] < points) {
        history[0] += 1;
        hb_continue(points, (int)history[0], values);
    }
}

/* Play operator, Eqs. 1 and 2; generalized play operator, Eq. 4. */
static double hb_play(double left, double right, double r, double *w)
{
    *w = hb_most(right - r, hb_least(left + r, *w));
    return *w;
}

static double hb_polynomial(int count, const double *coefficients, double z)
{
    double y = 0;
    for (int i = count - 1; i >= 0; i--) y = y * z + coefficients[i];
    return y;
}

static double hb_exponential(double curvature, double z)
{
    return curvature == 0 ? z : expm1(curvature * z) / curvature;
}

static double hb_two_slopes(double difference, double z)
{
    return z + difference * fabs(z);
}

static double hb_magnitude(double scale, double z)
{
    return scale * fabs(z);
}

static double hb_saturation(double level, double sharpness, double z)
{
    const double ratio = z / level;
    if (sharpness == 0) return level * tanh(ratio);
    /* Beyond the level the inverse of the ratio: no power of a large one is taken. */
    const double size = fabs(ratio), inside = fmin(size, 1);
    const double bent =
        inside / pow(1 + pow(inside / fmax(size, 1), sharpness), 1 / sharpness);
    return copysign(level * bent, z);
}

static double hb_rounded_dead_zone(double half_width, double rounding, double z)
{
    if (rounding == 0) return hb_dead_zone(half_width, z);
    return z - half_width * tanh(z / rounding);
}

static double hb_between(double upper, double lower, double z)
{
    return hb_most(lower, hb_least(upper, z));
}

static double hb_dead_band(double upper, double lower, double z)
{
    return z - hb_between(upper, lower, z);
}

static double hb_backlash(double half_width, double *started, double *w, double z)
{
    if (*started == 0) *w = z;
    *started = 1;
    return hb_play(z, z, half_width, w);
}

/* Weigh the newest samples. */
static double hb_at_samples(int points, const double *taps, double *history, double z)
{
    hb_remember(points, history, z);
    return hb_weighted(points, taps, history + 1);
}

/* What entered so many samples before. */
static double hb_late(int samples, double *kept, double z)
{
    const double before = kept[samples - 1];
    for (int i = samples - 1; i > 0; i--) kept[i] = kept[i - 1];
    kept[0] = z;
    return before;
}

static double hb_friction(double coulomb, double velocity_scale, int points,
                          const double *rate, double *history, double z)
{
    const double velocity =
        history[0] > 1 ? hb_weighted(points, rate, history + 1) : 0;
    return z + coulomb * tanh(velocity / velocity_scale);
}

/* The path goes in straight lines through values that lie spacing samples apart. */
static double hb_drift(double slope, double spacing, int values, const double *path,
                       double *count, double z)
{
    const double now = *count, place = now / spacing;
    const int last = values - 1, before = place < last ? (int)place : last;
    double y = z + slope * now + path[before];
    if (before < last) y += (place - before) * (path[before + 1] - path[before]);
    *count = now + 1;
    return y;
}

static double hb_mains_pickup(double cycles, int harmonics, const double *amplitudes,
                              const double *phases, double *count, double z)
{
    double y = z, turns = cycles * *count;
    turns -= floor(turns);
    for (int i = 0; i < harmonics; i++)
        y += amplitudes[i] * sin(2 * HB_PI * (i + 1) * turns + phases[i]);
    *count += 1;
    return y;
}

/* Exact for an input that goes straight: where the output catches up within an
 * interval it follows from there, or goes on at the limit. */
static double hb_slew_limit(double rising, double falling, double *started,
                            double *before, double *now, double z)
{
    if (*started == 0) *before = *now = z;
    *started = 1;
    const double slope = z - *before, lag = *before - *now;
    const double way = (lag != 0 ? lag : slope) > 0 ? rising : -falling;
    const double at = lag != 0 ? lag / (way - slope) : 0;
    if (!(at >= 0 && at < 1))
        *now += way;
    else if (-falling <= slope && slope <= rising)
        *now = z;
    else
        *now = z - (1 - at) * (slope - (slope > 0 ? rising : -falling));
    *before = z;
    return *now;
}

/* x is (z - v) / (R tau): the input moves by half of its way, x relaxes, the input moves
 * on.  Where it is below zero, R is down times that. */
static double hb_slew_with_lag(int sharp, double rate, double down, double share,
                               double *started, double *before, double *x, double z)
{
    const int parts = (int)ceil(8 * share);
    const double h = share / parts, fade = exp(-h);
    if (*started == 0) *before = z;
    const double half = 0.5 * (z - *before) / rate * h;
    for (int part = 0; *started != 0 && part < parts; part++) {
        const double unit = *x + half < 0 ? down : 1, at = (*x + half) / unit;
        const double size = fabs(at);
        double then;
        if (size > (sharp ? 1 : 20) + h)
            then = at - copysign(h, at);
        else if (sharp)
            then = size > 1 ? copysign(exp(size - 1 - h), at) : at * fade;
        else
            then = asinh(sinh(at) * fade);
        *x = unit * then + half;
    }
    *started = 1;
    *before = z;
    return z - *x * rate / share;
}

/* x(k) = phi x(k-1) + sum_j drive_j v(k-j), y = output x + direct v. */
static double hb_linear(int size, int points, int ahead, const double *phi,
                        const double *drive, const double *output, double direct, int settled,
                        double statics, double *x, double *next, double *history,
                        double *offset, double z)
{
    const int moves = history[0] > ahead;
    if (settled && history[0] == 0) *offset = z;
    hb_remember(points, history, z - *offset);
    double y = direct * history[1 + ahead] + statics * *offset;
    for (int i = 0; i < size; i++) {
        next[i] = 0;
        if (!moves) continue;
        for (int j = 0; j < size; j++) next[i] += phi[i * size + j] * x[j];
        for (int j = 0; j < points; j++) next[i] += drive[j * size + i] * history[1 + j];
    }
    for (int i = 0; i < size; i++) {
        x[i] = next[i];
        y += output[i] * x[i];
    }
    return y;
}

/* The same where phi is diagonal. */
static double hb_modes(int size, int points, int ahead, const double *phi,
                       const double *drive, const double *output, double direct, int settled, double statics,
                       double *x, double *history, double *offset, double z)
{
    const int moves = history[0] > ahead;
    if (settled && history[0] == 0) *offset = z;
    hb_remember(points, history, z - *offset);
    double y = direct * history[1 + ahead] + statics * *offset;
    for (int i = 0; i < size && moves; i++) {
        x[i] *= phi[i];
        for (int j = 0; j < points; j++) x[i] += drive[j * size + i] * history[1 + j];
        y += output[i] * x[i];
    }
    return y;
}

/* lags holds what is left of each state, then what the last and the new input add. */
static double hb_thermal_drift(double coefficient, int count, const double *lags,
                               int points, double *history, double *started,
                               double *before, double *x, double z)
{
    double heat = history[points] * history[points];
    for (int i = 0; i < count; i++) {
        const double *lag = lags + 3 * i;
        if (*started != 0) x[i] = lag[0] * x[i] + lag[1] * before[i] + lag[2] * heat;
        before[i] = heat;
        heat = x[i];
    }
    *started = 1;
    return z + coefficient * heat;
}

/* kept is a ring of first + points samples; the taps lie first samples back and more. */
static double hb_input_delay(double shift, double settled, int first, int points,
                             const double *taps, double *count, double *kept, double z)
{
    double window[HB_POINTS];
    const double room = first + points, now = *count;
    kept[(int)fmod(now, room)] = z;
    *count = now + 1;
    if (now < shift) return settled * kept[0];
    int known = 0;
    for (; known < points && now - first - known >= 0; known++)
        window[known] = kept[(int)fmod(now - first - known, room)];
    hb_continue(points, known, window);
    return hb_weighted(points, taps, window);
}

/* A mode whose stiffness grows with its displacement: the classical Runge-Kutta method
 * in steps of at most 0.1 radian of the stiffened mode, over segments of an interval in
 * which the force goes straight from corner to corner. mode: displacement, velocity. */
static double hb_stiffness_hardening(double participation, double phase, double damping,
                                     double coefficient, int segments, int points,
                                     int ahead, const double *corners, double ramp,
                                     double *mode, double *history, double z)
{
#define HB_BEND(x, v, f) ((f) - (x) * (1 + coefficient * (x) * (x)) - 2 * damping * (v))
    double x = mode[0], v = mode[1];
    const int moves = history[0] > ahead;
    hb_remember(points, history, z);
    for (int i = 0; i < segments && moves; i++) {
        const double now = hb_weighted(points, corners + i * points, history + 1);
        const double then = hb_weighted(points, corners + (i + 1) * points, history + 1);
        const double slope = ramp * (then - now), reach = fmax(fabs(x), fabs(then));
        const double stiffness = sqrt(1 + 3 * fabs(coefficient) * reach * reach);
        const double steps = ceil(phase * fmax(stiffness, damping) / 0.1);
        const double h = phase / steps, part = 1 / steps;
        if (!(steps < 1e5)) x = NAN; /* it has run away, and stays there */
        for (double s = 0; s < steps && x == x; s++) {
            const double f1 = now + s * part * slope;
            const double f2 = now + (s + 0.5) * part * slope;
            const double f4 = now + (s + 1) * part * slope;
            const double a1 = HB_BEND(x, v, f1);
            const double v2 = v + h / 2 * a1, x2 = x + h / 2 * v;
            const double a2 = HB_BEND(x2, v2, f2);
            const double v3 = v + h / 2 * a2, x3 = x + h / 2 * v2;
            const double a3 = HB_BEND(x3, v3, f2);
            const double v4 = v + h * a3, x4 = x + h * v3;
            const double a4 = HB_BEND(x4, v4, f4);
            x += h / 6 * (v + 2 * (v2 + v3) + v4);
            v += h / 6 * (a1 + 2 * (a2 + a3) + a4);
        }
    }
    mode[0] = x;
    mode[1] = v;
    return (1 - participation) * history[1 + ahead] + participation * x;
#undef HB_BEND
}

static double hb_outflow(double rate, double exponent, double h)
{
    return h > 0 ? rate * pow(h, exponent) : 0;
}

/* A level above a rim after a time in which it runs over a weir; one of 1e30 is sharp. */
static double hb_over_rim(double h, double height, double weir, double t)
{
    if (weir >= 1e30) return height;
    const double by = 1 + 0.5 * weir * t * sqrt(h - height);
    return height + (h - height) / (by * by);
}

/* Where as much leaves a store as enters it. */
static double hb_settled_store(double inflow, double rate, double exponent, double height,
                               double weir)
{
    const double rests = inflow > 0 ? pow(inflow / rate, 1 / exponent) : 0;
    if (!(rests > height) || weir >= 1e30) return hb_least(height, rests);
    double low = height, high = height + pow(inflow / weir, 2.0 / 3);
    for (int i = 0; i < 60; i++) {
        const double middle = (low + high) / 2, over = middle - height;
        if (rate * pow(middle, exponent) + weir * over * sqrt(over) < inflow)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* Runge-Kutta method of second order, over straight lines as for the mechanism; with an
 * exponent of one and no rim (a height of 1e30) it is exact. */
static double hb_store(double gain, double bias, int segments, int points,
                       int ahead, const double *corners, double ramp, int parts, double t,
                       double rate, double exponent, double height, double weir, double start,
                       int settled, int outflow, double caught, double *level, double *history,
                       double z)
{
    const int sharp = weir >= 1e30;
    const int moves = history[0] > ahead;
    hb_remember(points, history, gain * z + bias);
    if (history[0] <= ahead) return 0;
    const double first = history[1 + ahead];
    if (settled) start = hb_settled_store(first, rate, exponent, height, weir);
    double h = moves ? *level : sharp ? hb_least(start, height) : start, over = 0;
    const double lost = rate * t, kept = exp(-lost);
    const double steady = lost > 1e-5 ? (1 - kept) / rate : t;
    const double rising = lost > 1e-5 ? (t - steady) / lost : t / 2;
    for (int i = 0; i < segments && moves; i++) {
        const double now = hb_weighted(points, corners + i * points, history + 1);
        const double then = hb_weighted(points, corners + (i + 1) * points, history + 1);
        const double slope = ramp * (then - now) / parts;
        for (int s = 0; s < parts; s++) {
            const double from = now + s * slope;
            if (h > height) {
                const double left = hb_over_rim(h, height, weir, t / 2);
                over += h - left;
                h = left;
            }
            if (exponent == 1 && height >= 1e30) {
                h = hb_most(0, kept * h + steady * from + rising * slope);
            } else {
                const double rise = t / 2 * (from - hb_outflow(rate, exponent, h));
                const double half = hb_most(0, h + rise);
                const double middle = sharp ? hb_least(height, half) : half;
                const double left = hb_outflow(rate, exponent, middle);
                h = hb_most(0, h + t * (from + slope / 2 - left));
            }
            if (h > height) {
                const double left = hb_over_rim(h, height, weir, t / 2);
                over += h - left;
                h = left;
            }
        }
    }
    *level = h;
    const double spilt = over / (segments * parts * t);
    return outflow ? hb_outflow(rate, exponent, h) + caught * spilt : h;
}

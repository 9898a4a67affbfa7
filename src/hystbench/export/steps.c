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

static double hb_saturation(double level, double sharpness, double z)
{
    const double ratio = z / level;
    if (sharpness == 0) return level * tanh(ratio);
    return z / pow(1 + pow(fabs(ratio), sharpness), 1 / sharpness);
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
static double hb_slew_limit(double rate, double *started, double *before, double *now,
                            double z)
{
    if (*started == 0) *before = *now = z;
    *started = 1;
    const double slope = z - *before, lag = *before - *now;
    const double way = copysign(rate, lag != 0 ? lag : slope);
    const double at = lag != 0 ? lag / (way - slope) : 0;
    if (!(at >= 0 && at < 1))
        *now += way;
    else if (fabs(slope) <= rate)
        *now = z;
    else
        *now = z - (1 - at) * (slope - copysign(rate, slope));
    *before = z;
    return *now;
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
static double hb_input_delay(double shift, int first, int points, const double *taps,
                             double *count, double *kept, double z)
{
    double window[HB_POINTS];
    const double room = first + points, now = *count;
    kept[(int)fmod(now, room)] = z;
    *count = now + 1;
    if (now < shift) return kept[0];
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
                                     double coefficient, double ramp, int segments,
                                     int points, int ahead, const double *corners,
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

/* Eq. 9, thresholds times growth. envelope: a0 to a7 of Eqs. 5 and 6. */
static double hb_gpi(const double *envelope, int count, const double *thresholds,
                     const double *weights, double *w, double v, double growth)
{
    const double *a = envelope;
    const double left = a[0] * tanh(a[1] * v + a[2]) + a[3];
    const double right = a[4] * tanh(a[5] * v + a[6]) + a[7];
    double y = 0;
    for (int i = 0; i < count; i++)
        y += weights[i] * hb_play(left, right, growth * thresholds[i], w + i);
    return y;
}

static double hb_prandtl_ishlinskii(int count, const double *thresholds,
                                    const double *weights, const double *square_weights,
                                    const double *cube_weights, double *w, double v,
                                    double growth)
{
    double y = v;
    for (int i = 0; i < count; i++) {
        const double p = hb_play(v, v, growth * thresholds[i], w + i);
        y += p * (weights[i] + p * (square_weights[i] + p * cube_weights[i]));
    }
    return y;
}

/* What is added to the hysteresis inside. */
static double hb_hysteresis_shape(int count, const double *thresholds,
                                  const double *weights, const double *square_weights,
                                  int degrees, const double *powers, double *w, double v,
                                  double growth)
{
    double y = hb_polynomial(degrees, powers, v);
    for (int i = 0; i < count; i++) {
        const double p = hb_play(v, v, growth * thresholds[i], w + i);
        y += p * (weights[i] + p * square_weights[i]);
    }
    return y;
}

/* What is added to the hysteresis inside. */
static double hb_butterfly(double coefficient, double threshold, double *w, double v,
                           double growth)
{
    const double p = hb_play(v, v, growth * threshold, w);
    return coefficient * p * p;
}

/* s > 0 with s + scale (s / unit)^power = all, power at least 1, by Newton's method. */
static double hb_split(double all, double scale, double unit, double power, double s)
{
    for (int step = 0; step < 60 && s > 0; step++) {
        const double rest = scale * pow(s / unit, power);
        const double change = (s + rest - all) / (1 + power * rest / s);
        s -= change;
        if (fabs(change) <= 1e-13 * all) break;
    }
    return s;
}

/* The field that acts, where v - field = c |rate|^a sign(rate): implicit Euler.
 * field[0] is the field, field[1] the guess that the last step leaves. */
static double hb_acting_field(double c, double a, double dt, double *field, double v)
{
    const double apart = v - field[0], all = fabs(apart);
    const int lags = a <= 1;
    const double scale = lags ? dt : c, unit = lags ? c : dt, power = lags ? 1 / a : a;
    double guess = field[1];
    if (c == 0 || !(all > 0)) {
        field[0] = v;
        return v;
    }
    if (!(guess > 0 && guess < all))
        guess = hb_least(all, unit * pow(all / scale, 1 / power));
    guess = hb_least(hb_split(all, scale, unit, power, guess), all);
    field[0] = lags ? v - copysign(guess, apart) : field[0] + copysign(guess, apart);
    field[1] = guess;
    return field[0];
}

/* Fields and growths that what is inside gets, one after the other; gives how many.
 * form: 0 growing thresholds, 1 excess field, 2 acting field. */
static int hb_rate_dependent_hysteresis(int form, double coefficient, double exponent,
                                        double dt, int fine, int points, int ahead,
                                        const double *values, const double *rates,
                                        double *history, double *growth_before,
                                        double *field, double v, double growth,
                                        double *fields, double *growths)
{
    const int first = history[0] == ahead, count = first ? 1 : fine;
    hb_remember(points, history, v);
    if (history[0] <= ahead) return 0;
    v = history[1 + ahead];
    if (first) {
        *growth_before = growth;
        field[0] = v;
    }
    for (int i = 0; i < count; i++) {
        const int row = first ? fine - 1 : i;
        const double *taps = rates + row * points, *samples = history + 1;
        const double rate = history[0] > 1 ? hb_weighted(points, taps, samples) : 0;
        const double effect = coefficient * pow(fabs(rate), exponent);
        double now = row == fine - 1 ? v : hb_weighted(points, values + row * points, samples);
        double factor = *growth_before + (growth - *growth_before) * (row + 1) / fine;
        if (form == 0)
            factor *= 1 + effect;
        else if (form == 1)
            now -= copysign(effect, rate);
        else
            now = hb_acting_field(coefficient, exponent, dt, field, now);
        fields[i] = now;
        growths[i] = factor;
    }
    *growth_before = growth;
    return count;
}

/* Thresholds and weights that follow the rate: docs/rdgpi.md of hystbench. */
static double hb_rdgpi(const double *spacing, const double *loss, double weight,
                       double tau, double envelope_gain, double envelope_offset,
                       int points, int ahead, const double *rate, int count,
                       double *history, double *w, double z)
{
    hb_remember(points, history, z);
    if (history[0] <= ahead) return 0;
    z = history[1 + ahead];
    const double speed =
        history[0] > 1 ? fabs(hb_weighted(points, rate, history + 1)) : 0;
    const double apart = spacing[0] * log(spacing[1] + spacing[2] * speed);
    const double ratio = exp(-tau * apart), envelope = envelope_gain * z + envelope_offset;
    double y = 0, power = 1;
    for (int i = 0; i < count; i++) {
        y += power * hb_play(envelope, envelope, i * apart, w + i);
        power *= ratio;
    }
    return weight * (1 - loss[0] * log(loss[1] + loss[2] * speed)) * y;
}

/* Mass of the density below x and below y, in cells: bilinear within a cell. */
static double hb_mass(int cells, const double *mass, double x, double y)
{
    int i = (int)x, j = (int)y;
    if (i == cells) i--;
    if (j == cells) j--;
    const double *low = mass + i * (cells + 1) + j, *high = low + cells + 1;
    const double below = low[0] + (y - j) * (low[1] - low[0]);
    const double above = high[0] + (y - j) * (high[1] - high[0]);
    return below + (x - i) * (above - below);
}

/* Output of all relays from negative saturation on, by Everett's function at the turning
 * points that are not wiped out. memory: whether it has started, the number of turns, the
 * place in cells and the output. Where there is no room, the two newest turns go. */
static double hb_relays(int cells, int room, double limit, const double *mass,
                        double *memory, double *turns, double *outputs, double z)
{
    int depth = (int)memory[1];
    const double place = (z + limit) / (2 * limit) * cells;
    const double x = hb_most(0, hb_least(cells, place));
    if (depth % 2 == 0 ? x < memory[2] : x > memory[2]) {
        if (depth + 2 >= room) depth -= 2;
        depth++;
        turns[depth] = memory[2];
        outputs[depth] = memory[3];
    }
    if (depth % 2 == 0) {
        while (depth >= 2 && x >= turns[depth - 1]) depth -= 2;
    } else {
        while (depth >= 3 && x <= turns[depth - 1]) depth -= 2;
        if (depth == 1 && x <= turns[0]) depth = 0;
    }
    const double turn = turns[depth], own = hb_mass(cells, mass, turn, turn);
    const double everett =
        0.5 * (hb_mass(cells, mass, x, x) + own) - hb_mass(cells, mass, x, turn);
    memory[1] = depth;
    memory[2] = x;
    memory[3] = outputs[depth] + (depth % 2 ? -everett : everett);
    return memory[3];
}

static double hb_preisach(int cells, int room, double limit, double reversible,
                          const double *mass, double *memory, double *turns,
                          double *outputs, double z)
{
    if (memory[0] == 0) { /* demagnetized by alternating, falling inputs */
        for (int i = cells; i > 0; i--) {
            const double size = limit * i / cells;
            hb_relays(cells, room, limit, mass, memory, turns, outputs, size);
            hb_relays(cells, room, limit, mass, memory, turns, outputs, -size);
        }
        hb_relays(cells, room, limit, mass, memory, turns, outputs, 0);
        memory[0] = 1;
        memory[4] = memory[3];
    }
    const double y = hb_relays(cells, room, limit, mass, memory, turns, outputs, z);
    return reversible * z + y - memory[4];
}

/* Langevin's function over its argument; near zero by its series. */
static double hb_langevin_ratio(double x)
{
    const double q = x * x, size = fabs(x), e = exp(-2 * size);
    if (q < 0.01)
        return 1. / 3 + q * (-1. / 45 + q * (2. / 945 + q * (-1. / 4725 + q * 2. / 93555)));
    return ((1 + e) / (1 - e) - 1 / size) / size;
}

/* Slope dm/dh of Jiles and Atherton, the field moving in a direction. */
static double hb_magnetization_slope(double h, double m, double direction, double shape,
                                     double coupling, double pinning,
                                     double reversibility)
{
    const double x = (h + coupling * m) / shape;
    const double ratio = hb_langevin_ratio(x), anhysteretic = x * ratio;
    const double rise = (1 - anhysteretic * anhysteretic - 2 * ratio) / shape;
    const double gap = direction * (anhysteretic - m);
    const double effective = (gap > 0 ? gap / pinning : 0) + reversibility * rise;
    return effective / (1 - coupling * effective);
}

/* The classical Runge-Kutta method in steps of the field; states count from the bias. */
static double hb_jiles_atherton(double saturation, double shape, double coupling,
                                double pinning, double reversibility, double longest,
                                double bias, double start, double *field,
                                double *magnetization, double z)
{
#define HB_SLOPE(h, m) \
    hb_magnetization_slope(h, m, direction, shape, coupling, pinning, reversibility)
    const double way = (bias + z) - (bias + *field), direction = way < 0 ? -1 : 1;
    const double steps = isfinite(way) ? ceil(fabs(way) / longest) : 0;
    const double each = way / (steps > 0 ? steps : 1);
    double m = isfinite(way) ? start + *magnetization : NAN;
    for (double s = 0; s < steps; s++) {
        const double at = bias + *field + s * each;
        const double first = HB_SLOPE(at, m);
        const double second = HB_SLOPE(at + each / 2, m + each / 2 * first);
        const double third = HB_SLOPE(at + each / 2, m + each / 2 * second);
        const double fourth = HB_SLOPE(at + each, m + each * third);
        m += each / 6 * (first + 2 * (second + third) + fourth);
    }
    *field = z;
    *magnetization = m - start;
    return saturation * *magnetization;
#undef HB_SLOPE
}

static double hb_outflow(double rate, double exponent, double h)
{
    return h > 0 ? rate * pow(h, exponent) : 0;
}

/* Runge-Kutta method of second order, over straight lines as for the mechanism. */
static double hb_store(double gain, double bias, int segments, int points,
                       int ahead, const double *corners, double ramp, int parts, double t,
                       double rate, double exponent, double height, double start,
                       int outflow, double caught, double *level, double *history,
                       double z)
{
    const int moves = history[0] > ahead;
    hb_remember(points, history, gain * z + bias);
    if (history[0] <= ahead) return 0;
    double h = moves ? *level : hb_least(start, height), over = 0;
    for (int i = 0; i < segments && moves; i++) {
        const double now = hb_weighted(points, corners + i * points, history + 1);
        const double then = hb_weighted(points, corners + (i + 1) * points, history + 1);
        const double slope = ramp * (then - now) / parts;
        for (int s = 0; s < parts; s++) {
            const double from = now + s * slope;
            const double rise = t / 2 * (from - hb_outflow(rate, exponent, h));
            const double half = hb_least(height, hb_most(0, h + rise));
            const double left = hb_outflow(rate, exponent, half);
            h = hb_most(0, h + t * (from + slope / 2 - left));
            if (h > height) {
                over += h - height;
                h = height;
            }
        }
    }
    *level = h;
    const double spilt = over / (segments * parts * t);
    return outflow ? hb_outflow(rate, exponent, h) + caught * spilt : h;
}

/* Steps of hysteresis, a function for each kind as in steps.c. */

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

static double hb_bouc_wen_beside(double weight, double softens, double stiffens,
                                 double *before, double *h, double v)
{
    double integral;
    *h = hb_bouc_wen(*h, v - *before, softens, stiffens, &integral);
    *before = v;
    return v + weight * *h;
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

/* By how much thresholds grow with a rate: a power of it, or beyond a knee its
 * logarithm. */
static double hb_growth(double coefficient, double exponent, double knee, double rate)
{
    if (knee == 0) return coefficient * pow(fabs(rate), exponent);
    return coefficient * pow(knee, exponent) * asinh(pow(fabs(rate) / knee, exponent));
}

/* Fields and growths that what is inside gets, one after the other; gives how many.
 * form: 0 growing thresholds, 1 excess field, 2 acting field. */
static int hb_rate_dependent_hysteresis(int form, double coefficient, double exponent,
                                        double knee, double dt, int fine, int points, int ahead,
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
        const double effect = hb_growth(coefficient, exponent, knee, rate);
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

/* Forces against one coordinate: their laws, and the way of a step against them.
 *
 * A force is a row of seven numbers: its law's number, and those of the law. It remembers
 * one number; an attached mass two, the second that of a row of zeros behind. structure.c
 * includes this file, and `hystbench export` copies what a model needs of it into C99
 * that stands alone: so no type of its own, and nothing but mathematics.
 */
#include <math.h>

#define HB_ROW 7 /* numbers of a row: ROW of blocks/force.py */
enum { /* laws by their number: LAWS of blocks/force.py, which a test compares */
    HB_STIFFNESS, HB_SINH, HB_STOP, HB_FRICTION, HB_DRAG, HB_HYSTERETIC, HB_GRAVITY,
    HB_SLIDER, HB_SMOOTH, HB_RELAXATION, HB_ATTACHED, HB_LUGRE, HB_FASTER, HB_SATURATING
};

static double hb_least(double a, double b) { return a < b ? a : b; }

static double hb_most(double a, double b) { return a > b ? a : b; }

static double hb_clip(double limit, double z) { return hb_most(-limit, hb_least(limit, z)); }

static double hb_dead_zone(double half_width, double z)
{
    return z - hb_clip(half_width, z);
}

/* A contact's force where it loses energy: larger on the way in, and never a pull. */
static double hb_lossy(double loss, double pressed, double v)
{
    return pressed * hb_most(0, 1 + (pressed > 0 ? loss : -loss) * v);
}

/* Mean of a dead zone between two places. */
static double hb_mean_dead_zone(double from, double to, double gap)
{
    const double a = hb_dead_zone(gap, from), b = hb_dead_zone(gap, to);
    return a * b > 0 || from == to ? (a + b) / 2 : (b - a) / (to - from) * (b + a) / 2;
}

/* Of a dead zone with a sign, a power that is at least one. */
static double hb_pressed(double power, double into)
{
    return power == 1 ? into : copysign(pow(fabs(into), power), into);
}

/* Mean of a power of a dead zone between two places: near one another, where a difference
 * would be rounding, by Simpson's rule. */
static double hb_mean_pressed(double from, double to, double gap, double power)
{
    if (power == 1) return hb_mean_dead_zone(from, to, gap);
    const double a = hb_dead_zone(gap, from), b = hb_dead_zone(gap, to);
    if (from == to || (a * b > 0 && fabs(b - a) < 1e-2 * fabs(a + b)))
        return (hb_pressed(power, a) + 4 * hb_pressed(power, (a + b) / 2) +
                hb_pressed(power, b)) / 6;
    return (pow(fabs(b), power + 1) - pow(fabs(a), power + 1)) / ((power + 1) * (to - from));
}

/* Mean of a dead zone over a way on which z moves along until its reach holds it. */
static double hb_mean_held(double z, double way, double reach, double gap)
{
    const double from = hb_clip(reach, z), to = hb_clip(reach, z + way);
    if (gap == 0 && from == z && to == z + way) return (from + to) / 2; /* not held */
    if (way == 0) return hb_dead_zone(gap, from);
    const double moved = to - from, rest = way - moved;
    const double climbed = moved * (gap == 0 ? (from + to) / 2
                                             : hb_mean_dead_zone(from, to, gap));
    return (climbed + hb_dead_zone(gap, to) * rest) / way;
}

/* (exp(y) - 1) / y, and (exp(y) - 1 - y) / y^2: near zero the latter is its series,
 * the sum of y^k / (k + 2)!. */
static double hb_phi(double y, double *twice)
{
    static const double share[] = {
        1.0 / 2,      1.0 / 6,       1.0 / 24,       1.0 / 120,
        1.0 / 720,    1.0 / 5040,    1.0 / 40320,    1.0 / 362880,
        1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800,
    };
    if (fabs(y) > 0.3) {
        const double once = expm1(y) / y;
        *twice = (once - 1) / y;
        return once;
    }
    double sum = 0; /* as many terms as are more than rounding: most ways are short */
    for (int k = fabs(y) < 0.02 ? 6 : 11; k >= 0; k--) sum = sum * y + share[k];
    *twice = sum;
    return 1 + y * sum;
}

/* Moves x, which follows x' = 1 + a x, and gives its integral over the way. */
static double hb_integral_of(double *x, double a, double way)
{
    const double slope = 1 + a * *x, from = *x;
    if (!(slope > 0) || way == 0) return from * way; /* it rests there */
    double twice;
    *x += slope * way * hb_phi(a * way, &twice);
    return way * (from + slope * way * twice);
}

/* Moves x, which follows x' = 1 + a x^2, and gives its integral over the way: a tangent
 * of the way, or a hyperbolic one. */
static double hb_integral_of_square(double *x, double a, double way)
{
    const double from = *x, root = sqrt(fabs(a)), by = root * way;
    if (by == 0 || !(1 + a * from * from > 0)) { /* straight, or it rests there */
        *x += a == 0 ? way : 0;
        return way * (from + *x) / 2;
    }
    if (a < 0 && by > 20) { /* all but at its end */
        *x = 1 / root;
        return (by + log((1 + root * from) / 2)) / -a;
    }
    const double half = a < 0 ? sinh(by / 2) : sin(by / 2);
    const double once = a < 0 ? tanh(by) : tan(by);
    const double also = root * from * (a < 0 ? sinh(by) : -sin(by));
    const double turns = a < 0 ? 1 : -1;
    *x = (from + once / root) / (1 + turns * root * from * once);
    return log1p(turns * 2 * half * half + also) / -a;
}

/* Bouc-Wen's operator with exponent 2, as hb_bouc_wen: x moves by 1 - softens x^2 on
 * loading and by 1 + stiffens x^2 on unloading. */
static double hb_bouc_wen_square(double x, double way, double softens, double stiffens,
                                 double *integral)
{
    const double sign = way < 0 ? -1 : 1, length = fabs(way), root = sqrt(fabs(stiffens));
    double until = 0;
    x *= sign;
    *integral = 0;
    if (x < 0) { /* unloading, until x is zero */
        const double y = -root * x;
        until = root == 0 ? -x : stiffens > 0 ? atan(y) / root : length;
        if (stiffens < 0 && y < 1) until = atanh(y) / root;
        until = fmin(until, length);
        *integral += hb_integral_of_square(&x, stiffens, until);
    }
    *integral += hb_integral_of_square(&x, -softens, length - until); /* loading */
    return sign * x;
}

/* Bouc-Wen's operator with exponent 1, solved exactly: x, the force over the stiffness
 * at rest, after a way, and its integral over the way.  x moves by 1 - softens |x| on
 * loading and by 1 + stiffens |x| on unloading, a unit of way. */
static double hb_bouc_wen(double x, double way, double softens, double stiffens,
                          double *integral)
{
    const double sign = way < 0 ? -1 : 1, length = fabs(way), part = stiffens * sign * x;
    double until = 0;
    x *= sign;
    *integral = 0;
    if (x < 0) { /* unloading, until x is zero */
        until = stiffens == 0 ? -x : part < 1 ? log1p(-part) / stiffens : length;
        until = fmin(until, length);
        *integral += hb_integral_of(&x, -stiffens, until);
    }
    *integral += hb_integral_of(&x, -softens, length - until); /* loading */
    return sign * x;
}

/* Bouc-Wen's operator by the numbers of a force. */
static double hb_hysteretic(const double *f, double x, double way, double *integral)
{
    return (f[4] == 2 ? hb_bouc_wen_square : hb_bouc_wen)(x, way, f[2], f[3], integral);
}

/* Stribeck's curve: an excess over the force of sliding that fades with the velocity.
 * Most have none, or are asked at rest: an exponential takes as long as all else. */
static double hb_level(double sliding, double excess, double fades, double v)
{
    if (!(fades > 0) || excess == 0) return sliding;
    return sliding + (v == 0 ? excess : excess * exp(-(v / fades) * (v / fades)));
}

/* The hypotenuse of one and y. */
static double hb_longer(double y) { return sqrt(1 + y * y); }

/* The largest force of friction at a velocity, the largest at all being f[1] + f[2]. */
static double hb_sliding(const double *f, double v)
{
    return hb_level(f[1], f[2], f[3], v);
}

/* How far friction gives way; its stiffness is that of the largest force at rest. */
static double hb_friction_reach(const double *f, double v)
{
    const double most = hb_sliding(f, 0);
    return most > 0 ? f[4] * (hb_sliding(f, v) / most) : 0;
}

/* LuGre's bristles: their bend after an even way, and its integral over the way.  In
 * the direction of the way it moves by 1 - bend / reach, a unit of way: so it nears the
 * reach from either side. */
static double hb_bend(double bend, double way, double reach, double *integral)
{
    const double sign = way < 0 ? -1 : 1, length = fabs(way), from = sign * bend;
    if (!(reach > 1e-12 * length)) { /* it bends at once */
        *integral = length * reach;
        return sign * reach;
    }
    double twice;
    const double once = hb_phi(-length / reach, &twice), slope = 1 - from / reach;
    *integral = length * (from + slope * length * twice);
    return sign * (from + slope * length * once);
}

/* The mean force of an attached mass over an even way in a time h, by the midpoint rule:
 * it gives back no more than it was given. memory: how far it lags behind, and how fast
 * it is. */
static double hb_attached(const double *f, double way, double h, const double *memory)
{
    const double turns = h * (f[2] + f[3] * h / 2) / (2 * f[1]);
    const double lag = memory[0] + way / 2 - h / 2 * memory[1];
    return (f[3] * lag + f[2] * (way / h - memory[1])) / (1 + turns);
}

/* What a force remembers after a way in a time h, of its memory before it; v is that at
 * its end. */
static double hb_remembered(const double *f, double way, double v, double h,
                            double memory)
{
    double integral;
    switch ((int)f[0]) {
    case HB_FRICTION:
        return hb_clip(hb_friction_reach(f, v), memory + way);
    case HB_LUGRE:
        return hb_bend(memory, way, hb_friction_reach(f, h > 0 ? way / h : v), &integral);
    case HB_HYSTERETIC:
        return hb_hysteretic(f, memory, way, &integral);
    case HB_SLIDER:
        return hb_clip(f[2], memory + way);
    case HB_RELAXATION:
        return memory * exp(-h / f[2]) + way * hb_phi(-h / f[2], &integral);
    }
    return memory;
}

/* A force: its law's number, then the numbers of the law. */
static double hb_force(const double *f, double q, double v, const double *memories)
{
    const double memory = memories[0];
    switch ((int)f[0]) {
    case HB_STIFFNESS:
        return q * (f[3] + q * (f[1] + f[2] * q));
    case HB_SINH:
        return f[1] * (f[2] * sinh(q / f[2]) - q);
    case HB_STOP: {
        const double way = q - f[3];
        if (f[4] * way < 0) return 0;
        return f[1] * hb_lossy(f[5], hb_pressed(f[6], hb_dead_zone(f[2], way)), v);
    }
    case HB_FRICTION:
    case HB_LUGRE:
        return hb_sliding(f, 0) * memory / f[4];
    case HB_SMOOTH:
        return hb_level(f[1], f[3], f[4], v) * tanh(v / f[2]);
    case HB_DRAG:
        return f[1] * v * fabs(v);
    case HB_FASTER:
        return f[2] * hb_dead_zone(f[1], v);
    case HB_HYSTERETIC:
        return f[1] * memory;
    case HB_GRAVITY:
        return f[1] * (sin(f[4] * q + f[2]) - f[3] * sin(f[2]) - f[5] * f[4] * q);
    case HB_SATURATING:
        return f[1] * q / hb_longer(q / f[2]);
    case HB_SLIDER:
        return f[1] * hb_dead_zone(f[3], memory);
    case HB_RELAXATION:
        return f[1] * memory;
    case HB_ATTACHED:
        return f[3] * memory + f[2] * (v - memories[1]);
    }
    return NAN;
}

/* A force's mean over a way from q in a time h, which is its work over the way. */
static double hb_mean_force(const double *f, double q, double way, double h,
                            const double *memories)
{
    const double v = way / h, memory = memories[0];
    const double to = q + way, middle = q + way / 2, half = way / 2;
    switch ((int)f[0]) {
    case HB_STIFFNESS:
        return f[1] * (q * q + q * to + to * to) / 3 +
               middle * (f[3] + f[2] * (q * q + to * to) / 2);
    case HB_SINH: {
        const double y = half / f[2];
        const double spread = y == 0 ? 1 : sinh(y) / y;
        return f[1] * (f[2] * sinh(middle / f[2]) * spread - middle);
    }
    case HB_STOP: {
        double from = q - f[3], end = to - f[3];
        if (f[4] != 0) { /* a side without contact counts as the middle */
            from = f[4] * fmax(0, f[4] * from);
            end = f[4] * fmax(0, f[4] * end);
        }
        const double mean = hb_mean_pressed(from, end, f[2], f[6]);
        return f[1] * hb_lossy(f[5], way == 0 ? mean : mean * ((end - from) / way), v);
    }
    case HB_FRICTION:
        return hb_sliding(f, 0) / f[4] *
               hb_mean_held(memory, way, hb_friction_reach(f, v), 0);
    case HB_LUGRE: {
        double integral;
        const double stiffness = hb_sliding(f, 0) / f[4];
        if (way == 0) return stiffness * memory;
        hb_bend(memory, way, hb_friction_reach(f, v), &integral);
        return stiffness * integral / way;
    }
    case HB_SMOOTH:
        return hb_level(f[1], f[3], f[4], v) * tanh(v / f[2]);
    case HB_DRAG:
        return f[1] * v * fabs(v);
    case HB_FASTER:
        return f[2] * hb_dead_zone(f[1], v);
    case HB_HYSTERETIC: {
        double integral;
        if (way == 0) return f[1] * memory;
        hb_hysteretic(f, memory, way, &integral);
        return f[1] * integral / way;
    }
    case HB_GRAVITY: {
        const double by = f[4] * half;
        return f[1] * (sin(f[4] * middle + f[2]) * (by == 0 ? 1 : sin(by) / by) -
                       f[3] * sin(f[2]) - f[5] * f[4] * middle);
    }
    case HB_SATURATING:
        return f[1] * 2 * middle / (hb_longer(q / f[2]) + hb_longer(to / f[2]));
    case HB_SLIDER:
        return f[1] * hb_mean_held(memory, way, f[2], f[3]);
    case HB_RELAXATION: {
        double twice;
        const double once = hb_phi(-h / f[2], &twice);
        return f[1] * (memory * once + way * twice);
    }
    case HB_ATTACHED:
        return hb_attached(f, way, h, memories);
    }
    return NAN;
}

/* Moves all memories by a way in a time h; v is the velocity at its end. */
static void hb_move_memories(int count, const double *forces, double v, double way,
                             double h, double *memory)
{
    for (int i = 0; i < count; i++) {
        const double *f = forces + HB_ROW * i;
        if ((int)f[0] == HB_ATTACHED && h > 0) {
            const double gained = h / f[1] * hb_attached(f, way, h, memory + i);
            memory[i] += way - h * (memory[i + 1] + gained / 2);
            memory[i + 1] += gained;
        }
        memory[i] = hb_remembered(f, way, v, h, memory[i]);
    }
}

static double hb_sum_of_forces(int count, const double *forces, double q, double v,
                               const double *memory)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += hb_force(forces + HB_ROW * i, q, v, memory + i);
    return sum;
}

/* How a slider without a gap goes along a way: held by its spring all along, 1, sliding
 * all along, -1, or neither, 0. Most go so at most times, and their law is then short. */
static inline int hb_goes(const double *f, double memory, double way)
{
    if ((int)f[0] != HB_SLIDER || f[3] != 0) return 0;
    if (fabs(memory) <= f[2] && fabs(memory + way) <= f[2]) return 1;
    return fabs(memory) == f[2] && memory * way > 0 ? -1 : 0;
}

/* The mean force of a slider that goes so. */
static inline double hb_mean_slider(const double *f, double memory, double way, int goes)
{
    return f[1] * (goes > 0 ? (memory + (memory + way)) / 2 : memory);
}

/* A force's mean over a way, as hb_mean_force: the short law where a slider has it. */
static inline double hb_mean(const double *f, double q, double way, double h,
                             const double *memories)
{
    const int goes = hb_goes(f, memories[0], way);
    return goes ? hb_mean_slider(f, memories[0], way, goes)
                : hb_mean_force(f, q, way, h, memories);
}

/* By how much a way from q is too long for the mean force over it: without forces it is
 * `alone`, and less by `gives` for each unit of force. A way that takes no time, h = 0,
 * is one to a place of rest: the force at its end counts. */
static double hb_miss(int count, const double *forces, const double *memory, double q,
                      double alone, double gives, double h, double way)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const double *f = forces + HB_ROW * i;
        sum += h > 0 ? hb_mean(f, q, way, h, memory + i)
                     : hb_force(f, q + way, 0, memory + i);
    }
    return way - alone + gives * sum;
}

/* The way of a part, by the secant method: a force changes little over most ways, so that
 * three or four of its values are enough. A step of a billionth is the last: the next
 * one would be lost in rounding. So would any step that q does not feel. NaN where it
 * does not get there. */
static double hb_way_near(int count, const double *forces, const double *memory,
                          double q, double alone, double gives, double h)
{
    double x = alone, at_x = hb_miss(count, forces, memory, q, alone, gives, h, x);
    double step = -at_x;
    for (int i = 0; i < 6; i++) {
        if (fabs(step) <= 1e-9 * fabs(x) + 1.1e-16 * fabs(q)) return x + step;
        if (!(fabs(x + step - alone) < fabs(alone))) return NAN;
        const double before = at_x;
        x += step;
        at_x = hb_miss(count, forces, memory, q, alone, gives, h, x);
        step *= at_x / (before - at_x);
    }
    return NAN;
}

/* Whether a force may fall so fast with the velocity that sticking and sliding both
 * fulfil a step: by at least half of what makes two roots of one. Stribeck's curve falls
 * by no more than sqrt(2 / e) of its excess, a unit of the velocity at which it fades.
 * The way that begins at rest is then the first. */
static int hb_falls(int count, const double *forces, double gives, double h)
{
    double falls = 0;
    for (int i = 0; i < count; i++) {
        const double *f = forces + HB_ROW * i;
        const int law = (int)f[0];
        if ((law == HB_FRICTION || law == HB_LUGRE) && f[3] > 0) falls += f[2] / f[3];
        if (law == HB_SMOOTH && f[4] > 0) falls += f[3] / f[4];
    }
    return 0.86 * falls * gives > 0.5 * h;
}

/* Whether a force alone slides at one force, without a gap: then its way is known. */
static int hb_rubs(const double *f)
{
    const int law = (int)f[0];
    return (law == HB_FRICTION && (f[2] == 0 || !(f[3] > 0))) ||
           (law == HB_SLIDER && f[3] == 0);
}

/* The way of a part against such a force: it is held by a spring, and slides where that
 * would be bent beyond the reach, which is where a square is solved. */
static double hb_way_rubbed(const double *f, double memory, double alone, double gives)
{
    const int slider = (int)f[0] == HB_SLIDER;
    const double reach = slider ? f[2] : hb_friction_reach(f, 0);
    const double stiffness = gives * (slider ? f[1] : hb_sliding(f, 0) / f[4]);
    const double from = hb_clip(reach, memory), pulls = alone - stiffness * from;
    const double held = pulls / (1 + stiffness / 2), side = pulls < 0 ? -1 : 1;
    if (from == memory && fabs(memory + held) <= reach) return held;
    const double bends = reach - side * from, lost = stiffness * bends * bends;
    const double slides = side * alone - stiffness * reach;
    const double root = sqrt(slides * slides + 2 * lost);
    return side * (slides > 0 ? (slides + root) / 2 : lost / (root - slides + 1e-300));
}

/* The way of a part, by Chandrupatla's method where a force falls, or where the one above
 * does not find it; NaN where there is none. The miss grows with the way nearly as fast
 * where no force falls: between zero and the way without forces, or the one with the
 * force of the beginning, there is then one root, and no way is farther from it than
 * about its miss: at a billionth of it the next step is the last. */
static double hb_way_of(int count, const double *forces, const double *memory, double q,
                        double alone, double gives, double h)
{
#define HB_MISS(way) hb_miss(count, forces, memory, q, alone, gives, h, way)
    if (count == 1 && h > 0 && hb_rubs(forces))
        return hb_way_rubbed(forces, memory[0], alone, gives);
    const int falls = hb_falls(count, forces, gives, h);
    if (!falls) {
        const double near_by = hb_way_near(count, forces, memory, q, alone, gives, h);
        if (near_by == near_by) return near_by;
    }
    double a = 0, at_a = HB_MISS(0), b = alone, at_b = HB_MISS(b);
    if (at_a == 0) return 0;
    if (at_b == 0) return b;
    if ((at_a > 0) == (at_b > 0)) b = -at_a, at_b = HB_MISS(b);
    for (int i = 0; i < 100 && (at_a > 0) == (at_b > 0); i++) {
        a = b, at_a = at_b;
        b *= 2, at_b = HB_MISS(b);
    }
    if (!((at_a > 0) != (at_b > 0))) return NAN;
    double t = at_a / (at_a - at_b);
    for (int i = 0; i < 100; i++) {
        double c = b, at_c = at_b;
        const double x = a + (t > 0 && t < 1 ? t : 0.5) * (b - a);
        const double at_x = HB_MISS(x), slope = (at_x - at_a) / (x - a);
        if ((at_x > 0) == (at_a > 0))
            c = a, at_c = at_a;
        else
            b = a, at_b = at_a;
        a = x, at_a = at_x;
        if (!falls && slope >= 0.5 && fabs(at_a) <= 1e-9 * fabs(a) + 1.1e-16 * fabs(q))
            return a - at_a / slope;
        const double best = fabs(at_a) < fabs(at_b) ? a : b, apart = fabs(b - a);
        const double near = 4e-16 * fabs(best) + 1e-16 * fabs(alone) + 1.1e-16 * fabs(q);
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
#undef HB_MISS
}

/* Whether a force turns with the direction of the motion. */
static int hb_turns(int count, const double *forces)
{
    for (int i = 0; i < count; i++) {
        const int law = (int)forces[HB_ROW * i];
        if (law == HB_FRICTION || law == HB_HYSTERETIC || law == HB_SLIDER ||
            law == HB_LUGRE)
            return 1;
    }
    return 0;
}

/* The way of a part from q and v, if no force were there. What drives it goes from one
 * value to another; step: q and v after the part of q, v and both values. */
static double hb_alone(const double *step, double from, double to, double q, double v)
{
    return step[0] * q + step[1] * v + step[2] * from + step[3] * to - q;
}

/* v after the part, where its way is known: what it lacks of that alone tells the force. */
static inline double hb_after(const double *step, double from, double to, double q,
                              double v, double way)
{
    const double held = (hb_alone(step, from, to, q, v) - way) / (step[2] + step[3]);
    return step[4] * q + step[5] * v + step[6] * (from - held) + step[7] * (to - held);
}

/* The way of a part h of an interval from q and v, and v after it. */
static inline double hb_over(int count, const double *forces, const double *memory,
                             const double *step, double h, double from, double to,
                             double q, double v, double *after)
{
    const double gives = step[2] + step[3];
    const double alone = hb_alone(step, from, to, q, v);
    const double way =
        count ? hb_way_of(count, forces, memory, q, alone, gives, h) : alone;
    *after = hb_after(step, from, to, q, v, way);
    return way;
}

/* Moves q, v and all memories over a part of an interval. step goes on with the numbers
 * for an eighth of it: where the motion turns back within a part, a force's mean over
 * the way is not its mean over the time, so that the part is taken in eighths.
 * Returns how many pieces it was taken in, and the way of each. */
static inline int hb_moved(int count, const double *forces, double *memory,
                           const double *step, double h, double from, double to,
                           double *q, double *v, double ways[8])
{
    double after;
    ways[0] = hb_over(count, forces, memory, step, h, from, to, *q, *v, &after);
    const int fine = after * *v < 0 && hb_turns(count, forces) ? 8 : 1;
    for (int i = 0; i < fine; i++) {
        const double now = from + i * (to - from) / fine;
        const double then = from + (i + 1) * (to - from) / fine;
        if (fine > 1)
            ways[i] = hb_over(count, forces, memory, step + 8, h / fine, now, then, *q,
                              *v, &after);
        *q += ways[i];
        *v = after;
        hb_move_memories(count, forces, *v, ways[i], h / fine, memory);
    }
    return fine;
}

/* Where springs hold a force p, next to where the linear one alone does; NaN where they
 * nowhere do. memory is all zero: friction holds nothing there yet. */
static inline double hb_balance(double stiffness, double p, int count,
                                const double *forces, const double *memory)
{
    const double q = p / stiffness;
    return q + hb_way_of(count, forces, memory, q, 0, 1 / stiffness, 0);
}

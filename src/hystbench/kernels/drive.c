/* A drive of limited slew rate; a field that lags by a power of its own rate. */
#include "lanes.h"

/* The output moves towards the input, which is straight between samples, by no more
 * than rising or falling in one interval.  It starts at the input.  Exact: where the
 * output catches up within an interval it follows from there, or goes on at the limit. */
EXPORT void hb_slew_limit(index_t n, double rising, double falling, const double *z,
                          double *out)
{
    double now = n > 0 ? z[0] : 0;
    for (index_t k = 0; k < n; k++) {
        if (k > 0) {
            const double slope = z[k] - z[k - 1], lag = z[k - 1] - now;
            /* towards the input; where both are level, the way it goes */
            const double way = (lag != 0 ? lag : slope) > 0 ? rising : -falling;
            const double reach = now + way;
            /* share of the interval that is left after catching up: the distance
             * lag + (slope - way) t vanishes at t = lag / (way - slope) */
            const double at = lag != 0 ? lag / (way - slope) : 0;
            if (!(at >= 0 && at < 1))
                now = reach;
            else if (-falling <= slope && slope <= rising)
                now = z[k];
            else
                now = z[k] - (1 - at) * (slope - (slope > 0 ? rising : -falling));
        }
        out[k] = now;
    }
}

/* From such an x on its tanh is one, as is a sharp limit's from one on. */
#define LIMITED(sharp) ((sharp) ? 1 : 20)

/* What is left of x = (z - v) / (R tau) after a time h over tau, while the input rests:
 * dx/dh = -tanh x, so that sinh x fades by exp(-h), or dx/dh = -x up to one and at the
 * full rate beyond.  fade is exp(-h). */
static double relaxed(double x, double h, double fade, int sharp)
{
    const double size = fabs(x);
    if (size >= LIMITED(sharp) + h) return x - copysign(h, x);
    if (sharp) return size > 1 ? copysign(exp(size - 1 - h), x) : x * fade;
    /* asinh(fade sinh x), to a rounding of one: in less time than by these functions */
    const double grown = exp(size), s = 0.5 * fade * (grown - 1 / grown);
    return copysign(log(s + sqrt(1 + s * s)), x);
}

/* What is left of it after all parts of an interval, in each of which the input moves by
 * half of its way, x relaxes, and the input moves on.  Where it falls R is down times. */
static double relaxed_in_parts(double x, double move, double h, double fade, int parts,
                               double down, int sharp)
{
    for (int part = 0; part < parts; part++) {
        const double at = x + 0.5 * move, unit = at < 0 ? down : 1;
        x = unit * relaxed(at / unit, h, fade, sharp) + 0.5 * move;
    }
    return x;
}

/* The same of a rounded limit, alike both ways, where no x is so large that its sinh is.  With s
 * for sinh x a part is
 * s <- fade sinh(x + move) = fade (s cosh(move) + sqrt(1 + s^2) sinh(move)):
 * no function but a root.  From the middle of a part to the middle of the next. */
#define LARGE 300
static double relaxed_often(double x, double move, double fade, int parts)
{
    const double moved = sinh(move), across = fade * moved;
    const double towards = fade * sqrt(1 + moved * moved);
    double s = fade * sinh(x + 0.5 * move);
    for (int part = 1; part < parts; part++) s = s * towards + sqrt(1 + s * s) * across;
    return asinh(s) + 0.5 * move;
}

/* dv/dt = R tanh((z - v) / (R tau)), or sharp R max(-1, min(1, (z - v) / (R tau))), with
 * rate = R dt and share = dt / tau; where v falls, R is down times that.  Strang's
 * splitting: the input moves by half of its way, x relaxes, and the input moves on.  Of
 * second order in the part of an interval that a step is, at most an eighth of tau.
 *
 * All parts of an interval are alike.  So x goes one way, and where its first and its
 * last are in a range all are: at the limit, or where a sharp one only fades, the sum of
 * so many parts is known. */
#define MANY 3 /* parts for which that pays */
EXPORT void hb_slew_with_lag(index_t n, index_t sharp, double rate, double down,
                             double share, const double *z, double *out)
{
    const int parts = (int)ceil(8 * share), even = down == 1;
    const double h = share / parts, fade = exp(-h), all_fade = exp(-share);
    const double rest_of_move = 0.5 * (1 + fade) / (1 - fade);
    double x = 0;
    if (n > 0) out[0] = z[0];
    for (index_t k = 1; k < n; k++) {
        const double move = (z[k] - z[k - 1]) / rate * h, at = x + 0.5 * move;
        const double way = move - copysign(at < 0 ? down * h : h, at);
        const double limited = (LIMITED(sharp) + h) * (at < 0 ? -down : 1);
        const double rest = move * rest_of_move, faded = rest + (x - rest) * all_fade;
        if (parts < MANY)
            x = relaxed_in_parts(x, move, h, fade, parts, down, (int)sharp);
        else if (at / limited >= 1 && (at + (parts - 1) * way) / limited >= 1)
            x += parts * way;
        else if (sharp && even && fabs(at) <= 1 && fabs(faded - 0.5 * move) <= fade)
            x = faded;
        else if (!sharp && even && fabs(x) + parts * fabs(move) < LARGE && fabs(move) < 1)
            x = relaxed_often(x, move, fade, parts);
        else
            x = relaxed_in_parts(x, move, h, fade, parts, down, (int)sharp);
        out[k] = z[k] - x * rate / share;
    }
}

/* s > 0 with s + scale (s / unit)^power = all, power at least 1: the steps of Halley
 * from a guess.  The error after a step is of the order of the cube of the step, so that
 * one of a thousandth is the last. */
static double split(double all, double scale, double unit, double power, double s)
{
    for (int step = 0; step < 60 && s > 0; step++) {
        const double rest = scale * pow(s / unit, power);
        const double over = s + rest - all, slope = 1 + power * rest / s;
        const double bend = power * (power - 1) * rest / (s * s);
        const double change = over / (slope - 0.5 * over * bend / slope);
        s -= change;
        if (fabs(change) <= 1e-3 * s) break;
    }
    return s;
}

/* The same of power 2. */
static double split_square(double all, double scale, double unit)
{
    return 2 * all / (1 + sqrt(1 + 4 * scale / (unit * unit) * all));
}

/* The field g that acts, where v - g = c |dg/dt|^a sign(dg/dt): implicit Euler, which
 * takes the rate as even within a step.  It starts at v.  Of the two parts of a step,
 * what g lags by after it and what g moves by in it, that one is solved for of which the
 * other is a power of at least one. */
EXPORT void hb_acting_field(index_t n, double c, double a, double dt, const double *v,
                            double *out)
{
    double now = n > 0 ? v[0] : 0, guess = 0, last = 0, before = 0;
    const int lags = a <= 1;
    const double scale = lags ? dt : c, unit = lags ? c : dt, power = lags ? 1 / a : a;
    for (index_t k = 0; k < n; k++) {
        const double apart = v[k] - now, all = fabs(apart);
        if (all > 0) {
            const double on = 3 * (guess - last) + before; /* it goes on as it went */
            before = last;
            last = guess;
            if (power == 2)
                guess = split_square(all, scale, unit);
            else if (on > 0 && on < all)
                guess = split(all, scale, unit, power, on);
            else /* neither part is larger than the whole, nor than that alone asks for */
                guess = split(all, scale, unit, power,
                              fmin(all, unit * pow(all / scale, 1 / power)));
            guess = fmin(guess, all);
            now = lags ? v[k] - copysign(guess, apart) : now + copysign(guess, apart);
        } else
            now = v[k]; /* level, or not a number */
        out[k] = now;
    }
}

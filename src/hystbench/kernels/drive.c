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

/* What is left of x = (z - v) / (R tau) after a time h over tau, while the input rests:
 * dx/dh = -tanh x, so that sinh x fades by exp(-h), or dx/dh = -x up to one and at the
 * full rate beyond.  fade is exp(-h). */
static double relaxed(double x, double h, double fade, int sharp)
{
    const double size = fabs(x);
    if (size >= (sharp ? 1 : 20) + h) return x - copysign(h, x);
    if (sharp) return size > 1 ? copysign(exp(size - 1 - h), x) : x * fade;
    /* asinh(fade sinh x), to a rounding of one: in less time than by these functions */
    const double grown = exp(size), s = 0.5 * fade * (grown - 1 / grown);
    return copysign(log(s + sqrt(1 + s * s)), x);
}

/* dv/dt = R tanh((z - v) / (R tau)), or sharp R max(-1, min(1, (z - v) / (R tau))), with
 * rate = R dt and share = dt / tau; where v falls, R is down times that.  Strang's
 * splitting: the input moves by half of its way, x relaxes, and the input moves on.  Of
 * second order in the part of an interval that a step is, at most an eighth of tau. */
EXPORT void hb_slew_with_lag(index_t n, index_t sharp, double rate, double down,
                             double share, const double *z, double *out)
{
    const int parts = (int)ceil(8 * share);
    const double h = share / parts, fade = exp(-h);
    double x = 0;
    for (index_t k = 0; k < n; k++) {
        const double move = k > 0 ? (z[k] - z[k - 1]) / rate * h : 0;
        for (int part = 0; k > 0 && part < parts; part++) {
            const double at = x + 0.5 * move, unit = at < 0 ? down : 1;
            x = unit * relaxed(at / unit, h, fade, (int)sharp) + 0.5 * move;
        }
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

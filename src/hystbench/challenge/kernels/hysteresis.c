/* Hysteresis: generalized plays, Everett's function, the equations of Jiles and
   Atherton and of Duhem. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#define EXPORT __attribute__((visibility("default")))

/* y = sum_i w_i W_i, W_i kept within [right - g r_i, left + g r_i]; g grows the
   thresholds sample by sample. state: W_i, from before the first sample. */
EXPORT void hc_generalized_plays(ptrdiff_t n, ptrdiff_t m, const double *left,
                                 const double *right, const double *growth,
                                 const double *r, const double *w, double *state,
                                 double *y)
{
    for (ptrdiff_t k = 0; k < n; k++) {
        double sum = 0.0;
        for (ptrdiff_t i = 0; i < m; i++) {
            double reach = growth[k] * r[i], top = left[k] + reach;
            double bottom = right[k] - reach, value = state[i];
            value = value < top ? value : top;
            value = value > bottom ? value : bottom;
            state[i] = value;
            sum += w[i] * value;
        }
        y[k] = sum;
    }
}

/* Everett's function on an even grid from -limit to limit, read bilinearly */
static inline double everett(const double *table, ptrdiff_t points, double limit,
                             double high, double low)
{
    double scale = (double)(points - 1) / (2.0 * limit);
    double a = (high + limit) * scale, b = (low + limit) * scale, top = points - 1;
    a = a < 0.0 ? 0.0 : a > top ? top : a;
    b = b < 0.0 ? 0.0 : b > top ? top : b;
    ptrdiff_t i = a >= top ? points - 2 : (ptrdiff_t)a;
    ptrdiff_t j = b >= top ? points - 2 : (ptrdiff_t)b;
    double p = a - (double)i, q = b - (double)j;
    const double *row = table + i * points + j;
    return (1.0 - p) * ((1.0 - q) * row[0] + q * row[1])
           + p * ((1.0 - q) * row[points] + q * row[points + 1]);
}

/* Preisach's operator by its memory of turning points. The history (past turning
   points, alternating) comes first and gives the state at the start. Returns the
   most turning points held, or -1 without memory. */
EXPORT ptrdiff_t hc_everett(ptrdiff_t n, ptrdiff_t past, ptrdiff_t points, double limit,
                            const double *table, const double *history,
                            const double *u, double *y)
{
    size_t room = (size_t)(n + past) + 2;
    double *turn = malloc(2 * room * sizeof *turn), *sum = turn + room;
    if (!turn)
        return -1;
    /* turn[0] is negative saturation, where the output is zero; sum[i] is the output
       at turn[i]; odd entries are maxima, even ones minima */
    ptrdiff_t held = 0, most = 0;
    turn[0] = -limit;
    sum[0] = 0.0;
    double now = -limit, value = 0.0;
    int rising = 1;
    for (ptrdiff_t k = -past; k < n; k++) {
        double x = k < 0 ? history[k + past] : u[k];
        x = x > limit ? limit : x < -limit ? -limit : x;
        if (rising ? x < now : x > now) { /* a turning point, to be remembered */
            held++;
            turn[held] = now;
            sum[held] = value;
            rising = !rising;
            if (held > most)
                most = held;
        }
        /* a pair of turning points that the input passes is wiped out */
        while (held >= 2 && (rising ? x >= turn[held - 1] : x <= turn[held - 1]))
            held -= 2;
        /* back on the first rising branch, there is no turning point to compare */
        if (held == 1 && rising == 0 && x <= turn[0]) {
            held = 0;
            rising = 1;
        }
        double edge = everett(table, points, limit, rising ? x : turn[held],
                              rising ? turn[held] : x);
        value = rising ? sum[held] + edge : sum[held] - edge;
        now = x;
        if (k >= 0)
            y[k] = value;
    }
    free(turn);
    return most;
}

/* Langevin's function coth x - 1/x and its slope, from one exponential */
static inline double langevin(double x, double *slope)
{
    if (fabs(x) < 1e-2) {
        *slope = 1.0 / 3.0 - x * x / 15.0;
        return x * (1.0 / 3.0 - x * x / 45.0);
    }
    double e = exp(-2.0 * fabs(x)), inverse = 1.0 / x;
    double coth = copysign((1.0 + e) / (1.0 - e), x);
    *slope = 1.0 - coth * coth + inverse * inverse;
    return coth - inverse;
}

typedef struct {
    double shape, coupling, pinning, reversible;
} material;

/* dm/dh; m is the magnetization over its saturation, fields in one unit. With the
   wall term zero where it would be negative (Deane; Bergqvist). */
static double susceptibility(const material *p, double h, double m, double direction)
{
    double x = (h + p->coupling * m) / p->shape;
    double slope, off = langevin(x, &slope) - m;
    slope /= p->shape;
    double wall = 0.0;
    if (off * direction > 0.0)
        wall = off / (p->pinning * direction - p->coupling * off);
    double forward = (1.0 - p->reversible) * wall + p->reversible * slope;
    return forward / (1.0 - p->reversible * p->coupling * slope);
}

/* Runge-Kutta over the field, each sample's step cut into pieces of at most `piece`.
   state: field and magnetization before the first sample. */
EXPORT void hc_jiles_atherton(ptrdiff_t n, double shape, double coupling,
                              double pinning, double reversible, double piece,
                              const double *field, double *state, double *m)
{
    material p = {shape, coupling, pinning, reversible};
    double h = state[0], value = state[1];
    for (ptrdiff_t k = 0; k < n; k++) {
        double way = field[k] - h, direction = way < 0.0 ? -1.0 : 1.0;
        ptrdiff_t pieces = (ptrdiff_t)ceil(fabs(way) / piece);
        double step = pieces ? way / (double)pieces : 0.0;
        for (ptrdiff_t i = 0; i < pieces; i++) {
            double a = susceptibility(&p, h, value, direction);
            double b = susceptibility(&p, h + 0.5 * step, value + 0.5 * step * a,
                                      direction);
            double c = susceptibility(&p, h + 0.5 * step, value + 0.5 * step * b,
                                      direction);
            double d = susceptibility(&p, h + step, value + step * c, direction);
            value += step / 6.0 * (a + 2.0 * (b + c) + d);
            h += step;
        }
        h = field[k];
        m[k] = value;
    }
    state[0] = h;
    state[1] = value;
}

/* Duhem's equation over the input, dy/dv = +-rate (f - y) + stiff f', f a tanh about a
   bias, both zero at rest. Each step is cut into pieces of at most a hundredth of the
   knee, in which f is taken as straight and the equation is solved exactly. */
EXPORT void hc_duhem(ptrdiff_t n, double rate, double stiff, double knee, double bias,
                     const double *v, double *y)
{
    double rest = tanh(bias / knee), now = 0.0, f = 0.0, value = 0.0;
    for (ptrdiff_t k = 0; k < n; k++) {
        double way = v[k] - now;
        ptrdiff_t pieces = (ptrdiff_t)ceil(fabs(way) / (0.01 * knee));
        double step = pieces ? way / (double)pieces : 0.0;
        double kept = exp(-rate * fabs(step));
        for (ptrdiff_t i = 1; i <= pieces; i++) {
            double next = tanh((now + (double)i * step + bias) / knee) - rest;
            /* y runs behind a straight f by so much once it has settled */
            double behind = (1.0 - stiff) * (next - f) / (rate * fabs(step));
            value = next - behind + (value - (f - behind)) * kept;
            f = next;
        }
        now = v[k];
        y[k] = value;
    }
}

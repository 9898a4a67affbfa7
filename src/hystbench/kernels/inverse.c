/* The input of play operators that gives an output: an inverse sample by sample. */
#include "lanes.h"

/* Weighted plays of one input, their squares and cubes, beside a linear path: the state
 * before is read, not moved. a: a0 to a7 of Eqs. 5 and 6, or null where the input is its
 * own envelope. terms: m weights, then m of the squares, then m of the cubes. */
INLINE double output(double v, double path, const double *a, index_t m, const double *r,
                     const double *terms, const double *state, double *moved)
{
    const double left = a ? a[0] * tanh(a[1] * v + a[2]) + a[3] : v;
    const double right = a ? a[4] * tanh(a[5] * v + a[6]) + a[7] : v;
    double y = path * v;
    for (index_t i = 0; i < m; i++) {
        const double low = right - r[i], high = left + r[i];
        const double lower = high < state[i] ? high : state[i];
        const double p = low > lower ? low : lower;
        y += p * (terms[i] + p * (terms[m + i] + p * terms[2 * m + i]));
        if (moved) moved[i] = p;
    }
    return y;
}

/* Inputs of n wanted outputs, within low and high; state (m) goes in and out. The output
 * must not fall where the input rises. Regula falsi, the end that stays halved (Illinois).
 * Returns the samples that lie out of reach: there the input stands at its limit. */
EXPORT index_t hb_invert_plays(index_t n, index_t m, index_t own, double path,
                               const double *envelope, const double *r,
                               const double *terms, double low, double high,
                               const double *wanted, double *state, double *v)
{
#define OFF(x) (output((x), path, own ? envelope : 0, m, r, terms, state, 0) - wanted[k])
    index_t lost = 0;
    double at = low > 0 ? low : high < 0 ? high : 0, reach = 0;
    for (index_t k = 0; k < n; k++) {
        double off = OFF(at), to = at, off_to = off;
        double step = reach > 0 ? reach : 1e-6 * (fabs(at) + 1e-6);
        while (off != 0 && (off_to > 0) == (off > 0)) { /* until it is between both */
            const double limit = off > 0 ? low : high;
            if (to == limit) break;
            at = to, off = off_to;
            to = off > 0 ? fmax(at - step, low) : fmin(at + step, high);
            off_to = OFF(to);
            step *= 2;
            if (off_to == 0) break;
        }
        const double began = at;
        if (off != 0 && (off_to > 0) == (off > 0) && off_to != 0) {
            at = to;
            lost++;
        } else {
            for (int round = 0; round < 200 && off != 0 && off_to != 0; round++) {
                double middle = to - off_to * (to - at) / (off_to - off);
                const double least = fmin(at, to), most = fmax(at, to);
                if (round % 3 == 2 || !(middle > least && middle < most))
                    middle = 0.5 * (at + to);
                if (!(middle > least && middle < most)) break; /* neighbours */
                if (most - least <= 1e-15 * (fabs(least) + fabs(most))) break;
                const double off_middle = OFF(middle);
                if ((off_middle > 0) == (off_to > 0))
                    off *= 0.5;
                else
                    at = to, off = off_to;
                to = middle, off_to = off_middle;
            }
            at = to;
        }
        reach = fabs(at - began);
        output(at, path, own ? envelope : 0, m, r, terms, state, state);
        v[k] = at;
    }
    return lost;
#undef OFF
}

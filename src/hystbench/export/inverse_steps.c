/* What undoes a block, a function for each step as in steps.c. */

/* Stand at a limit where the signal is beyond it. */
static double hb_limited(double low, double high, double z)
{
    return hb_most(low, hb_least(high, z));
}

/* What plays make of an input, their states being w: moved, where it is given, gets the
 * states then. */
static double hb_of_plays(double path, int own, const double *envelope, int count,
                          const double *thresholds, const double *terms,
                          const double *w, double *moved, double v, double growth)
{
    const double *a = envelope;
    const double left = own ? a[0] * tanh(a[1] * v + a[2]) + a[3] : v;
    const double right = own ? a[4] * tanh(a[5] * v + a[6]) + a[7] : v;
    double y = path * v;
    for (int i = 0; i < count; i++) {
        double p = w[i];
        hb_play(left, right, growth * thresholds[i], &p);
        y += p * (terms[i] + p * (terms[count + i] + p * terms[2 * count + i]));
        if (moved) moved[i] = p;
    }
    return y;
}

/* The input of plays, to a near output: regula falsi, the end that stays halved (Illinois). at: the input
 * before, and how far it had moved. */
static double hb_undo_plays(double near, double path, int own, const double *envelope, int count,
                            const double *thresholds, const double *terms, double low,
                            double high, double *w, double *at, double z,
                            double growth)
{
#define HB_OFF(v)                                                                     \
    hb_dead_zone(near, hb_of_plays(path, own, envelope, count, thresholds, terms, w, \
                                   0, v, growth) - z)
    double one = hb_most(low, hb_least(high, at[0])), other = one;
    const double began = one;
    double off_one = HB_OFF(one), off_other = off_one;
    double step = at[1] > 0 ? at[1] : 1e-6 * (fabs(one) + 1e-6);
    while (off_one != 0 && off_other != 0 && (off_other > 0) == (off_one > 0)) {
        if (other == (off_other > 0 ? low : high)) break;
        one = other;
        off_one = off_other;
        other = off_one > 0 ? hb_most(one - step, low) : hb_least(one + step, high);
        off_other = HB_OFF(other);
        step *= 2;
    }
    const int between = (off_other > 0) != (off_one > 0);
    for (int turn = 0; turn < 200 && between && off_one != 0 && off_other != 0; turn++) {
        const double least = hb_least(one, other), most = hb_most(one, other);
        double middle = other - off_other * (other - one) / (off_other - off_one);
        if (turn % 3 == 2 || !(middle > least && middle < most))
            middle = 0.5 * (one + other);
        if (!(middle > least && middle < most)) break;
        if (most - least <= 1e-15 * (fabs(least) + fabs(most))) break;
        const double off_middle = HB_OFF(middle);
        if ((off_middle > 0) == (off_other > 0)) {
            off_one *= 0.5;
        } else {
            one = other;
            off_one = off_other;
        }
        other = middle;
        off_other = off_middle;
    }
    at[0] = other;
    at[1] = fabs(other - began);
    hb_of_plays(path, own, envelope, count, thresholds, terms, w, w, other, growth);
    return other;
#undef HB_OFF
}

/* Thresholds grow with the rate of the last interval. before: how many samples were, up
 * to two, and the inputs then, the newest first. */
static double hb_undo_growing_plays(double coefficient, double exponent, double dt,
                                    double near, double path, int own, const double *envelope,
                                    int count, const double *thresholds,
                                    const double *terms, double low, double high,
                                    double *w, double *at, double *before, double z)
{
    const double rate = before[0] < 2 ? 0 : (before[1] - before[2]) / dt;
    const double growth = 1 + coefficient * pow(fabs(rate), exponent);
    const double v = hb_undo_plays(near, path, own, envelope, count, thresholds, terms,
                                   low, high, w, at, z, growth);
    before[0] = hb_least(before[0] + 1, 2);
    before[2] = before[1];
    before[1] = v;
    return v;
}

/* The field that is applied where another acts. */
static double hb_applied_field(double coefficient, double exponent, int points,
                               int ahead, const double *rate, double *history, double z)
{
    hb_remember(points, history, z);
    const double fast = history[0] > 1 ? hb_weighted(points, rate, history + 1) : 0;
    return history[1 + ahead] + copysign(coefficient * pow(fabs(fast), exponent), fast);
}

/* Straight lines through values that lie as far apart as each other. */
static double hb_looked_up(int last, double low, double each, const double *values,
                           double z)
{
    const double place = hb_most(0, hb_least(last, (z - low) / each));
    const int before = place < last ? (int)place : last - 1;
    return values[before] + (place - before) * (values[before + 1] - values[before]);
}

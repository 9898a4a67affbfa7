/* What undoes a block, a function for each step as in steps.c. */

/* The input of hysteresis whose output goes its way with it (1 or -1), to a near output:
 * regula falsi, the end that stays halved (Illinois). at: the input before, and how far
 * it had moved. pace: how many inputs were kept, up to two; both, the newest first; and
 * the growth of thresholds by the rate between them. */
static double hb_undo(double near, double low, double high, double way,
                      double coefficient, double exponent, double knee,
                      double dt, double *at,
                      double *pace, double (*output)(void *, double), void *model,
                      double z)
{
#define HB_OFF(v) (way * hb_dead_zone(near, output(model, v) - z))
    const double rate = pace[0] < 2 ? 0 : (pace[1] - pace[2]) / dt;
    pace[3] = 1 + hb_growth(coefficient, exponent, knee, rate);
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
    pace[0] = hb_least(pace[0] + 1, 2);
    pace[2] = pace[1];
    pace[1] = other;
    return other;
#undef HB_OFF
}

/* Stand at a limit where the signal is beyond it. */
static double hb_limited(double low, double high, double z)
{
    return hb_most(low, hb_least(high, z));
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

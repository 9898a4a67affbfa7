/* What holds back: amplifier slew, a joint with play, a joint that sticks and slips. */
#include <math.h>
#include <stddef.h>

#define EXPORT __attribute__((visibility("default")))

/* y follows x by at most step a sample */
EXPORT void hc_slew(ptrdiff_t n, double step, const double *x, double *y)
{
    double state = x[0];
    for (ptrdiff_t k = 0; k < n; k++) {
        state += fmin(fmax(x[k] - state, -step), step);
        y[k] = state;
    }
}

/* a pin in a slot of the half-width: carried by the flank it touches */
EXPORT void hc_joint(ptrdiff_t n, double half_width, const double *x, double *y)
{
    double state = 0.0;
    for (ptrdiff_t k = 0; k < n; k++) {
        if (x[k] - state > half_width)
            state = x[k] - half_width;
        else if (state - x[k] > half_width)
            state = x[k] + half_width;
        y[k] = state;
    }
}

/* sticks until it is off by hold, then slips at rate (share a sample) until off by
   release */
EXPORT void hc_stick_slip(ptrdiff_t n, double hold, double release, double rate,
                          const double *x, double *y)
{
    double state = 0.0;
    int slips = 0;
    for (ptrdiff_t k = 0; k < n; k++) {
        double off = x[k] - state;
        if (fabs(off) > hold)
            slips = 1;
        else if (fabs(off) <= release)
            slips = 0;
        if (slips)
            state += rate * off;
        y[k] = state;
    }
}

/* A drive of limited slew rate. */
#include "lanes.h"

/* The output moves towards the input, which is straight between samples, by no more
 * than rate in one interval.  It starts at the input.  Exact: where the output catches
 * up within an interval it follows from there, or goes on at the limit. */
EXPORT void hb_slew_limit(index_t n, double rate, const double *z, double *out)
{
    double now = n > 0 ? z[0] : 0;
    for (index_t k = 0; k < n; k++) {
        if (k > 0) {
            const double slope = z[k] - z[k - 1], lag = z[k - 1] - now;
            /* towards the input; where both are level, the way it goes */
            const double way = copysign(rate, lag != 0 ? lag : slope);
            const double reach = now + way;
            /* share of the interval that is left after catching up: the distance
             * lag + (slope - way) t vanishes at t = lag / (way - slope) */
            const double at = lag != 0 ? lag / (way - slope) : 0;
            if (!(at >= 0 && at < 1))
                now = reach;
            else if (fabs(slope) <= rate)
                now = z[k];
            else
                now = z[k] - (1 - at) * (slope - copysign(rate, slope));
        }
        out[k] = now;
    }
}

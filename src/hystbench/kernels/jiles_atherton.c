/* Jiles-Atherton hysteresis, integrated over the field. */
#include "lanes.h"

/* Langevin's function over its argument; near zero by its series, since there
 * coth x - 1/x is a difference of large numbers. */
INLINE double langevin_ratio(double x)
{
    const double q = x * x;
    if (q < 0.01)
        return 1. / 3 + q * (-1. / 45 + q * (2. / 945 + q * (-1. / 4725 + q * 2. / 93555)));
    const double size = fabs(x), e = exp(-2 * size);
    return ((1 + e) / (1 - e) - 1 / size) / size;
}

/* Slope dm/dh where the field moves in a direction, +1 or -1. */
INLINE double slope(double h, double m, double direction, double shape, double coupling,
                    double pinning, double reversibility)
{
    const double x = (h + coupling * m) / shape;
    const double ratio = langevin_ratio(x), anhysteretic = x * ratio;
    const double rise = (1 - anhysteretic * anhysteretic - 2 * ratio) / shape;
    const double gap = direction * (anhysteretic - m);
    const double effective = (gap > 0 ? gap / pinning : 0) + reversibility * rise;
    return effective / (1 - coupling * effective);
}

/* Magnetisation of n samples of the field h, which starts at h_before and moves
 * straight from sample to sample, by the classical Runge-Kutta method in steps of the
 * field no longer than step.  m goes in and out. */
EXPORT void hb_jiles_atherton(index_t n, double shape, double coupling, double pinning,
                              double reversibility, double step, double h_before,
                              const double *h, double *m, double *out)
{
#define SLOPE(h, m) slope(h, m, direction, shape, coupling, pinning, reversibility)
    double now = *m, field = h_before;
    for (index_t k = 0; k < n; k++) {
        const double way = h[k] - field, direction = way < 0 ? -1 : 1;
        if (!isfinite(way)) now = NAN; /* and so on, to the end */
        const double steps = isfinite(way) ? ceil(fabs(way) / step) : 0;
        const double each = way / (steps > 0 ? steps : 1);
        for (double s = 0; s < steps; s++) {
            const double at = field + s * each;
            const double first = SLOPE(at, now);
            const double second = SLOPE(at + each / 2, now + each / 2 * first);
            const double third = SLOPE(at + each / 2, now + each / 2 * second);
            const double fourth = SLOPE(at + each, now + each * third);
            now += each / 6 * (first + 2 * (second + third) + fourth);
        }
        field = h[k];
        out[k] = now;
    }
    *m = now;
#undef SLOPE
}

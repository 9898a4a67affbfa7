/* Envelope functions: a hyperbolic tangent of the input, Eqs. 5 and 6. */
#include "tangent.h"

EXPORT void hb_envelope(index_t n, double height, double slope, double place,
                        double offset, const double *restrict v, double *restrict out)
{
    envelope(n, height, slope, place, offset, v, out);
}

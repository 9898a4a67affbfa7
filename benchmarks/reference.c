/* Plain C loops that the kernels are measured beside.
 *
 * TAPS is a constant of the build, so that the compiler may unroll and keep weights in
 * registers.  Sums are left to the compiler: whether it may reorder them is a flag.
 * Lines hold TAPS - 1 (lms, volterra) or TAPS (plays) zeros before the first sample;
 * weights and operators run from the oldest tap to the newest.
 */
#include <float.h>
#include <math.h>
#include <stddef.h>

typedef ptrdiff_t index_t;

void reference_lms(index_t n, const double *restrict line, const double *restrict d,
                   double step, double *restrict w, double *restrict y)
{
    for (index_t k = 0; k < n; k++) {
        double sum = 0;
        for (int i = 0; i < TAPS; i++) sum += w[i] * line[k + i];
        const double change = step * (d[k] - sum);
        for (int i = 0; i < TAPS; i++) w[i] += change * line[k + i];
        y[k] = sum;
    }
}

/* The same with the output looked ahead by one step: w(k)'H(k) is
 * w(k-1)'H(k) + c H(k-1)'H(k), so that no sum waits for the error before it. */
void reference_lms_ahead(index_t n, const double *restrict line,
                         const double *restrict d, double step, double *restrict w,
                         double *restrict y)
{
    double last[TAPS] = {0}, change = 0;
    for (index_t k = 0; k < n; k++) {
        double before = 0, overlap = 0;
        for (int i = 0; i < TAPS; i++) {
            const double h = line[k + i];
            before += w[i] * h;
            overlap += last[i] * h;
            w[i] += change * last[i];
            last[i] = h;
        }
        y[k] = before + change * overlap;
        change = step * (d[k] - y[k]);
    }
    for (int i = 0; i < TAPS; i++) w[i] += change * last[i];
}

/* Direct the envelopes of the line, once a sample: where it does not rise nothing pushes
 * up, where it does not fall nothing down.  A finite bound, since -ffast-math knows no
 * infinity. */
static inline void direct(index_t n, const double *restrict line, double *restrict low,
                          double *restrict high)
{
    for (index_t k = 1; k < n + TAPS; k++) {
        const double move = line[k] - line[k - 1];
        low[k] = move > 0 ? low[k] : -DBL_MAX;
        high[k] = move < 0 ? high[k] : DBL_MAX;
    }
}

/* Plays along the line of directed envelopes. */
static inline void plays(index_t n, const double *restrict low,
                         const double *restrict high, const double *restrict d,
                         const double *restrict r, double step, double *restrict w,
                         double *restrict y)
{
    double state[TAPS] = {0};
    for (index_t k = 0; k < n; k++) {
        double sum = 0;
        for (int i = 0; i < TAPS; i++) {
            const double least = low[k + 1 + i] - r[i], most = high[k + 1 + i] + r[i];
            const double under = most < state[i] ? most : state[i];
            state[i] = least > under ? least : under;
            sum += w[i] * state[i];
        }
        const double change = step * (d[k] - sum);
        for (int i = 0; i < TAPS; i++) w[i] += change * state[i];
        y[k] = sum;
    }
}

/* The same with the output looked ahead by one step, as for LMS. */
static inline void plays_ahead(index_t n, const double *restrict low,
                               const double *restrict high, const double *restrict d,
                               const double *restrict r, double step,
                               double *restrict w, double *restrict y)
{
    double state[TAPS] = {0}, change = 0;
    for (index_t k = 0; k < n; k++) {
        double before = 0, overlap = 0;
        for (int i = 0; i < TAPS; i++) {
            const double least = low[k + 1 + i] - r[i], most = high[k + 1 + i] + r[i];
            const double last = state[i], under = most < last ? most : last;
            const double now = least > under ? least : under;
            before += w[i] * now;
            overlap += last * now;
            w[i] += change * last;
            state[i] = now;
        }
        y[k] = before + change * overlap;
        change = step * (d[k] - y[k]);
    }
    for (int i = 0; i < TAPS; i++) w[i] += change * state[i];
}

/* low and high: space for n + TAPS. */
void reference_backlash(index_t n, const double *restrict line, double *restrict low,
                        double *restrict high, const double *d, const double *r,
                        double step, double *w, double *y, index_t ahead)
{
    for (index_t k = 0; k < n + TAPS; k++) low[k] = high[k] = line[k];
    direct(n, line, low, high);
    (ahead ? plays_ahead : plays)(n, low, high, d, r, step, w, y);
}

/* a: the eight parameters of Eqs. 5 and 6; low and high: space for n + TAPS. */
void reference_gpo(index_t n, const double *restrict line, const double *restrict a,
                   double *restrict low, double *restrict high, const double *d,
                   const double *r, double step, double *w, double *y, index_t ahead)
{
    for (index_t k = 0; k < n + TAPS; k++) {
        high[k] = a[0] * tanh(a[1] * line[k] + a[2]) + a[3];
        low[k] = a[4] * tanh(a[5] * line[k] + a[6]) + a[7];
    }
    direct(n, line, low, high);
    (ahead ? plays_ahead : plays)(n, low, high, d, r, step, w, y);
}

/* All TAPS + TAPS^2 weights: predict, then correct. */
void reference_volterra(index_t n, const double *restrict line,
                        const double *restrict d, double step1, double step2,
                        double *restrict first, double *restrict second,
                        double *restrict y)
{
    for (index_t k = 0; k < n; k++) {
        const double *x = line + k;
        double sum = 0;
        for (int i = 0; i < TAPS; i++) {
            double row = first[i];
            for (int j = 0; j < TAPS; j++) row += second[i * TAPS + j] * x[j];
            sum += row * x[i];
        }
        const double error = d[k] - sum;
        for (int i = 0; i < TAPS; i++) {
            first[i] += step1 * error * x[i];
            const double change = step2 * error * x[i];
            for (int j = 0; j < TAPS; j++) second[i * TAPS + j] += change * x[j];
        }
        y[k] = sum;
    }
}

/* The same in one pass over the weights: each is corrected for the sample before, then
 * predicts. */
void reference_volterra_fused(index_t n, const double *restrict line,
                              const double *restrict d, double step1, double step2,
                              double *restrict first, double *restrict second,
                              double *restrict y)
{
    double last[TAPS] = {0}, error = 0;
    for (index_t k = 0; k <= n; k++) {
        double x[TAPS], sum = 0;
        for (int j = 0; j < TAPS; j++) x[j] = k < n ? line[k + j] : 0;
        for (int i = 0; i < TAPS; i++) {
            const double change = step2 * error * last[i];
            double row = first[i] += step1 * error * last[i];
            for (int j = 0; j < TAPS; j++) {
                const double w = second[i * TAPS + j] + change * last[j];
                second[i * TAPS + j] = w;
                row += w * x[j];
            }
            sum += row * x[i];
        }
        for (int j = 0; j < TAPS; j++) last[j] = x[j];
        if (k < n) {
            y[k] = sum;
            error = d[k] - sum;
        }
    }
}

/* Eqs. 4 and 9 from rest. */
void reference_prandtl_ishlinskii(index_t n, const double *restrict left,
                                  const double *restrict right,
                                  const double *restrict r,
                                  const double *restrict weights, double *restrict y)
{
    double state[TAPS] = {0};
    for (index_t k = 0; k < n; k++) {
        double sum = 0;
        for (int i = 0; i < TAPS; i++) {
            const double low = right[k] - r[i], high = left[k] + r[i];
            const double under = high < state[i] ? high : state[i];
            state[i] = low > under ? low : under;
            sum += weights[i] * state[i];
        }
        y[k] = sum;
    }
}

/* Plays of threshold i spacing[k] and weight ratio[k]^i, from rest. */
void reference_rate_dependent(index_t n, const double *restrict v,
                              const double *restrict spacing,
                              const double *restrict ratio, double *restrict y)
{
    double state[TAPS] = {0};
    for (index_t k = 0; k < n; k++) {
        double sum = 0, power = 1;
        for (int i = 0; i < TAPS; i++) {
            const double low = v[k] - i * spacing[k], high = v[k] + i * spacing[k];
            const double under = high < state[i] ? high : state[i];
            state[i] = low > under ? low : under;
            sum += power * state[i];
            power *= ratio[k];
        }
        y[k] = sum;
    }
}

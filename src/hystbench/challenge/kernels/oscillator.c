/* First- and second-order dynamics by the classical Runge-Kutta method. The middle of
   a step is read off the cubic through the four samples around it. */
#include <stddef.h>

#define EXPORT __attribute__((visibility("default")))

static inline double middle(const double *x, ptrdiff_t k, ptrdiff_t n)
{
    if (k == 0 || k + 2 >= n)
        return 0.5 * (x[k] + x[k + 1]);
    return (9.0 * (x[k] + x[k + 1]) - x[k - 1] - x[k + 2]) / 16.0;
}

/* tau y' = x - y, from y = 0 */
EXPORT void hc_lag(ptrdiff_t n, double dt, double tau, const double *x, double *y)
{
    double state = 0.0, h = dt / tau;
    y[0] = 0.0;
    for (ptrdiff_t k = 0; k + 1 < n; k++) {
        double half = middle(x, k, n);
        double k1 = x[k] - state;
        double k2 = half - (state + 0.5 * h * k1);
        double k3 = half - (state + 0.5 * h * k2);
        double k4 = x[k + 1] - (state + h * k3);
        state += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
        y[k + 1] = state;
    }
}

/* x'' = omega^2 (z - x - alpha x^3) - 2 zeta omega x', from rest */
EXPORT void hc_oscillator(ptrdiff_t n, double dt, double omega, double zeta,
                          double alpha, const double *z, double *x)
{
    double position = 0.0, speed = 0.0;
    double stiffness = omega * omega, damping = 2.0 * zeta * omega;
#define ACCELERATION(drive, q, v)                                                      \
    (stiffness * ((drive) - (q) * (1.0 + alpha * (q) * (q))) - damping * (v))
    x[0] = 0.0;
    for (ptrdiff_t k = 0; k + 1 < n; k++) {
        double half = middle(z, k, n);
        double v1 = speed, a1 = ACCELERATION(z[k], position, v1);
        double v2 = speed + 0.5 * dt * a1;
        double a2 = ACCELERATION(half, position + 0.5 * dt * v1, v2);
        double v3 = speed + 0.5 * dt * a2;
        double a3 = ACCELERATION(half, position + 0.5 * dt * v2, v3);
        double v4 = speed + dt * a3;
        double a4 = ACCELERATION(z[k + 1], position + dt * v3, v4);
        position += dt / 6.0 * (v1 + 2.0 * (v2 + v3) + v4);
        speed += dt / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
        x[k + 1] = position;
    }
}

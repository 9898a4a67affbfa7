/* A coordinate with forces inside, a function for each step as in steps.c. */

/* Corners of the input's straight lines, on which it moves from one to the next; step
 * moves q and v over one part of them. shown: weights of q, v, the sum of the forces
 * and the driving force in the output. start: q, v, and the stiffness of a spring that
 * balances the first sample, or zero. */
static double hb_mechanism(double gain, double bias, int segments, int points,
                           int ahead, const double *corners, double ramp, int parts,
                           double h, const double *step, const double *shown,
                           const double *start, int count, const double *forces,
                           double *motion, double *memory, double *history, double z)
{
    const int moves = history[0] > ahead;
    hb_remember(points, history, gain * z + bias);
    if (history[0] <= ahead) return 0;
    double p = history[1 + ahead];
    if (!moves) {
        motion[0] = start[0];
        if (start[2] > 0)
            motion[0] += hb_balance(start[2], p, count, forces, memory);
        motion[1] = start[1];
    }
    double x = motion[0], w = motion[1];
    for (int i = 0; i < segments && moves; i++) {
        const double now = hb_weighted(points, corners + i * points, history + 1);
        p = hb_weighted(points, corners + (i + 1) * points, history + 1);
        const double slope = ramp * (p - now) / parts;
        for (int s = 0; s < parts; s++) {
            const double from = now + s * slope;
            hb_moved(count, forces, memory, step, h, from, from + slope, &x, &w);
            if (!(fabs(x) < 1e100)) x = w = NAN; /* it has run away, and stays there */
        }
    }
    motion[0] = x;
    motion[1] = w;
    const double force = hb_all_forces(count, forces, x, w, 0, memory);
    return shown[0] * x + shown[1] * w + shown[2] * force + shown[3] * p;
}

/* The force that a motion takes; rate and curvature take samples on both sides. */
static double hb_impedance(double mass, double damping, double stiffness, double bias,
                           int velocity, int points, int ahead,
                           const double *rate, const double *curvature,
                           const double *way, int count, const double *forces,
                           double *place, double *memory, double *history, double z)
{
    const int moves = history[0] > ahead;
    hb_remember(points, history, z);
    if (history[0] <= ahead) return 0;
    z = history[1 + ahead];
    const int nth = (int)history[0] - 1 - ahead; /* weights of the first, second, ... */
    const int row = (nth < 4 ? nth : 4) * points;
    const double before = place[0];
    const double slope = hb_weighted(points, rate + row, history + 1);
    double q = z, v = slope, a = slope;
    if (velocity) {
        q = moves ? before + hb_weighted(points, way, history + 1) : 0;
        v = z;
    } else {
        a = hb_weighted(points, curvature + row, history + 1);
    }
    place[0] = q;
    const double moved = moves ? q - before : 0;
    const double force = hb_all_forces(count, forces, q, v, moved, memory);
    return mass * a + damping * v + stiffness * q + force + bias;
}

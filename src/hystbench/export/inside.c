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
    double x = motion[0], w = motion[1], ways[8];
    for (int i = 0; i < segments && moves; i++) {
        const double now = hb_weighted(points, corners + i * points, history + 1);
        p = hb_weighted(points, corners + (i + 1) * points, history + 1);
        const double slope = ramp * (p - now) / parts;
        for (int s = 0; s < parts; s++) {
            const double from = now + s * slope;
            hb_moved(count, forces, memory, step, h, from, from + slope, &x, &w, ways);
            if (!(fabs(x) < 1e100)) x = w = NAN; /* it has run away, and stays there */
        }
    }
    motion[0] = x;
    motion[1] = w;
    const double force = hb_sum_of_forces(count, forces, x, w, memory);
    return shown[0] * x + shown[1] * w + shown[2] * force + shown[3] * p;
}

/* Modes of a structure, as a coordinate above: table is that of joint.c, shown the weights
 * of q and v of all modes, of the force and of what drives them. rests: q of all modes
 * where a unit of what drives them has stood, then where a unit of force has; zeros where
 * it begins at rest. spring: of the joint, which holds the forces, or zero. */
static double hb_structure(int modes, int segments, int points, int ahead,
                           const double *corners, double ramp, int parts, double h,
                           const double *table, const double *shown,
                           const double *rests, double spring, int count,
                           const double *forces, double *motion, double *before,
                           double *memory, double *history, double z)
{
    const int moves = history[0] > ahead;
    hb_remember(points, history, z);
    if (history[0] <= ahead) return 0;
    double p = history[1 + ahead], ways[8];
    if (!moves) {
        double held = 0;
        const double alone = hb_at_joint(modes, table, rests) * p;
        if (spring > 0)
            held = spring *
                   (alone - hb_balance(spring, alone * spring, count, forces, memory));
        for (int i = 0; i < modes; i++)
            motion[i] = rests[i] * p - rests[modes + i] * held;
    }
    for (int i = 0; i < segments && moves; i++) {
        const double now = hb_weighted(points, corners + i * points, history + 1);
        p = hb_weighted(points, corners + (i + 1) * points, history + 1);
        const double slope = ramp * (p - now) / parts;
        for (int s = 0; s < parts; s++) {
            const double from = now + s * slope;
            hb_joint_moved(modes, table, count, forces, memory, h, from, from + slope,
                           motion, before, ways);
        }
    }
    const double x = hb_at_joint(modes, table, motion);
    const double w = hb_at_joint(modes, table, motion + modes);
    double y = shown[2 * modes] * hb_sum_of_forces(count, forces, x, w, memory);
    for (int i = 0; i < 2 * modes; i++) y += shown[i] * motion[i];
    return fabs(x) < 1e100 ? y + shown[2 * modes + 1] * p : NAN;
}

/* Forces on a motion, fine times in an interval, behind a low-pass filter of width taps.
 * The interval ends one sample before the newest of those that are known. A velocity is
 * straight between samples; that of a position is between the middles of intervals.
 * between: where the motion is, and how fast. */
static double hb_force_between(int velocity, int fine, double dt, int width,
                               const double *taps, int count, const double *forces,
                               int known, const double *samples, double *between,
                               double *memory, double *filtered)
{
    const int first = known == 2; /* of the record: the place where it begins */
    double from, middle, to;
    if (velocity) {
        from = samples[first ? 1 : 2], to = samples[1], middle = (from + to) / 2;
    } else {
        const double next = (samples[0] - samples[1]) / dt;
        middle = first ? next : (samples[1] - samples[2]) / dt;
        const double last = known > 3 ? (samples[2] - samples[3]) / dt : middle;
        from = (last + middle) / 2, to = (middle + next) / 2;
    }
    for (int i = first ? fine : 1; i <= fine; i++) {
        const double t = 2.0 * i / fine;
        const double v = t < 1 ? from + (middle - from) * t
                               : middle + (to - middle) * (t - 1);
        const double moved = first ? 0 : (between[1] + v) / 2 * (dt / fine);
        if (first)
            between[0] = velocity ? 0 : samples[1];
        else
            between[0] += moved;
        between[1] = v;
        hb_move_memories(count, forces, v, moved, first ? 0 : dt / fine, memory);
        hb_remember(width, filtered,
                    hb_sum_of_forces(count, forces, between[0], v, memory));
    }
    return hb_weighted(width, taps, filtered + 1);
}

/* The force that a motion takes. rate and curvature take samples on both sides: rows of
 * weights for the first sample, the second and so on, the last one for all that follow.
 * fine: how often forces are taken in an interval; 0 where at samples. */
static double hb_impedance(double mass, double damping, double stiffness, double bias,
                           int velocity, int points, int ahead, int last,
                           const double *rate, const double *curvature,
                           const double *way, int fine, double dt, int width,
                           const double *taps, int count, const double *forces,
                           double *place, double *between, double *memory,
                           double *filtered, double *history, double z)
{
    const int moves = history[0] > ahead;
    hb_remember(points, history, z);
    double force = 0;
    if (fine && history[0] > 1)
        force = hb_force_between(velocity, fine, dt, width, taps, count, forces,
                                 (int)history[0], history + 1, between, memory, filtered);
    if (history[0] <= ahead) return 0;
    z = history[1 + ahead];
    const int row = (place[1] < last ? (int)place[1] : last) * points;
    place[1] += 1;
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
    if (!fine) {
        hb_move_memories(count, forces, v, moves ? q - before : 0, moves ? dt : 0, memory);
        force = hb_sum_of_forces(count, forces, q, v, memory);
    }
    return mass * a + damping * v + stiffness * q + force + bias;
}

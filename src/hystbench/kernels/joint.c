/* Modes of a structure, and forces at one place of it that they move, the joint:
 * q_i'' + c_i q_i' + k_i q_i = drive_i p - joint_i F(x, x'),  x the sum of joint_i q_i.
 *
 * A motion is q of all modes, then v of all. A table holds joint_i of all modes, then the
 * numbers of a part of an interval, then those of an eighth of a part. These are: the way
 * of the joint for a unit of p at the beginning, of p at the end and of a mean force;
 * rows of a number for each mode, of its q and its v in the way of the joint; then five
 * rows for q after the part and five for v: of q, v, p at the beginning, p at the end and
 * a mean force. */

/* Where the numbers of a part begin in a table, or those of an eighth of it. */
static inline int hb_part(int modes, int eighth)
{
    return modes + (eighth ? 3 + 12 * modes : 0);
}

/* What the joint does where the modes do so much, q or v. */
static inline double hb_at_joint(int modes, const double *table, const double *of)
{
    double sum = 0;
    for (int i = 0; i < modes; i++) sum += table[i] * of[i];
    return sum;
}

/* The way of the joint over a part, if no force were there. */
static inline double hb_joint_alone(int modes, const double *part, const double *motion,
                                    double from, double to)
{
    double sum = part[0] * from + part[1] * to;
    for (int i = 0; i < 2 * modes; i++) sum += part[3 + i] * motion[i];
    return sum;
}

/* Moves all modes over a part in which the joint is held by a mean force. */
static inline void hb_modes_after(int modes, const double *part, double *restrict motion,
                                  double from, double to, double held)
{
    const double *restrict a = part + 3 + 2 * modes, *restrict b = a + 5 * modes;
    double *restrict q = motion, *restrict v = motion + modes;
    const int n = modes;
    for (int i = 0; i < n; i++) {
        const double x = q[i], w = v[i];
        q[i] = a[i] * x + a[n + i] * w + a[2 * n + i] * from + a[3 * n + i] * to -
               a[4 * n + i] * held;
        v[i] = b[i] * x + b[n + i] * w + b[2 * n + i] * from + b[3 * n + i] * to -
               b[4 * n + i] * held;
    }
}

/* The mean force that makes the joint go its way: there is none without a joint. */
static inline double hb_held(const double *part, double alone, double way)
{
    return part[2] > 0 ? (alone - way) / part[2] : 0;
}

/* Moves all modes over a part h of an interval; gives the way of the joint. */
static inline double hb_joint_over(int modes, const double *table, int eighth, int count,
                                   const double *forces, const double *memory, double h,
                                   double from, double to, double *motion)
{
    const double *part = table + hb_part(modes, eighth);
    const double alone = hb_joint_alone(modes, part, motion, from, to);
    const double x = hb_at_joint(modes, table, motion);
    const double way =
        count ? hb_way_of(count, forces, memory, x, alone, part[2], h) : alone;
    hb_modes_after(modes, part, motion, from, to, hb_held(part, alone, way));
    return way;
}

/* Moves all modes and memories over a part of an interval, in eighths where the joint
 * turns back, as hb_moved does. before: room for a motion. Returns in how many pieces,
 * and the way of each. */
static inline int hb_joint_moved(int modes, const double *table, int count,
                                 const double *forces, double *memory, double h,
                                 double from, double to, double *motion, double *before,
                                 double ways[8])
{
    for (int i = 0; i < 2 * modes; i++) before[i] = motion[i];
    ways[0] = hb_joint_over(modes, table, 0, count, forces, memory, h, from, to, motion);
    const double was = hb_at_joint(modes, table, before + modes);
    const double is = hb_at_joint(modes, table, motion + modes);
    const int fine = is * was < 0 && hb_turns(count, forces) ? 8 : 1;
    if (fine > 1)
        for (int i = 0; i < 2 * modes; i++) motion[i] = before[i];
    for (int i = 0; i < fine; i++) {
        const double now = from + i * (to - from) / fine;
        const double then = from + (i + 1) * (to - from) / fine;
        if (fine > 1)
            ways[i] = hb_joint_over(modes, table, 1, count, forces, memory, h / fine, now,
                                    then, motion);
        const double v = hb_at_joint(modes, table, motion + modes);
        hb_move_memories(count, forces, v, ways[i], h / fine, memory);
    }
    return fine;
}

/* Modes of a structure, and forces at one place of it that they move, the joint:
 * q_i'' + c_i q_i' + k_i q_i = drive_i p - joint_i F(x, x'),  x the sum of joint_i q_i.
 *
 * Of each mode a table holds 18 numbers: those that move q and v over a part of an
 * interval and over an eighth of it, as for a coordinate, then drive and joint. Its
 * motion is q of all modes, then v of all. */

/* What the joint does where the modes do so much, q or v. */
static inline double hb_at_joint(int modes, const double *table, const double *of)
{
    double sum = 0;
    for (int i = 0; i < modes; i++) sum += table[18 * i + 17] * of[i];
    return sum;
}

/* By how much less the joint moves in a part for each unit of force. eighth: 0 or 8,
 * where the numbers of the part begin. */
static inline double hb_joint_gives(int modes, const double *table, int eighth)
{
    double sum = 0;
    for (int i = 0; i < modes; i++) {
        const double *step = table + 18 * i + eighth;
        const double joint = table[18 * i + 17];
        sum += joint * joint * (step[2] + step[3]);
    }
    return sum;
}

/* The way of the joint over a part, if no force were there. */
static inline double hb_joint_alone(int modes, const double *table, int eighth,
                                    const double *motion, double from, double to)
{
    double sum = 0;
    for (int i = 0; i < modes; i++) {
        const double *own = table + 18 * i;
        const double drive = own[16];
        sum += own[17] * hb_alone(own + eighth, drive * from, drive * to, motion[i],
                                  motion[modes + i]);
    }
    return sum;
}

/* Moves all modes over a part in which the joint goes its way: what it lacks of that
 * alone tells the force. */
static inline void hb_modes_after(int modes, const double *table, int eighth,
                                  double *motion, double from, double to, double way)
{
    const double alone = hb_joint_alone(modes, table, eighth, motion, from, to);
    const double gives = hb_joint_gives(modes, table, eighth);
    const double held = gives > 0 ? (alone - way) / gives : 0; /* 0: there is no joint */
    for (int i = 0; i < modes; i++) {
        const double *step = table + 18 * i + eighth;
        const double drive = table[18 * i + 16], joint = table[18 * i + 17];
        const double first = drive * from - joint * held, last = drive * to - joint * held;
        const double q = motion[i], v = motion[modes + i];
        motion[i] = step[0] * q + step[1] * v + step[2] * first + step[3] * last;
        motion[modes + i] = step[4] * q + step[5] * v + step[6] * first + step[7] * last;
    }
}

/* Moves all modes over a part h of an interval, or an eighth of it; gives the way of the
 * joint. */
static inline double hb_joint_over(int modes, const double *table, int eighth, int count,
                                   const double *forces, const double *memory, double h,
                                   double from, double to, double *motion)
{
    const double alone = hb_joint_alone(modes, table, eighth, motion, from, to);
    const double gives = hb_joint_gives(modes, table, eighth);
    const double x = hb_at_joint(modes, table, motion);
    const double way = count ? hb_way_of(count, forces, memory, x, alone, gives, h) : alone;
    hb_modes_after(modes, table, eighth, motion, from, to, way);
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
            ways[i] = hb_joint_over(modes, table, 8, count, forces, memory, h / fine, now,
                                    then, motion);
        const double v = hb_at_joint(modes, table, motion + modes);
        hb_move_memories(count, forces, v, ways[i], h / fine, memory);
    }
    return fine;
}

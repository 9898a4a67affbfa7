/* Modes of a structure with forces at one place of it; one mode is a mechanism. */
#include "forces.c"
#include "joint.c"
#include "lanes.h"

/* Structures with numbers near the first one's. Of each array the numbers of all of them
 * lie beside one another and fill whole registers: several are moved at a time. */
struct nearby {
    index_t near, wide;               /* how many they are, and what a row holds */
    const double *table;              /* of joint.c, and its numbers of a part */
    const double *forces;             /* rows of each, one structure behind another */
    double *q, *memory;               /* q of all modes, then v; memory of all forces */
    double *from, *to;                /* what drives them over a part */
    double *x, *v, *way, *sum;        /* of the joint */
    const int *own_row;               /* forces that are not linearised, -1 behind */
};

#define EACH(k, all) for (index_t k = 0; k < (all)->wide; k += LANES)

/* Where the weights of an output stand behind a table. */
static inline int hb_shown(int modes) { return modes + 2 * (3 + 12 * modes); }

/* What a law depends on, beside the way or the velocity: the place, and its memory. */
static int minds_place(int law)
{
    return law == HB_STIFFNESS || law == HB_SINH || law == HB_STOP || law == HB_GRAVITY ||
           law == HB_SATURATING;
}
static int minds_memory(int law)
{
    return law == HB_FRICTION || law == HB_HYSTERETIC || law == HB_SLIDER ||
           law == HB_RELAXATION || law == HB_LUGRE;
}

/* A force: its mean over a way in a time h; without a time itself, at a velocity. */
static double force_at(const double *f, double x, double way, double h, const double *memory)
{
    return h > 0 ? hb_mean(f, x, way, h, memory) : hb_force(f, x, way, memory);
}

/* How far a law's place is from where it has none, beside zero. */
static double place_of(const double *f)
{
    switch ((int)f[0]) {
    case HB_SINH:
    case HB_SATURATING:
        return fabs(f[2]);
    case HB_STOP:
        return fabs(f[2]) + fabs(f[3]);
    case HB_GRAVITY: /* a radian */
        return f[4] != 0 ? 1 / fabs(f[4]) : 0;
    }
    return 0;
}

/* A small step towards zero, by which derivatives are taken from one side: that on which
 * a force at the end of its reach gives way. */
static double inwards(double z, double beside)
{
    return z > 0 ? -1e-7 * (z + fabs(beside)) : 1e-7 * (fabs(z) + fabs(beside)) + 1e-300;
}

/* Forces at places x of near structures, by derivatives of those of the first at x0.
 * ways: velocities, which differ; NULL for a way that all have. Where a force has numbers
 * of its own, or an attached mass, it is computed. Gives the sum of the first and what a
 * longer way does to it. */
static double near_forces(int count, const double *forces, const double *memory, double x0,
                          double way, double h, const struct nearby *all,
                          const double *ways, double *longer)
{
    const index_t wide = all->wide;
    double sum = 0, *sums = all->sum, by_place = 0, by_way = 0;
    const double beside = h > 0 ? way : 0; /* else it is a velocity */
    double each[count + 1], by_memory[count + 1];
    for (int r = 0; r < count; r++) {
        const double *f = forces + HB_ROW * r;
        const int law = (int)f[0];
        by_memory[r] = 0;
        const int goes = h > 0 ? hb_goes(f, memory[r], way) : 0;
        if (goes) { /* its derivatives are known */
            each[r] = hb_mean_slider(f, memory[r], way, goes);
            sum += each[r];
            by_way += goes > 0 ? f[1] / 2 : 0;
            by_memory[r] = goes > 0 ? f[1] : 0;
            continue;
        }
        /* A way is added to a place, or to what a force remembers of it. */
        const double to = minds_place(law) ? x0 : minds_memory(law) ? memory[r] : 0;
        const double bit = inwards(way, h > 0 ? to : 0);
        each[r] = force_at(f, x0, way, h, memory + r);
        sum += each[r];
        by_way += (force_at(f, x0, way + bit, h, memory + r) - each[r]) / bit;
        if (minds_place(law)) {
            const double along = inwards(x0, fabs(beside) + place_of(f));
            by_place += (force_at(f, x0 + along, way, h, memory + r) - each[r]) / along;
        }
        if (minds_memory(law)) {
            const double step = inwards(memory[r], beside), other = memory[r] + step;
            by_memory[r] = (force_at(f, x0, way, h, &other) - each[r]) / step;
        }
    }
    *longer = by_way;
    EACH(k, all) {
        lanes found = sum + by_place * (load(all->x + k) - x0);
        if (ways) found += by_way * (load(ways + k) - way);
        for (int r = 0; r < count; r++)
            found += by_memory[r] * (load(all->memory + r * wide + k) - memory[r]);
        store(sums + k, found);
    }
    for (const int *own = all->own_row; *own >= 0; own++) {
        const int i = *own / count, r = *own % count;
        const double *f = all->forces + HB_ROW * *own;
        const double its[2] = {all->memory[r * wide + i],
                               r + 1 < count ? all->memory[(r + 1) * wide + i] : 0};
        sums[i] += force_at(f, x0, way, h, its) - each[r] -
                   by_memory[r] * (its[0] - memory[r]);
    }
    return sum;
}

/* Moves the memories of near structures over a piece in which the first, whose memory is
 * that before it, goes a way to a velocity. */
static void near_memories(int count, const double *forces, double *memory, double way,
                          double v, double h, const struct nearby *all, double *moved)
{
    const index_t wide = all->wide;
    double *each = moved;
    for (const int *own = all->own_row; *own >= 0; own++, each += 2) {
        const int i = *own / count, r = *own % count;
        const double *f = all->forces + HB_ROW * *own;
        /* An attached mass has a speed too. */
        const int numbers = (int)f[0] == HB_ATTACHED ? 2 : 1;
        for (int j = 0; j < numbers; j++) each[j] = all->memory[(r + j) * wide + i];
        hb_move_memories(numbers, f, all->v[i], all->way[i], h, each);
    }
    for (int r = 0; r < count; r++) {
        const double *f = forces + HB_ROW * r, was = memory[r];
        if (!minds_memory((int)f[0])) continue;
        double *its = all->memory + r * wide;
        const int goes = hb_goes(f, was, way);
        if (goes) {
            EACH(k, all) {
                const lanes on = load(its + k) + load(all->way + k);
                store(its + k, goes > 0 ? on : (lanes){0} + was);
            }
            continue;
        }
        const double step = inwards(was, way), bit = inwards(way, was), faster = inwards(v, v);
        const double is = hb_remembered(f, way, v, h, was);
        const double by_memory = (hb_remembered(f, way, v, h, was + step) - is) / step;
        const double by_way = (hb_remembered(f, way + bit, v, h, was) - is) / bit;
        const double by_v =
            (int)f[0] == HB_FRICTION
                ? (hb_remembered(f, way, v + faster, h, was) - is) / faster
                : 0;
        EACH(k, all)
            store(its + k, is + by_memory * (load(its + k) - was) +
                               by_way * (load(all->way + k) - way) +
                               by_v * (load(all->v + k) - v));
    }
    each = moved;
    for (const int *own = all->own_row; *own >= 0; own++, each += 2) {
        const int i = *own / count, r = *own % count;
        const int numbers = (int)all->forces[HB_ROW * *own] == 10 ? 2 : 1;
        for (int j = 0; j < numbers; j++) all->memory[(r + j) * wide + i] = each[j];
    }
    hb_move_memories(count, forces, v, way, h, memory);
}

/* What joints do where the modes of each structure do so much. */
INLINE void near_joints(int modes, const struct nearby *all, const double *of, double *found)
{
    EACH(k, all) {
        lanes sum = {0};
        for (int j = 0; j < modes; j++)
            sum += load(all->table + j * all->wide + k) * load(of + j * all->wide + k);
        store(found + k, sum);
    }
}

/* Moves structures near the first over a part, of which the way in each piece is known.
 * Theirs is that by which a step of Newton's method misses the least: so they stick,
 * slide and turn where the first does, and differences of them are its derivatives.
 * motion and memory are those of the first before it. */
INLINE void follow(int modes, int count, const double *table, const double *forces, double h,
                   int pieces, const double *ways, double from, double to, double *motion,
                   double *memory, struct nearby *all, double *moved)
{
    const index_t wide = all->wide, row = modes * wide;
    const int at = hb_part(modes, pieces > 1);
    const double *part = table + at, *parts = all->table + at * wide;
    for (int i = 0; i < pieces; i++) {
        const double begins = (double)i / pieces, ends = (double)(i + 1) / pieces;
        const double now = from + begins * (to - from), then = from + ends * (to - from);
        const double way = ways[i], alone = hb_joint_alone(modes, part, motion, now, then);
        near_joints(modes, all, all->q, all->x);
        double longer = 0;
        const double x = hb_at_joint(modes, table, motion);
        const double sum = near_forces(count, forces, memory, x, way, h / pieces, all, NULL,
                                       &longer);
        const double missed = way - alone + part[2] * sum, slope = 1 + part[2] * longer;
        EACH(k, all) {
            const lanes first = load(all->from + k), rise = load(all->to + k) - first;
            const lanes begin = first + begins * rise, end = first + ends * rise;
            lanes its = load(parts + k) * begin + load(parts + wide + k) * end;
            for (int j = 0; j < 2 * modes; j++)
                its += load(parts + (3 + j) * wide + k) * load(all->q + j * wide + k);
            const lanes gives = load(parts + 2 * wide + k);
            const lanes miss = way - its + gives * load(all->sum + k);
            const lanes own = way - (miss - missed) / slope;
            /* The mean force that makes the joint go its way; it moves nothing without. */
            const lanes held = (its - own) / (gives + 1e-200);
            store(all->way + k, own);
            for (int j = 0; j < modes; j++) {
                double *q = all->q + j * wide + k, *v = q + row;
                const double *a = parts + (3 + 2 * modes + j) * wide + k, *b = a + 5 * row;
                const lanes was = load(q), fast = load(v);
                store(q, load(a) * was + load(a + row) * fast + load(a + 2 * row) * begin +
                             load(a + 3 * row) * end - load(a + 4 * row) * held);
                store(v, load(b) * was + load(b + row) * fast + load(b + 2 * row) * begin +
                             load(b + 3 * row) * end - load(b + 4 * row) * held);
            }
        }
        near_joints(modes, all, all->q + row, all->v);
        hb_modes_after(modes, part, motion, now, then, hb_held(part, alone, way));
        near_memories(count, forces, memory, way, hb_at_joint(modes, table, motion + modes),
                      h / pieces, all, moved);
    }
}

/* An output: weights of q and v of all modes, of the forces and of what drives them. */
INLINE double shown(int size, const double *weights, const double *motion, double force,
                    double p)
{
    double sum = weights[size] * force + weights[size + 1] * p;
    for (int j = 0; j < size; j++) sum += weights[j] * motion[j];
    return sum;
}

/* What is shown of a structure and of those near it. */
struct outputs {
    index_t fine, rows, total;  /* corners a sample; outputs of the first; samples of all */
    const double *rows_of_first; /* weights of each */
    int forced;                 /* whether an output depends on the forces themselves */
    double *at;                 /* where the next sample of the first output belongs */
};

/* Shows outputs at a corner: those of the first, then one of each near it. */
INLINE void show(int modes, int count, const double *table, const double *forces,
                 const double *memory, const double *now, const double *p, index_t apart,
                 struct nearby *all, struct outputs *to)
{
    const int size = 2 * modes;
    const index_t near = all->near, wide = all->wide;
    double force = 0, longer;
    if (to->forced) {
        const double x = hb_at_joint(modes, table, now);
        const double v = hb_at_joint(modes, table, now + modes);
        if (near) {
            near_joints(modes, all, all->q, all->x);
            near_joints(modes, all, all->q + modes * wide, all->v);
            force = near_forces(count, forces, memory, x, v, 0, all, all->v, &longer);
        } else {
            force = hb_sum_of_forces(count, forces, x, v, memory);
        }
    }
    for (index_t r = 0; r < to->rows; r++)
        to->at[r * to->total] = shown(size, to->rows_of_first + (size + 2) * r, now, force, *p);
    for (index_t i = 0; i < near; i++) all->from[i] = p[apart * (i + 1)];
    const double *weights = all->table + hb_shown(modes) * wide;
    EACH(k, all) {
        lanes sum = load(weights + (size + 1) * wide + k) * load(all->from + k);
        if (to->forced) sum += load(weights + size * wide + k) * load(all->sum + k);
        for (int j = 0; j < size; j++)
            sum += load(weights + j * wide + k) * load(all->q + j * wide + k);
        store(all->to + k, sum);
    }
    for (index_t i = 0; i < near; i++) to->at[(to->rows + i) * to->total] = all->to[i];
    to->at++;
}

/* Fills what is left of a record of outputs where a motion runs away. */
static void show_none(index_t samples, index_t outputs, struct outputs *to)
{
    for (index_t i = 0; i < outputs; i++)
        for (index_t k = 0; k < samples; k++) to->at[i * to->total + k] = NAN;
    to->at += samples;
}

INLINE int ran_away(int size, const double *motion)
{
    int away = 0;
    for (int j = 0; j < size; j++) away |= !(fabs(motion[j]) < 1e100);
    return away;
}

/* Moves a structure and those near it through a record, each from its first motion. */
INLINE void move(index_t n, int modes, index_t parts, double dt, double ramp, int count,
                 const double *table, const double *forces, double *memory, const double *p,
                 index_t apart, const double *starts, index_t records, struct nearby *all,
                 double *before, double *moved, struct outputs *to)
{
    const double h = dt / parts;
    const index_t near = all->near, wide = all->wide, size = 2 * modes;
    double ways[8], *remembered = before + size, now[size];
    for (int j = 0; j < size; j++) {
        now[j] = starts[j];
        for (index_t i = 0; i < near; i++)
            all->q[j * wide + i] = starts[size * records * (i + 1) + j];
    }
    for (index_t k = 0;; k++) {
        if ((n - 1 - k) % to->fine == 0)
            show(modes, count, table, forces, memory, now, p + k, apart, all, to);
        if (k + 1 == n) return;
        const double slope = ramp * (p[k + 1] - p[k]) / parts;
        int away = 0;
        for (index_t s = 0; s < parts && !away; s++) {
            const double from = p[k] + s * slope, till = from + slope;
            for (int i = 0; i < count; i++) remembered[i] = memory[i];
            const int pieces = hb_joint_moved(modes, table, count, forces, memory, h, from,
                                              till, now, before, ways);
            for (index_t i = 0; i < near; i++) {
                const double *its = p + apart * (i + 1) + k;
                const double rise = ramp * (its[1] - its[0]) / parts;
                all->from[i] = its[0] + s * rise, all->to[i] = all->from[i] + rise;
            }
            if (near)
                follow(modes, count, table, forces, h, pieces, ways, from, till, before,
                       remembered, all, moved);
            away = ran_away(size, now);
        }
        if (away) {
            show_none((n - 2 - k) / to->fine + 1, to->rows + near, to);
            return;
        }
    }
}

/* Moves a structure without forces through a record; rows: weights of its outputs. */
INLINE void coast(index_t n, int modes, double ramp, const double *table, const double *p,
                  const double *start, index_t rows, const double *weights,
                  struct outputs *to)
{
    const int size = 2 * modes;
    const double *part = table + hb_part(modes, 0);
    double now[size];
    for (int j = 0; j < size; j++) now[j] = start[j];
    for (index_t k = 0;; k++) {
        if ((n - 1 - k) % to->fine == 0) {
            for (index_t r = 0; r < rows; r++)
                to->at[r * to->total] = shown(size, weights + (size + 2) * r, now, 0, p[k]);
            to->at++;
        }
        if (k + 1 == n) return;
        hb_modes_after(modes, part, now, p[k], p[k] + ramp * (p[k + 1] - p[k]), 0);
        if (!ran_away(size, now)) continue;
        show_none((n - 2 - k) / to->fine + 1, rows, to);
        return;
    }
}

/* All of several structures without forces: the first, and those near it. */
INLINE void coast_each(index_t records, const index_t *ends, int modes, index_t near,
                       index_t wide, double ramp, const double *table,
                       const double *tables, const double *p, index_t apart,
                       const double *starts, struct outputs *to)
{
    const int numbers = hb_shown(modes) + 2 * modes + 2;
    double own[numbers], *out = to->at;
    for (int j = 0; j < numbers; j++) own[j] = table[j];
    for (index_t i = 0; i <= near; i++, p += apart, starts += 2 * modes * records) {
        for (int j = 0; i && j < numbers; j++) own[j] = tables[j * wide + i - 1];
        const double *weights = i ? own + hb_shown(modes) : to->rows_of_first;
        const index_t rows = i ? 1 : to->rows;
        to->at = i ? out + (to->rows + i - 1) * to->total : out;
        for (index_t r = 0, begin = 0; r < records; begin = ends[r++])
            coast(ends[r] - begin, modes, ramp, own, p + begin, starts + 2 * modes * r, rows,
                  weights, to);
    }
}

/* One body for each of the usual numbers of modes: loops of a known length are unrolled. */
#define FOR_MODES(call)                                                                  \
    switch (modes) {                                                                     \
    case 1: call(1); break;                                                              \
    case 2: call(2); break;                                                              \
    case 3: call(3); break;                                                              \
    case 4: call(4); break;                                                              \
    case 5: call(5); break;                                                              \
    case 6: call(6); break;                                                              \
    default: call((int)modes);                                                           \
    }

/* Outputs of a structure, and of `near` structures with numbers near its own, at every
 * `fine`-th corner of what drives them, p, counted from the end of each record. One record
 * follows another: each ends where `ends` says, and begins without a memory; starts holds
 * the first motion of each structure in each record. Over one of `parts` equal parts of
 * an interval dt the forces count with their mean over the way, which does their exact
 * work: so a passive force never gives energy, however stiff it is, and the method is of
 * second order. p moves by the share ramp of a straight line in each interval (1: straight,
 * 0: a staircase); that of the next structure lies `apart` behind it, 0 where all have the
 * same. table is that of joint.c with the weights of an output behind it, and tables that
 * of the near ones, a row for each of its numbers, filled with zeros to a multiple of
 * WIDTH. The first shows `rows` outputs by the weights of_first in place of its own; of the
 * other arrays that of each near one follows the first. Where a motion runs away the rest
 * of its record is NaN. */
EXPORT void hb_structure(index_t n, index_t records, const index_t *ends, index_t modes,
                         index_t near, index_t parts, double dt, double ramp, index_t fine,
                         const double *table, const double *tables, index_t count,
                         const double *forces, const double *p, index_t apart,
                         const double *starts, index_t rows, const double *of_first,
                         double *out)
{
    const index_t size = 2 * modes;
    const index_t wide = (near + WIDTH - 1) / WIDTH * WIDTH;
    struct outputs to = {.fine = fine, .rows = rows, .rows_of_first = of_first, .at = out};
    for (index_t r = 0, begin = 0; r < records; begin = ends[r++])
        to.total += (ends[r] - begin - 1) / fine + 1;
    if (!count && parts == 1) {
#define COAST(modes)                                                                     \
    coast_each(records, ends, modes, near, wide, ramp, table, tables, p, apart, starts, &to)
        FOR_MODES(COAST)
#undef COAST
        return;
    }
    for (index_t r = 0; r < rows; r++) to.forced |= of_first[(size + 2) * r + size] != 0;
    for (index_t i = 0; i < near; i++)
        to.forced |= tables[(hb_shown((int)modes) + size) * wide + i] != 0;
    double memory[count + 1], before[size + count + 1];
    double rows_of_near[(size + count + 6) * wide + 1], moved[2 * count * near + 1];
    int own[count * near + 1], *last = own;
    for (index_t i = 0; i < near; i++)
        for (index_t r = 0; r < count; r++) {
            const double *f = forces + HB_ROW * r, *its = f + HB_ROW * count * (i + 1);
            int differs = (int)f[0] == HB_ATTACHED;
            for (int j = 0; j < HB_ROW; j++) differs |= f[j] != its[j];
            if (differs) *last++ = (int)(count * i + r);
        }
    *last = -1;
    double *at = rows_of_near;
    for (index_t i = 0; i < (size + count + 6) * wide; i++) at[i] = 0;
    struct nearby all = {near, wide, tables, forces + HB_ROW * count, at, at + size * wide};
    at += (size + count) * wide;
    double **each[] = {&all.from, &all.to, &all.x, &all.v, &all.way, &all.sum};
    for (int j = 0; j < 6; j++, at += wide) *each[j] = at;
    all.own_row = own;
    for (index_t r = 0, begin = 0; r < records; begin = ends[r++]) {
        for (index_t i = 0; i < count; i++) memory[i] = 0;
        for (index_t i = 0; i < count * wide; i++) all.memory[i] = 0;
#define MOVE(modes)                                                                      \
    move(ends[r] - begin, modes, parts, dt, ramp, (int)count, table, forces, memory,     \
         p + begin, apart, starts + size * r, records, &all, before, moved, &to)
        FOR_MODES(MOVE)
#undef MOVE
    }
}

/* Forces against a given motion, sample by sample. */
EXPORT void hb_forces(index_t n, double dt, index_t count, const double *forces,
                      double *memory, const double *q, const double *v, double *out)
{
    const int all = (int)count;
    for (index_t k = 0; k < n; k++) {
        const double way = k ? q[k] - q[k - 1] : 0;
        hb_move_memories(all, forces, v[k], way, k ? dt : 0, memory);
        out[k] = hb_sum_of_forces(all, forces, q[k], v[k], memory);
    }
}

/* Where springs hold a force p, of which the linear one has a stiffness; memory: zeros. */
EXPORT void hb_settle(double stiffness, double p, index_t count, const double *forces,
                      const double *memory, double *q)
{
    *q = hb_balance(stiffness, p, (int)count, forces, memory);
}

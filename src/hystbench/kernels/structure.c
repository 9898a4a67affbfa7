/* Modes of a structure with forces at one place of it. */
#include "forces.c"
#include "joint.c"
#include "lanes.h"

/* One of several structures with numbers near each other. */
struct structure {
    const double *table, *forces, *p;
    double *memory, *motion, *out, *now;
    double from, to; /* what drives it over a part */
};

/* Moves structures near the first over a part, of which the way in each piece is known,
 * as `follow` in mechanism.c does. motion and memory are those of the first before it. */
static void follow(int modes, int count, index_t near, struct structure *all, double h,
                   int pieces, const double *ways, double *motion, double *memory)
{
    for (int i = 0; i < pieces; i++) {
#define AT(m, j) ((m)->from + (j) * ((m)->to - (m)->from) / pieces)
#define NUMBERS(m) ((m)->table + hb_part(modes, pieces > 1))
#define ALONE(m, motion) hb_joint_alone(modes, NUMBERS(m), motion, AT(m, i), AT(m, i + 1))
#define MISS(m, motion, memory, alone, way)                                             \
    hb_miss(count, (m)->forces, memory, hb_at_joint(modes, (m)->table, motion), alone,   \
            NUMBERS(m)[2], h / pieces, way)
#define MOVE(m, motion, memory, alone, way)                                             \
    hb_modes_after(modes, NUMBERS(m), motion, AT(m, i), AT(m, i + 1),                   \
                   hb_held(NUMBERS(m), alone, way));                                    \
    hb_move_memories(count, (m)->forces, hb_at_joint(modes, (m)->table, motion + modes), \
                     way, h / pieces, memory)
        const double way = ways[i], alone = ALONE(all, motion);
        const double missed = MISS(all, motion, memory, alone, way);
        const double bit = 1e-7 * (fabs(alone) + fabs(way));
        const double grown = MISS(all, motion, memory, alone, way + bit) - missed;
        const double slope = bit > 0 ? grown / bit : 1;
        for (struct structure *m = all + 1; m <= all + near; m++) {
            const double its = ALONE(m, m->now);
            const double own =
                way - (MISS(m, m->now, m->memory, its, way) - missed) / slope;
            MOVE(m, m->now, m->memory, its, own);
        }
        MOVE(all, motion, memory, alone, way);
#undef MOVE
#undef MISS
#undef ALONE
#undef NUMBERS
#undef AT
    }
}

/* Shows where a structure is at a sample, and what force acts there. */
static void show(int modes, int count, const struct structure *m, index_t k)
{
    for (int i = 0; i < 2 * modes; i++) m->motion[2 * modes * k + i] = m->now[i];
    m->out[k] = hb_sum_of_forces(count, m->forces, hb_at_joint(modes, m->table, m->now),
                                 hb_at_joint(modes, m->table, m->now + modes), m->memory);
}

/* Moves near structures through a record, each from its first motion. */
static void move(index_t n, int modes, index_t near, index_t parts, double dt, double ramp,
                 int count, struct structure *all, double *before, double *memory)
{
    const double h = dt / parts;
    double ways[8];
    for (index_t i = 0; i <= near; i++) {
        for (int j = 0; j < 2 * modes; j++) all[i].now[j] = all[i].motion[j];
        show(modes, count, all + i, 0);
    }
    index_t k = 0;
    for (; k + 1 < n; k++) {
        int runs_away = 0;
        for (index_t s = 0; s < parts && !runs_away; s++) {
            for (index_t i = 0; i <= near; i++) {
                const double now = all[i].p[k], slope = ramp * (all[i].p[k + 1] - now) / parts;
                all[i].from = now + s * slope, all[i].to = all[i].from + slope;
            }
            for (int i = 0; i < count; i++) memory[i] = all->memory[i];
            const int pieces =
                hb_joint_moved(modes, all->table, count, all->forces, all->memory, h,
                               all->from, all->to, all->now, before, ways);
            if (near)
                follow(modes, count, near, all, h, pieces, ways, before, memory);
            for (int i = 0; i < 2 * modes; i++) runs_away |= !(fabs(all->now[i]) < 1e100);
        }
        if (runs_away) break;
        for (index_t i = 0; i <= near; i++) show(modes, count, all + i, k + 1);
    }
    for (index_t i = 0; i <= near; i++)
        for (index_t j = k + 1; j < n; j++) {
            for (int l = 0; l < 2 * modes; l++) all[i].motion[2 * modes * j + l] = NAN;
            all[i].out[j] = NAN;
        }
}

/* Motions of the modes at the samples, a row each, and the force F, from the motion in
 * the first row of each record. Records, parts, ramp, count and near are those of
 * hb_mechanism, and so is what is done over a part; table is that of joint.c. */
EXPORT void hb_structure(index_t n, index_t records, const index_t *ends, index_t modes,
                         index_t near, index_t parts, double dt, double ramp,
                         const double *table, index_t count, const double *forces,
                         double *memory, const double *p, double *motion, double *out)
{
    struct structure all[near + 1];
    double now[2 * modes * (near + 1)], before[2 * modes], remembered[count + 1];
    for (index_t r = 0, begin = 0; r < records; begin = ends[r++]) {
        for (index_t i = 0; i <= near; i++) {
            const index_t at = begin + n * i;
            all[i] = (struct structure){
                table + (25 * modes + 6) * i, forces + 6 * count * i, p + at,
                memory + count * i, motion + 2 * modes * at, out + at, now + 2 * modes * i};
        }
        for (index_t i = 0; i < count * (near + 1); i++) memory[i] = 0;
        move(ends[r] - begin, (int)modes, near, parts, dt, ramp, (int)count, all, before,
             remembered);
    }
}

/* One coordinate with forces inside: m q'' + c q' + k q + F(q, q') = p. */
#include "forces.c"
#include "lanes.h"

/* One of several motions with numbers near each other. */
struct motion {
    const double *step, *forces, *p;
    double *memory, *q, *v, *out;
    double from, to; /* what drives it over a part */
};

/* Moves motions near the first over a part, of which the way in each piece is known. Of
 * theirs one step of Newton's method from there finds what is left: so they stick, slide
 * and turn where the first does, and differences of them are its derivatives. q, v and
 * memory are those of the first before the part. */
static void follow(int count, index_t near, struct motion *all, index_t k, double h,
                   int pieces, const double *ways, double q, double v, double *memory)
{
    const index_t offset = pieces > 1 ? 8 : 0;
    for (int i = 0; i < pieces; i++) {
#define AT(m, j) ((m)->from + (j) * ((m)->to - (m)->from) / pieces)
#define MISS(m, x, at, memory, way)                                                     \
    hb_miss(count, (m)->forces, memory, x, hb_alone(step, AT(m, i), AT(m, i + 1), x, at), \
            step[2] + step[3], h / pieces, way)
        const double way = ways[i], *step = all->step + offset;
        const double missed = MISS(all, q, v, memory, way);
        const double bit = 1e-7 * (fabs(hb_alone(step, AT(all, i), AT(all, i + 1), q, v)) +
                                   fabs(way));
        const double grown = MISS(all, q, v, memory, way + bit) - missed;
        const double slope = bit > 0 ? grown / bit : 1;
        for (struct motion *m = all + 1; m <= all + near; m++) {
            double *x = m->q + k + 1, *w = m->v + k + 1;
            step = m->step + offset;
            const double own = way - (MISS(m, *x, *w, m->memory, way) - missed) / slope;
            *w = hb_after(step, AT(m, i), AT(m, i + 1), *x, *w, own);
            *x += own;
            hb_move_memories(count, m->forces, *w, own, h / pieces, m->memory);
        }
        v = hb_after(all->step + offset, AT(all, i), AT(all, i + 1), q, v, way);
        q += way;
        hb_move_memories(count, all->forces, v, way, h / pieces, memory);
#undef MISS
#undef AT
    }
}

/* Moves near motions through a record, each from its first q and v. */
static void move(index_t n, index_t near, index_t parts, double dt, double ramp,
                 int count, struct motion *all, double *before)
{
    const double h = dt / parts;
    double ways[8];
    for (index_t i = 0; i <= near; i++)
        all[i].out[0] = hb_sum_of_forces(count, all[i].forces, all[i].q[0], all[i].v[0],
                                         all[i].memory);
    index_t k = 0;
    for (; k + 1 < n; k++) {
        for (index_t i = 0; i <= near; i++)
            all[i].q[k + 1] = all[i].q[k], all[i].v[k + 1] = all[i].v[k];
        double *x = all->q + k + 1, *w = all->v + k + 1;
        for (index_t s = 0; s < parts && fabs(*x) < 1e100; s++) {
            for (index_t i = 0; i <= near; i++) {
                const double now = all[i].p[k], slope = ramp * (all[i].p[k + 1] - now) / parts;
                all[i].from = now + s * slope, all[i].to = all[i].from + slope;
            }
            const double x_before = *x, w_before = *w;
            for (int i = 0; i < count; i++) before[i] = all->memory[i];
            const int pieces = hb_moved(count, all->forces, all->memory, all->step, h,
                                        all->from, all->to, x, w, ways);
            if (near)
                follow(count, near, all, k, h, pieces, ways, x_before, w_before, before);
        }
        if (!(fabs(*x) < 1e100 && fabs(*w) < 1e100)) break;
        for (index_t i = 0; i <= near; i++)
            all[i].out[k + 1] = hb_sum_of_forces(count, all[i].forces, all[i].q[k + 1],
                                                 all[i].v[k + 1], all[i].memory);
    }
    for (index_t i = 0; i <= near; i++)
        for (index_t j = k + 1; j < n; j++)
            all[i].q[j] = all[i].v[j] = all[i].out[j] = NAN;
}

/* Motion q, v and force F of the samples, from q[0], v[0].  One record follows another:
 * each ends where `ends` says, and begins without a memory.  step holds, for one of
 * `parts` equal parts of an interval of dt: q and v after it of q, v, and of p at its
 * beginning and its end (two rows of four); then the same for an eighth of a part.
 * Over a part the forces count with their mean over the way, which does their exact
 * work: so a passive force never gives energy, however stiff it is, and the method is
 * of second order.  p moves by the share ramp of a straight line in each interval (1:
 * straight, 0: a staircase).  Of each array follow those of `near` motions with numbers
 * near these.
 * Where a motion runs away the rest of its record is NaN. */
EXPORT void hb_mechanism(index_t n, index_t records, const index_t *ends, index_t near,
                         index_t parts, double dt, double ramp, const double *step,
                         index_t count, const double *forces, double *memory,
                         const double *p, double *q, double *v, double *out)
{
    struct motion all[near + 1];
    double before[count + 1];
    for (index_t r = 0, begin = 0; r < records; begin = ends[r++]) {
        for (index_t i = 0; i <= near; i++) {
            const index_t at = begin + n * i;
            all[i] = (struct motion){step + 16 * i, forces + 6 * count * i, p + at,
                                     memory + count * i, q + at, v + at, out + at};
        }
        for (index_t i = 0; i < count * (near + 1); i++) memory[i] = 0;
        move(ends[r] - begin, near, parts, dt, ramp, (int)count, all, before);
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

/* What flows out of a store; a general power takes ten times as long as a root. */
static inline double hb_outflow(double rate, double exponent, double h)
{
    if (!(h > 0)) return 0;
    if (exponent == 1) return rate * h;
    return rate * (exponent == 0.5 ? sqrt(h) : pow(h, exponent));
}

/* fmax is a call of a library's. */
static inline double hb_above_zero(double h) { return h > 0 ? h : 0; }

/* Level h of a store, h' = inflow - rate h^exponent, held below the height: what would
 * rise above it is spilt, as a mean over the interval before each sample.  Runge-Kutta
 * of second order (midpoint) in equal parts of each interval; with an exponent of
 * one and no rim (a height of 1e30) it is exact. The inflow moves as in hb_mechanism. */
EXPORT void hb_store(index_t n, index_t parts, double dt, double ramp, double rate,
                     double exponent, double height, const double *z, double *level,
                     double *outflow, double *spilt)
{
    const double t = dt / parts, lost = rate * t;
    /* Of a level, and what a steady inflow and a rising one bring, in one part. */
    const double kept = exp(-lost), steady = lost > 1e-5 ? (1 - kept) / rate : t;
    const double rising = lost > 1e-5 ? (t - steady) / lost : t / 2;
    spilt[0] = 0;
    outflow[0] = hb_outflow(rate, exponent, level[0]);
    for (index_t k = 0; k + 1 < n; k++) {
        const double slope = ramp * (z[k + 1] - z[k]) / parts;
        double h = level[k], over = 0;
        for (index_t s = 0; s < parts; s++) {
            const double from = z[k] + s * slope;
            if (exponent == 1 && height >= 1e30) {
                h = hb_above_zero(kept * h + steady * from + rising * slope);
            } else {
                const double rise = from - hb_outflow(rate, exponent, h);
                const double half = hb_above_zero(h + t / 2 * rise);
                const double left = hb_outflow(rate, exponent, half < height ? half : height);
                h = hb_above_zero(h + t * (from + slope / 2 - left));
            }
            if (h > height) over += h - height, h = height;
        }
        level[k + 1] = h;
        outflow[k + 1] = hb_outflow(rate, exponent, h);
        spilt[k + 1] = over / dt;
    }
}

/* An outflow, and what it changes by for each unit of the level, rate and exponent. */
typedef struct { double flow, level, rate, exponent; } hb_slopes_t;

static inline hb_slopes_t hb_outflow_slopes(double rate, double exponent, double h,
                                            int bends)
{
    if (!(h > 0)) return (hb_slopes_t){0, 0, 0, 0};
    const double unit = hb_outflow(1, exponent, h), flow = rate * unit;
    return (hb_slopes_t){flow, exponent * flow / h, unit, bends ? flow * log(h) : 0};
}

/* A store as in hb_store, and by how much others near it differ, to first order: their
 * numbers and inflows differ by rates, exponents, heights and inflows, which are small.
 * Tables have a row a sample and a column for each of the others; the first row of
 * levels is given. */
EXPORT void hb_store_near(index_t n, index_t parts, double dt, double ramp, double rate,
                          double exponent, double height, const double *z, double *level,
                          double *outflow, double *spilt, index_t count,
                          const double *restrict rates, const double *restrict exponents,
                          const double *restrict heights, const double *inflows,
                          double *levels, double *outflows, double *spills)
{
    const double t = dt / parts;
    int bends = 0; /* whether an exponent differs: else no logarithm is needed */
    for (index_t i = 0; i < count; i++) bends |= exponents[i] != 0;
    for (index_t k = 0; k < n; k++) {
        const hb_slopes_t out = hb_outflow_slopes(rate, exponent, level[k], bends);
        const double *restrict now = inflows + k * count, *restrict then = now + count;
        double *restrict d = levels + k * count, *restrict next = d + count;
        double *restrict over = spills + (k + 1) * count;
        outflow[k] = out.flow;
        for (index_t i = 0; i < count; i++)
            outflows[k * count + i] = out.level * d[i] + out.rate * rates[i]
                                      + out.exponent * exponents[i];
        if (k + 1 == n) break;
        const double slope = ramp * (z[k + 1] - z[k]) / parts;
        double h = level[k], lost = 0;
        for (index_t i = 0; i < count; i++) next[i] = d[i], over[i] = 0;
        for (index_t s = 0; s < parts; s++) {
            const double from = z[k] + s * slope;
            const hb_slopes_t first = hb_outflow_slopes(rate, exponent, h, bends);
            const double to = h + t / 2 * (from - first.flow);
            const double half = hb_above_zero(to < height ? to : height);
            const hb_slopes_t second = hb_outflow_slopes(rate, exponent, half, bends);
            const double reached = h + t * (from + slope / 2 - second.flow);
            const double moves = to > 0 && to < height, held = to >= height;
            const double stays = reached > 0, spills_now = reached > height;
            for (index_t i = 0; i < count; i++) {
                const double rise = ramp * (then[i] - now[i]) / parts;
                const double inflow = now[i] + s * rise;
                const double left = first.level * next[i] + first.rate * rates[i]
                                    + first.exponent * exponents[i];
                const double middle = moves * (next[i] + t / 2 * (inflow - left))
                                      + held * heights[i];
                const double leaves = second.level * middle + second.rate * rates[i]
                                      + second.exponent * exponents[i];
                const double end = stays * (next[i] + t * (inflow + rise / 2 - leaves));
                over[i] += spills_now * (end - heights[i]);
                next[i] = spills_now * heights[i] + (1 - spills_now) * end;
            }
            h = hb_above_zero(reached);
            if (h > height) lost += h - height, h = height;
        }
        for (index_t i = 0; i < count; i++) over[i] /= dt;
        level[k + 1] = h;
        spilt[k + 1] = lost / dt;
    }
}

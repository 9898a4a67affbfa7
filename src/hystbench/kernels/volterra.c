/* LMS of the second-order Volterra filter with all products x(k-i) x(k-j).
 *
 * The second-order weights W are a matrix.  Its antisymmetric part predicts
 * nothing and is never corrected, since x x' is symmetric: the symmetric part
 * alone adapts.  So the lower triangle is kept, tile after tile of 4 x 4 weights,
 * and what lies off the diagonal tiles counts twice in the output.  One sweep
 * corrects the weights for sample k-2 and predicts sample k; what the correction for
 * sample k-1 adds to it is step1 g + step2 g^2 times the error, g = x(k-1)'x(k),
 * since the products' own product is g^2 (see lms.c).
 *
 * A constant tap, if it is not zero, has a weight of its own, own[0].
 */
#include "lanes.h"

#define PIECES (TILE / PART) /* vectors in a tile's row */

/* w += change1 * last, W += change2 * last last'; return w.x + x'W x, where
 * parts is the number of vectors of taps. */
INLINE double sweep(const double *x, const double *last, double change1, double change2,
                    double *first, double *second, index_t parts)
{
    part scaled[parts], off[parts], on[parts];
    part even = {0}, odd = {0};
    UNROLL
    for (index_t c = 0; c < parts; c++) {
        part w = load_part(first + PART * c) + change1 * load_part(last + PART * c);
        store_part(first + PART * c, w);
        on[c] = w;
        scaled[c] = change2 * load_part(last + PART * c);
        off[c] = (part){0};
    }
    UNROLL
    for (index_t b = 0; b < parts; b += PIECES) {
        const double *xs = x + PART * b, *ls = last + PART * b;
        const double x0 = xs[0], x1 = xs[1], x2 = xs[2], x3 = xs[3];
        const double l0 = ls[0], l1 = ls[1], l2 = ls[2], l3 = ls[3];
        UNROLL
        for (index_t c = 0; c < b + PIECES; c++) {
            double *w = second + (c / PIECES) * TILE * TILE + (c % PIECES) * PART;
            part w0 = load_part(w) + l0 * scaled[c];
            part w1 = load_part(w + TILE) + l1 * scaled[c];
            part w2 = load_part(w + 2 * TILE) + l2 * scaled[c];
            part w3 = load_part(w + 3 * TILE) + l3 * scaled[c];
            part t = (x0 * w0 + x1 * w1) + (x2 * w2 + x3 * w3);
            store_part(w, w0);
            store_part(w + TILE, w1);
            store_part(w + 2 * TILE, w2);
            store_part(w + 3 * TILE, w3);
            if (c < b)
                off[c] += t;
            else
                on[c] += t;
        }
        second += (b / PIECES + 1) * TILE * TILE;
    }
    UNROLL
    for (index_t c = 0; c < parts; c++) {
        part t = (on[c] + 2 * off[c]) * load_part(x + PART * c);
        if (c & 1)
            odd += t;
        else
            even += t;
    }
    return sum_part(even + odd);
}

INLINE double product(const double *a, const double *b, index_t parts)
{
    part even = {0}, odd = {0};
    UNROLL
    for (index_t c = 0; c < parts; c++) {
        part t = load_part(a + PART * c) * load_part(b + PART * c);
        if (c & 1)
            odd += t;
        else
            even += t;
    }
    return sum_part(even + odd);
}

INLINE index_t lms_volterra(index_t n, index_t taps, const double *line,
                            const double *d, double step1, double step2,
                            double constant, double limit,
                            double *first, double *second, double *own, double *y,
                            double *e, index_t parts)
{
    const index_t size = PART * parts, padding = size - taps;
    double windows[3][size] ALIGNED, used[size] ALIGNED;
    double correction = 0, older = 0;
    double *x = windows[0], *last = windows[1], *oldest = windows[2];
    index_t k;
    for (index_t j = 0; j < size; j++) {
        x[j] = last[j] = oldest[j] = 0;
        used[j] = j >= padding;
    }
    for (k = 0; k < n; k++) {
        UNROLL
        for (index_t j = 0; j < size; j += PART)
            store_part(x + j, load_part(line + k + j) * load_part(used + j));
        double g = product(x, last, parts);
        double before =
            sweep(x, oldest, step1 * older, step2 * older, first, second, parts);
        double output = before + correction * (step1 * g + step2 * g * g);
        if (constant) {
            own[0] += step1 * correction * constant;
            output += own[0] * constant;
        }
        double error = d[k] - output;
        older = correction;
        correction = 0;
        double *spare = oldest;
        oldest = last;
        last = x;
        x = spare;
        if (diverged(error, limit)) break;
        y[k] = output;
        e[k] = error;
        correction = error;
    }
    /* the two corrections still owed; the outputs go nowhere */
    sweep(x, oldest, step1 * older, step2 * older, first, second, parts);
    sweep(x, last, step1 * correction, step2 * correction, first, second, parts);
    own[0] += step1 * correction * constant;
    return k;
}

/* line holds x(k - size + 1) .. x(k) from [k] on, size = TILE * tiles. */
EXPORT index_t hb_lms_volterra(index_t n, index_t tiles, index_t taps,
                               const double *line, const double *d, double step1,
                               double step2, double constant,
                               double limit, double *first, double *second,
                               double *own, double *y, double *e)
{
#define CALL(size)                                                                 \
    lms_volterra(n, taps, line, d, step1, step2, constant, limit, \
                 first, second, own, y, e, (size) * PIECES)
    switch (tiles) {
    case 1: return CALL(1);
    case 2: return CALL(2);
    case 3: return CALL(3);
    case 4: return CALL(4);
    case 5: return CALL(5);
    case 6: return CALL(6);
    case 7: return CALL(7);
    case 8: return CALL(8);
    default: return CALL(tiles);
    }
#undef CALL
}

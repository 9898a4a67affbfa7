/* LMS of the second-order Volterra filter with all products x(k-i) x(k-j).
 *
 * The second-order weights W are a matrix.  Its antisymmetric part predicts
 * nothing and is never corrected, since x x' is symmetric: the symmetric part
 * alone adapts.  So the lower triangle is kept, as tiles of 4 x 4 in rows, and what
 * lies off the diagonal tiles counts twice in the output.  One sweep corrects the weights for sample k-2 and predicts sample k; what the
 * correction for sample k-1 adds to it is step1 g + step2 g^2 times the error,
 * g = x(k-1)'x(k), since the products' own product is g^2 (see lms.c).
 */
#include "lanes.h"

INLINE quad spread(double a) { return (quad){a, a, a, a}; }

/* w += change1 * last, W += change2 * last last'; return w.x + x'W x. */
INLINE double sweep(const double *x, const double *last, double change1, double change2,
                    double *first, double *second, index_t blocks)
{
    quad scaled[blocks], off[blocks], on[blocks];
    quad even = {0}, odd = {0};
    UNROLL
    for (index_t c = 0; c < blocks; c++) {
        quad w = load_quad(first + QUAD * c) + change1 * load_quad(last + QUAD * c);
        store_quad(first + QUAD * c, w);
        on[c] = w;
        scaled[c] = change2 * load_quad(last + QUAD * c);
        off[c] = (quad){0};
    }
    UNROLL
    for (index_t b = 0; b < blocks; b++) {
        quad x0 = spread(x[QUAD * b]), x1 = spread(x[QUAD * b + 1]);
        quad x2 = spread(x[QUAD * b + 2]), x3 = spread(x[QUAD * b + 3]);
        quad l0 = spread(last[QUAD * b]), l1 = spread(last[QUAD * b + 1]);
        quad l2 = spread(last[QUAD * b + 2]), l3 = spread(last[QUAD * b + 3]);
        UNROLL
        for (index_t c = 0; c <= b; c++) {
            quad w0 = load_quad(second) + l0 * scaled[c];
            quad w1 = load_quad(second + 4) + l1 * scaled[c];
            quad w2 = load_quad(second + 8) + l2 * scaled[c];
            quad w3 = load_quad(second + 12) + l3 * scaled[c];
            store_quad(second, w0);
            store_quad(second + 4, w1);
            store_quad(second + 8, w2);
            store_quad(second + 12, w3);
            second += 16;
            quad t = (x0 * w0 + x1 * w1) + (x2 * w2 + x3 * w3);
            if (c < b)
                off[c] += t;
            else
                on[c] += t;
        }
    }
    UNROLL
    for (index_t c = 0; c < blocks; c++) {
        quad t = (on[c] + 2 * off[c]) * load_quad(x + QUAD * c);
        if (c & 1)
            odd += t;
        else
            even += t;
    }
    return sum_quad(even + odd);
}

INLINE double product(const double *a, const double *b, index_t blocks)
{
    quad even = {0}, odd = {0};
    UNROLL
    for (index_t c = 0; c < blocks; c++) {
        quad t = load_quad(a + QUAD * c) * load_quad(b + QUAD * c);
        if (c & 1)
            odd += t;
        else
            even += t;
    }
    return sum_quad(even + odd);
}

INLINE index_t lms_volterra(index_t n, index_t taps, const double *line, const double *d,
                            double step1, double step2, double regularization,
                            double limit, double *first, double *second, double *y,
                            double *e, index_t blocks)
{
    const index_t size = QUAD * blocks, padding = size - taps;
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
        for (index_t j = 0; j < size; j += QUAD)
            store_quad(x + j, load_quad(line + k + j) * load_quad(used + j));
        double g = product(x, last, blocks);
        double before =
            sweep(x, oldest, step1 * older, step2 * older, first, second, blocks);
        double output = before + correction * (step1 * g + step2 * g * g);
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
        if (regularization >= 0) {
            double power = product(last, last, blocks); /* of products: its square */
            correction *= 1 / (regularization + power + power * power);
        }
    }
    /* the two corrections still owed; the outputs go nowhere */
    sweep(x, oldest, step1 * older, step2 * older, first, second, blocks);
    sweep(x, last, step1 * correction, step2 * correction, first, second, blocks);
    return k;
}
/* line holds x(k - size + 1) .. x(k) from [k] on, size = 4 * blocks. */
EXPORT index_t hb_lms_volterra(index_t n, index_t blocks, index_t taps,
                               const double *line, const double *d, double step1,
                               double step2, double regularization, double limit,
                               double *first, double *second, double *y, double *e)
{
#define CALL(size)                                                                \
    lms_volterra(n, taps, line, d, step1, step2, regularization, limit, first, \
                 second, y, e, size)
    switch (blocks) {
    case 1: return CALL(1);
    case 2: return CALL(2);
    case 3: return CALL(3);
    case 4: return CALL(4);
    case 5: return CALL(5);
    case 6: return CALL(6);
    case 7: return CALL(7);
    case 8: return CALL(8);
    default: return CALL(blocks);
    }
#undef CALL
}

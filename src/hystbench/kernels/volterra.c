/* LMS of the second-order Volterra filter with all products x(k-i) x(k-j).
 *
 * The second-order weights W are a matrix.  Its antisymmetric part predicts
 * nothing and is never corrected, since x x' is symmetric: the symmetric part
 * alone adapts.  So the block lower triangle is kept (blocks of 4 x 4, row by
 * row), and what lies outside the diagonal blocks counts twice in the output.
 * One sweep corrects the weights for sample k-1 and predicts sample k.
 */
#include "lanes.h"

#define QUAD 4

/* w += change1 * before, W += change2 * before before'; return w.x + x'W x. */
INLINE double sweep(const double *x, const double *before, double change1,
                    double change2, double *first, double *second, index_t blocks)
{
    quad own_u[8], own_t[8];
    quad u_many[blocks <= 8 ? 1 : blocks], t_many[blocks <= 8 ? 1 : blocks];
    quad *u = blocks <= 8 ? own_u : u_many, *t = blocks <= 8 ? own_t : t_many;
    quad linear = {0}, square = {0};
#pragma GCC unroll 8
    for (index_t c = 0; c < blocks; c++) {
        quad w = load_quad(first + QUAD * c) + change1 * load_quad(before + QUAD * c);
        store_quad(first + QUAD * c, w);
        linear += w * load_quad(x + QUAD * c);
        u[c] = change2 * load_quad(before + QUAD * c);
        t[c] = (quad){0};
    }
#pragma GCC unroll 8
    for (index_t b = 0; b < blocks; b++)
#pragma GCC unroll 4
        for (index_t i = QUAD * b; i < QUAD * b + QUAD; i++) {
            double xi = x[i], bi = before[i], twice = 2 * xi;
#pragma GCC unroll 8
            for (index_t c = 0; c <= b; c++) {
                quad w = load_quad(second) + bi * u[c];
                store_quad(second, w);
                t[c] += (c < b ? twice : xi) * w;
                second += QUAD;
            }
        }
#pragma GCC unroll 8
    for (index_t c = 0; c < blocks; c++) square += t[c] * load_quad(x + QUAD * c);
    return sum_quad(linear + square);
}

INLINE index_t lms_volterra(index_t n, index_t taps, const double *line, const double *d,
                            double step1, double step2, double regularization,
                            double limit, double *first, double *second, double *y,
                            double *e, index_t blocks)
{
    const index_t size = QUAD * blocks, padding = size - taps;
    double window[2][size];
    double change1 = 0, change2 = 0;
    index_t k;
    for (index_t j = 0; j < size; j++) window[0][j] = window[1][j] = 0;
    for (k = 0; k < n; k++) {
        double *x = window[k & 1], *before = window[~k & 1];
        for (index_t j = 0; j < size; j++) x[j] = line[k + j];
        for (index_t j = 0; j < padding; j++) x[j] = 0;
        double output = sweep(x, before, change1, change2, first, second, blocks);
        double error = d[k] - output;
        change1 = change2 = 0;
        if (diverged(error, limit)) break;
        y[k] = output;
        e[k] = error;
        if (regularization >= 0) {
            quad power = {0};
            for (index_t c = 0; c < size; c += QUAD)
                power += load_quad(x + c) * load_quad(x + c);
            double all = sum_quad(power); /* of all products: its square */
            error /= regularization + all + all * all;
        }
        change1 = step1 * error;
        change2 = step2 * error;
    }
    if (k == n && n > 0) sweep(window[n & 1], window[~n & 1], change1, change2, first, second, blocks);
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

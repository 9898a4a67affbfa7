/* Simulation of a discrete linear state-space system, one input, one output. */
#include "lanes.h"

#define FEW 4 /* states */
#define BLOCK WIDTH

INLINE void simulate(index_t n, const double *a, const double *b, const double *c,
                     double d, const double *u, double *state, double *y,
                     index_t vectors)
{
    const index_t size = vectors * LANES;
    double x[size] ALIGNED;
    lanes next[vectors];
    copy(size, state, x);
    for (index_t k = 0; k < n; k++) {
        lanes output = {0};
        UNROLL
        for (index_t j = 0; j < vectors; j++) {
            const double *column = a + j * LANES;
            lanes even = load(b + j * LANES) * u[k], odd = {0};
            output += load(c + j * LANES) * load(x + j * LANES);
            UNROLL /* two chains of sums: half the wait */
            for (index_t i = 0; i < size; i += 2) {
                even += load(column + i * size) * x[i];
                odd += load(column + (i + 1) * size) * x[i + 1];
            }
            next[j] = even + odd;
        }
        y[k] = sum(output) + d * u[k];
        UNROLL
        for (index_t j = 0; j < vectors; j++) store(x + j * LANES, next[j]);
    }
    copy(size, x, state);
}

/* The same of few states, BLOCK samples at a time: what a block gives, and the state
 * behind it, are sums over the state before it and its inputs. So a sample need not
 * wait for the one before. */
INLINE void simulate_few(index_t n, const double *a, const double *b, const double *c,
                         double d, const double *u, double *state, double *y,
                         index_t states)
{
    double free[FEW][BLOCK] ALIGNED, answers[BLOCK][BLOCK] ALIGNED = {{0}};
    double left[FEW][FEW] ALIGNED = {{0}}, brought[BLOCK][FEW] ALIGNED = {{0}};
    /* From a one in each state, and from a one in the first input. */
    for (index_t from = 0; from <= states; from++) {
        double x[FEW] = {0}, next[FEW];
        if (from < states) x[from] = 1;
        for (index_t k = 0; k < BLOCK; k++) {
            double output = from == states && k == 0 ? d : 0;
            for (index_t i = 0; i < states; i++) {
                output += c[i] * x[i];
                next[i] = from == states && k == 0 ? b[i] : 0;
                for (index_t j = 0; j < states; j++) next[i] += a[j * WIDTH + i] * x[j];
            }
            copy(states, next, x);
            if (from < states)
                free[from][k] = output;
            else {
                for (index_t j = 0; j + k < BLOCK; j++) answers[j][j + k] = output;
                copy(states, x, brought[BLOCK - 1 - k]);
            }
        }
        if (from < states) copy(states, x, left[from]);
    }
    double x[FEW] ALIGNED = {0};
    copy(states, state, x);
    index_t k = 0;
    for (; k + BLOCK <= n; k += BLOCK) {
        lanes even[BLOCK / LANES] = {{0}}, odd[BLOCK / LANES] = {{0}};
        part from_state[FEW / PART] = {{0}}, from_input[FEW / PART] = {{0}};
        UNROLL
        for (index_t j = 0; j < BLOCK; j += 2) {
            UNROLL
            for (index_t i = 0; i < BLOCK / LANES; i++) {
                even[i] += load(answers[j] + i * LANES) * u[k + j];
                odd[i] += load(answers[j + 1] + i * LANES) * u[k + j + 1];
            }
            UNROLL
            for (index_t i = 0; i < FEW / PART; i++) {
                from_input[i] += load_part(brought[j] + i * PART) * u[k + j];
                from_input[i] += load_part(brought[j + 1] + i * PART) * u[k + j + 1];
            }
        }
        UNROLL
        for (index_t j = 0; j < states; j++) {
            UNROLL
            for (index_t i = 0; i < BLOCK / LANES; i++)
                even[i] += load(free[j] + i * LANES) * x[j];
            UNROLL
            for (index_t i = 0; i < FEW / PART; i++)
                from_state[i] += load_part(left[j] + i * PART) * x[j];
        }
        UNROLL
        for (index_t i = 0; i < BLOCK / LANES; i++)
            store(y + k + i * LANES, even[i] + odd[i]);
        UNROLL
        for (index_t i = 0; i < FEW / PART; i++)
            store_part(x + i * PART, from_state[i] + from_input[i]);
    }
    for (; k < n; k++) {
        double next[FEW] = {0};
        y[k] = d * u[k];
        for (index_t i = 0; i < states; i++) {
            y[k] += c[i] * x[i];
            next[i] = b[i] * u[k];
            for (index_t j = 0; j < states; j++) next[i] += a[j * WIDTH + i] * x[j];
        }
        copy(states, next, x);
    }
    copy(states, x, state);
}

/* x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k); a holds the columns of A,
 * and all is padded with zeros to a multiple of WIDTH states. */
EXPORT void hb_state_space(index_t n, index_t wide, index_t states, const double *a,
                           const double *b, const double *c, double d, const double *u,
                           double *state, double *y)
{
    if (states == 1)
        simulate_few(n, a, b, c, d, u, state, y, 1);
    else if (states == 2)
        simulate_few(n, a, b, c, d, u, state, y, 2);
    else if (states == 3)
        simulate_few(n, a, b, c, d, u, state, y, 3);
    else if (states == 4)
        simulate_few(n, a, b, c, d, u, state, y, 4);
    else if (wide == 1)
        simulate(n, a, b, c, d, u, state, y, WIDTH / LANES);
    else if (wide == 2)
        simulate(n, a, b, c, d, u, state, y, 2 * WIDTH / LANES);
    else
        simulate(n, a, b, c, d, u, state, y, wide * WIDTH / LANES);
}

INLINE index_t modes(index_t n, const double *factors, const double *b,
                     const double *c, double d, const double *u, double *state,
                     double *y, index_t vectors)
{
    const index_t size = vectors * LANES;
    double x[size] ALIGNED;
    copy(size, state, x);
    for (index_t k = 0; k < n; k++) {
        lanes output = {0};
        UNROLL
        for (index_t j = 0; j < size; j += LANES) {
            const lanes now = load(x + j);
            output += load(c + j) * now;
            store(x + j, load(factors + j) * now + load(b + j) * u[k]);
        }
        y[k] = sum(output) + d * u[k];
    }
    copy(size, x, state);
    return n;
}

/* The same where A is diagonal: factors holds its diagonal. */
EXPORT index_t hb_modes(index_t n, index_t wide, const double *factors,
                        const double *b, const double *c, double d, const double *u,
                        double *state, double *y)
{
#define CALL(size) modes(n, factors, b, c, d, u, state, y, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

/* Systems of one size, each on a record of its own: rows of places hold the length of a
 * record, and where its input, its output, the system (a, b, c, d) and following lie.
 * Each begins at -following u(0), as the input was zero before. Where states is 0 a is
 * the diagonal. */
EXPORT index_t hb_records(index_t records, index_t wide, index_t states,
                          const index_t *places)
{
    double state[wide * WIDTH] ALIGNED;
    for (const index_t *row = places; row < places + 8 * records; row += 8) {
        const index_t n = row[0];
        if (!n) continue;
        const double *u = (const double *)row[1], *a = (const double *)row[3];
        const double *b = (const double *)row[4], *c = (const double *)row[5];
        const double d = *(const double *)row[6];
        const double *following = (const double *)row[7];
        double *y = (double *)row[2];
        for (index_t i = 0; i < wide * WIDTH; i++) state[i] = -following[i] * u[0];
        if (states)
            hb_state_space(n, wide, states, a, b, c, d, u, state, y);
        else
            hb_modes(n, wide, a, b, c, d, u, state, y);
    }
    return 0;
}

INLINE index_t states(index_t n, const double *a, double *out, index_t vectors)
{
    const index_t size = vectors * LANES;
    for (index_t k = 1; k < n; k++) {
        const double *x = out + (k - 1) * size;
        double *next = out + k * size;
        UNROLL
        for (index_t j = 0; j < size; j += LANES) {
            lanes even = load(next + j), odd = {0};
            UNROLL
            for (index_t i = 0; i < size; i += 2) {
                even += load(a + j + i * size) * x[i];
                odd += load(a + j + (i + 1) * size) * x[i + 1];
            }
            store(next + j, even + odd);
        }
    }
    return n;
}

/* x(k) = A x(k-1) + drive(k), every state of every sample: out holds the drives, and
 * then the states. The first sample stays; a holds the columns of A, padded. */
EXPORT index_t hb_states(index_t n, index_t wide, const double *a, double *out)
{
#define CALL(size) states(n, a, out, size)
    FOR_SIZES(wide, CALL)
#undef CALL
}

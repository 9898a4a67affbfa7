/* A model of hystbench as a unit that another program steps, in any version of FMI.
 *
 * The model takes a step wherever a multiple of its own interval is passed: with the
 * input that was set before, so that its output is that of the step's first sample.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "@name@.h"

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

/* References of the variables, as in modelDescription.xml. */
enum { TIME, INPUT, OUTPUT };

static const char *const TOKEN = "@token@";

typedef struct {
    double start, time, input, output;
    double count; /* steps since the start */
    @name@_state state;
} Values;

static void begin(Values *now)
{
    memset(now, 0, sizeof *now);
    @name@_init(&now->state);
}

/* NULL where there is no such variable. */
static const double *variable(const Values *now, unsigned long reference)
{
    switch (reference) {
    case TIME: return &now->time;
    case INPUT: return &now->input;
    case OUTPUT: return &now->output;
    default: return NULL;
    }
}

static void advance(Values *now, double end)
{
    /* times are sums, which are a little off */
    const double due = floor((end - now->start) / @NAME@_DT + 1e-6);
    for (; now->count < due; now->count++)
        now->output = @name@_step(&now->state, now->input);
    now->time = end;
}

/* Copy the values to where a copy was before, or to new memory: 0 where there is none. */
static int keep(const Values *now, void **kept)
{
    if (!*kept) *kept = malloc(sizeof *now);
    if (*kept) memcpy(*kept, now, sizeof *now);
    return *kept != NULL;
}

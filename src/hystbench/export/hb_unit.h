/* A model of hystbench as a unit that another program steps, in any version of FMI.
 *
 * The model takes a step wherever a multiple of its own interval is passed: with the
 * input that was set before, so that its output is that of the step's first sample.
 * Reference is FMI's type for the number of a variable.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "@model.name@.h"

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

/* References of the variables, as in modelDescription.xml. */
enum { TIME, INPUT, OUTPUT, VARIABLES };

static const char *const TOKEN = "@token@";

typedef struct {
    double variable[VARIABLES];
    double start; /* time */
    double count; /* steps since the start */
    @model.name@_state state;
} Values;

static void begin(Values *now)
{
    memset(now, 0, sizeof *now);
    @model.name@_init(&now->state);
}

/* These tell what is wrong; NULL where nothing is. */

static const char *get(const Values *now, const Reference vr[], size_t count,
                       double values[])
{
    for (size_t i = 0; i < count; i++) {
        if (vr[i] >= VARIABLES) return "no such variable";
        values[i] = now->variable[vr[i]];
    }
    return NULL;
}

static const char *set(Values *now, const Reference vr[], size_t count,
                       const double values[])
{
    for (size_t i = 0; i < count; i++) {
        if (vr[i] != INPUT) return "only the input can be set";
        now->variable[INPUT] = values[i];
    }
    return NULL;
}

/* Copy the values to where a copy was before, or to new memory. */
static const char *keep(const Values *now, void **kept)
{
    if (!*kept) *kept = malloc(sizeof *now);
    if (!*kept) return "out of memory";
    memcpy(*kept, now, sizeof *now);
    return NULL;
}

static void advance(Values *now, double end)
{
    /* times are sums, which are a little off */
    const double due = floor((end - now->start) / @model.name | upper@_DT + 1e-6);
    for (; now->count < due; now->count++)
        now->variable[OUTPUT] = @model.name@_step(&now->state, now->variable[INPUT]);
    now->variable[TIME] = end;
}

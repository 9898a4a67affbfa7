{% set fmi, instance, state = "fmi2", "Component", "state" %}
/* A model of hystbench as an FMU of FMI 2.0 for co-simulation.
 *
 * The FMI headers are the importing tool's.
 */
#ifndef FMI2_OVERRIDE_FUNCTION_PREFIX /* set for a shared library: names as they are */
#define FMI2_FUNCTION_PREFIX @model.name@_
#endif
#include "fmi2Functions.h"

typedef fmi2ValueReference Reference;
#include "hb_unit.h"

typedef struct {
    Values now;
    fmi2ComponentEnvironment environment;
    fmi2CallbackLogger log;
    char name[]; /* the caller's string may be gone after the call */
} Instance;

/* The logger takes a format, but not all importers fill it: give it whole words. */
static fmi2Status refuse(const Instance *self, const char *why)
{
    if (self->log)
        self->log(self->environment, self->name, fmi2Error, "logStatusError", why);
    return fmi2Error;
}

{% include "fmi_shared.c" %}

const char *fmi2GetVersion(void) { return fmi2Version; }

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType,
                              fmi2String fmuGUID, fmi2String fmuResourceLocation,
                              const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn)
{
    const char *name = instanceName ? instanceName : "";
    const size_t length = strlen(name) + 1;
    Instance *self = malloc(sizeof *self + length);
    if (!self) return NULL;
    begin(&self->now);
    self->environment = functions ? functions->componentEnvironment : NULL;
    self->log = functions ? functions->logger : NULL;
    memcpy(self->name, name, length);
    if (fmuType != fmi2CoSimulation)
        refuse(self, "this model has no model exchange; expected co-simulation");
    else if (!fmuGUID || strcmp(fmuGUID, TOKEN) != 0)
        refuse(self, "the GUID is that of another model");
    else
        return self;
    free(self);
    return NULL;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn,
                               size_t nCategories, const fmi2String categories[])
{
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined,
                               fmi2Real tolerance, fmi2Real startTime,
                               fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    Instance *self = c;
    self->now.start = self->now.variable[TIME] = startTime;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return fmi2OK; }

fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return fmi2OK; }

fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                       fmi2Real value[])
{
    const Instance *self = c;
    return done(self, get(&self->now, vr, nvr, value));
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                       const fmi2Real value[])
{
    Instance *self = c;
    return done(self, set(&self->now, vr, nvr, value));
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint,
                      fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    Instance *self = c;
    advance(&self->now, currentCommunicationPoint + communicationStepSize);
    return fmi2OK;
}

/* Every step is done when its call returns: there is no status to ask for. */
#define NO_STATUS(name, type)                                            \
    fmi2Status name(fmi2Component c, const fmi2StatusKind s, type *value) \
    {                                                                    \
        return fmi2Discard;                                              \
    }

NO_STATUS(fmi2GetStatus, fmi2Status)
NO_STATUS(fmi2GetRealStatus, fmi2Real)
NO_STATUS(fmi2GetIntegerStatus, fmi2Integer)
NO_STATUS(fmi2GetBooleanStatus, fmi2Boolean)
NO_STATUS(fmi2GetStringStatus, fmi2String)

/* Some importers ask for no variable of a type: that much there is. */
#define NO_VARIABLES(name, type)                                                  \
    fmi2Status name(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,   \
                    type value[])                                                 \
    {                                                                             \
        return nvr == 0 ? fmi2OK : refuse(c, #name ": all variables are of Real"); \
    }

{% for way, changed in (("Get", ""), ("Set", "const ")) %}
{% for type in ("Integer", "Boolean", "String") %}
NO_VARIABLES(fmi2@way@@type@, @changed@fmi2@type@)
{% endfor %}
{% endfor %}

/* What an FMU must have, and this one has no use for. */
#define ABSENT(name, ...)                                    \
    fmi2Status name(__VA_ARGS__)                             \
    {                                                        \
        return refuse(c, #name " is not part of this model"); \
    }

ABSENT(fmi2SerializedFMUstateSize, fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
ABSENT(fmi2SerializeFMUstate, fmi2Component c, fmi2FMUstate FMUstate,
       fmi2Byte serializedState[], size_t size)
ABSENT(fmi2DeSerializeFMUstate, fmi2Component c, const fmi2Byte serializedState[],
       size_t size, fmi2FMUstate *FMUstate)
ABSENT(fmi2GetDirectionalDerivative, fmi2Component c,
       const fmi2ValueReference vUnknown_ref[], size_t nUnknown,
       const fmi2ValueReference vKnown_ref[], size_t nKnown, const fmi2Real dvKnown[],
       fmi2Real dvUnknown[])
ABSENT(fmi2SetRealInputDerivatives, fmi2Component c, const fmi2ValueReference vr[],
       size_t nvr, const fmi2Integer order[], const fmi2Real value[])
ABSENT(fmi2GetRealOutputDerivatives, fmi2Component c, const fmi2ValueReference vr[],
       size_t nvr, const fmi2Integer order[], fmi2Real value[])
ABSENT(fmi2CancelStep, fmi2Component c)

{% set fmi, instance, state = "fmi3", "Instance", "State" %}
/* A model of hystbench as an FMU of FMI 3.0 for co-simulation.
 *
 * The FMI headers are the importing tool's.
 */
#define FMI3_FUNCTION_PREFIX @model.name@_
#include "fmi3Functions.h"

typedef fmi3ValueReference Reference;
#include "hb_unit.h"

typedef struct {
    Values now;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} Instance;

static fmi3Status refuse(const Instance *self, const char *why)
{
    if (self->log) self->log(self->environment, fmi3Error, "logStatusError", why);
    return fmi3Error;
}

{% include "fmi_shared.c" %}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
    fmi3Boolean earlyReturnAllowed,
    const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback intermediateUpdate)
{
    Instance *self;
    if (!instantiationToken || strcmp(instantiationToken, TOKEN) != 0) {
        if (logMessage)
            logMessage(instanceEnvironment, fmi3Error, "logStatusError",
                       "the instantiation token is that of another model");
        return NULL;
    }
    self = malloc(sizeof *self);
    if (!self) return NULL;
    begin(&self->now);
    self->environment = instanceEnvironment;
    self->log = logMessage;
    return self;
}

fmi3Instance fmi3InstantiateModelExchange(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn,
    fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage)
{
    return NULL;
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn,
    fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
    fmi3ClockUpdateCallback clockUpdate, fmi3LockPreemptionCallback lockPreemption,
    fmi3UnlockPreemptionCallback unlockPreemption)
{
    return NULL;
}

void fmi3FreeInstance(fmi3Instance instance) { free(instance); }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn,
                               size_t nCategories, const fmi3String categories[])
{
    return fmi3OK;
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance,
                                       fmi3Boolean toleranceDefined,
                                       fmi3Float64 tolerance, fmi3Float64 startTime,
                                       fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    Instance *self = instance;
    self->now.start = self->now.variable[TIME] = startTime;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) { return fmi3OK; }

fmi3Status fmi3EnterEventMode(fmi3Instance instance) { return fmi3OK; }

fmi3Status fmi3EnterStepMode(fmi3Instance instance) { return fmi3OK; }

fmi3Status fmi3Terminate(fmi3Instance instance) { return fmi3OK; }

fmi3Status fmi3GetFloat64(fmi3Instance instance,
                          const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Float64 values[], size_t nValues)
{
    const Instance *self = instance;
    if (nValues != nValueReferences) return refuse(self, "one value a reference");
    return done(self, get(&self->now, valueReferences, nValueReferences, values));
}

fmi3Status fmi3SetFloat64(fmi3Instance instance,
                          const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Float64 values[],
                          size_t nValues)
{
    Instance *self = instance;
    if (nValues != nValueReferences) return refuse(self, "one value a reference");
    return done(self, set(&self->now, valueReferences, nValueReferences, values));
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint,
                      fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                      fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
                      fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    Instance *self = instance;
    const double end = currentCommunicationPoint + communicationStepSize;
    advance(&self->now, end);
    *eventHandlingNeeded = fmi3False;
    *terminateSimulation = fmi3False;
    *earlyReturn = fmi3False;
    *lastSuccessfulTime = end;
    return fmi3OK;
}

/* Some importers ask for no variable of a type: that much there is. */
#define NO_VARIABLES(name, type)                                                      \
    fmi3Status name(fmi3Instance instance, const fmi3ValueReference valueReferences[], \
                    size_t nValueReferences, type values[], size_t nValues)           \
    {                                                                                 \
        return nValueReferences == 0                                                  \
                   ? fmi3OK                                                           \
                   : refuse(instance, #name ": all variables are of Float64");        \
    }

{% for way, changed in (("Get", ""), ("Set", "const ")) %}
{% for type in ("Float32", "Boolean", "String") %}
NO_VARIABLES(fmi3@way@@type@, @changed@fmi3@type@)
{% endfor %}
{% for bits in (8, 16, 32, 64) %}
NO_VARIABLES(fmi3@way@Int@bits@, @changed@fmi3Int@bits@)
NO_VARIABLES(fmi3@way@UInt@bits@, @changed@fmi3UInt@bits@)
{% endfor %}
{% endfor %}

/* What an FMU must have, and this one has no use for. */
#define ABSENT(name, ...)                                             \
    fmi3Status name(__VA_ARGS__)                                      \
    {                                                                 \
        return refuse(instance, #name " is not part of this model");  \
    }

ABSENT(fmi3GetBinary, fmi3Instance instance, const fmi3ValueReference valueReferences[],
       size_t nValueReferences, size_t valueSizes[], fmi3Binary values[], size_t
       nValues)
ABSENT(fmi3GetClock, fmi3Instance instance, const fmi3ValueReference valueReferences[],
       size_t nValueReferences, fmi3Clock values[])
ABSENT(fmi3SetBinary, fmi3Instance instance, const fmi3ValueReference valueReferences[],
       size_t nValueReferences, const size_t valueSizes[], const fmi3Binary values[],
       size_t nValues)
ABSENT(fmi3SetClock, fmi3Instance instance, const fmi3ValueReference valueReferences[],
       size_t nValueReferences, const fmi3Clock values[])
ABSENT(fmi3GetNumberOfVariableDependencies, fmi3Instance instance, fmi3ValueReference
       valueReference, size_t* nDependencies)
ABSENT(fmi3GetVariableDependencies, fmi3Instance instance, fmi3ValueReference dependent,
       size_t elementIndicesOfDependent[], fmi3ValueReference independents[], size_t
       elementIndicesOfIndependents[], fmi3DependencyKind dependencyKinds[], size_t
       nDependencies)
ABSENT(fmi3SerializedFMUStateSize, fmi3Instance instance, fmi3FMUState FMUState, size_t*
       size)
ABSENT(fmi3SerializeFMUState, fmi3Instance instance, fmi3FMUState FMUState, fmi3Byte
       serializedState[], size_t size)
ABSENT(fmi3DeserializeFMUState, fmi3Instance instance, const fmi3Byte serializedState[],
       size_t size, fmi3FMUState* FMUState)
ABSENT(fmi3GetDirectionalDerivative, fmi3Instance instance, const fmi3ValueReference
       unknowns[], size_t nUnknowns, const fmi3ValueReference knowns[], size_t nKnowns,
       const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[], size_t
       nSensitivity)
ABSENT(fmi3GetAdjointDerivative, fmi3Instance instance, const fmi3ValueReference
       unknowns[], size_t nUnknowns, const fmi3ValueReference knowns[], size_t nKnowns,
       const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[], size_t
       nSensitivity)
ABSENT(fmi3EnterConfigurationMode, fmi3Instance instance)
ABSENT(fmi3ExitConfigurationMode, fmi3Instance instance)
ABSENT(fmi3GetIntervalDecimal, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, fmi3Float64 intervals[],
       fmi3IntervalQualifier qualifiers[])
ABSENT(fmi3GetIntervalFraction, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64
       resolutions[], fmi3IntervalQualifier qualifiers[])
ABSENT(fmi3GetShiftDecimal, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, fmi3Float64 shifts[])
ABSENT(fmi3GetShiftFraction, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64
       resolutions[])
ABSENT(fmi3SetIntervalDecimal, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, const fmi3Float64 intervals[])
ABSENT(fmi3SetIntervalFraction, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, const fmi3UInt64 counters[], const
       fmi3UInt64 resolutions[])
ABSENT(fmi3SetShiftDecimal, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, const fmi3Float64 shifts[])
ABSENT(fmi3SetShiftFraction, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, const fmi3UInt64 counters[], const
       fmi3UInt64 resolutions[])
ABSENT(fmi3EvaluateDiscreteStates, fmi3Instance instance)
ABSENT(fmi3UpdateDiscreteStates, fmi3Instance instance, fmi3Boolean*
       discreteStatesNeedUpdate, fmi3Boolean* terminateSimulation, fmi3Boolean*
       nominalsOfContinuousStatesChanged, fmi3Boolean* valuesOfContinuousStatesChanged,
       fmi3Boolean* nextEventTimeDefined, fmi3Float64* nextEventTime)
ABSENT(fmi3EnterContinuousTimeMode, fmi3Instance instance)
ABSENT(fmi3CompletedIntegratorStep, fmi3Instance instance, fmi3Boolean
       noSetFMUStatePriorToCurrentPoint, fmi3Boolean* enterEventMode, fmi3Boolean*
       terminateSimulation)
ABSENT(fmi3SetTime, fmi3Instance instance, fmi3Float64 time)
ABSENT(fmi3SetContinuousStates, fmi3Instance instance, const fmi3Float64
       continuousStates[], size_t nContinuousStates)
ABSENT(fmi3GetContinuousStateDerivatives, fmi3Instance instance, fmi3Float64
       derivatives[], size_t nContinuousStates)
ABSENT(fmi3GetEventIndicators, fmi3Instance instance, fmi3Float64 eventIndicators[],
       size_t nEventIndicators)
ABSENT(fmi3GetContinuousStates, fmi3Instance instance, fmi3Float64 continuousStates[],
       size_t nContinuousStates)
ABSENT(fmi3GetNominalsOfContinuousStates, fmi3Instance instance, fmi3Float64 nominals[],
       size_t nContinuousStates)
ABSENT(fmi3GetNumberOfEventIndicators, fmi3Instance instance, size_t* nEventIndicators)
ABSENT(fmi3GetNumberOfContinuousStates, fmi3Instance instance, size_t*
       nContinuousStates)
ABSENT(fmi3GetOutputDerivatives, fmi3Instance instance, const fmi3ValueReference
       valueReferences[], size_t nValueReferences, const fmi3Int32 orders[], fmi3Float64
       values[], size_t nValues)
ABSENT(fmi3ActivateModelPartition, fmi3Instance instance, fmi3ValueReference
       clockReference, fmi3Float64 activationTime)

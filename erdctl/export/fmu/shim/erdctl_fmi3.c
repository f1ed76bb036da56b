/* FMI 3.0 for co-simulation: the functions of the standard around an instance of the block.
   Types as in section 2.2 of the standard, "Functional Mock-up Interface Specification", version
   3.0. All of its functions are there; those of other interface types and of what modelDescription.xml
   does not offer return an error. */

#include "erdctl_fmu.h"

#include <stdbool.h>
#include <stdint.h>

/* Linked statically, functions carry the model's identifier (section 2.2.1). */
#ifdef FMI3_FUNCTION_PREFIX
#define JOINED(a, b) a##b
#define JOIN(a, b) JOINED(a, b)
#define FMI(name) JOIN(FMI3_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif

/* Declared and defined in one, so that -Wmissing-prototypes has nothing to say. */
#define FUNCTION(name, ...)                     \
    EXPORTED Status FMI(name)(__VA_ARGS__); \
    Status FMI(name)(__VA_ARGS__)

/* One that is not offered, whatever it is given. */
#define NOT_OFFERED(name, ...)                                       \
    FUNCTION(name, void *c, __VA_ARGS__)                             \
    {                                                                \
        return refused((Instance *)c, #name " is not offered"); \
    }

#define AS_MANY "as many values as references are needed"

typedef uint32_t Reference;
typedef const char *String;
typedef void (*Logger)(void *, Status, String, String);
typedef void (*Update)(void *, double, bool, bool, bool, bool, bool *, double *);

#if defined(__GNUC__)
/* What is not offered has no use for what it is given. */
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

EXPORTED String FMI(fmi3GetVersion)(void);
String FMI(fmi3GetVersion)(void)
{
    return "3.0";
}

static void say(const Instance *m, Status status, const char *category, const char *text)
{
    if (m->log != NULL)
        ((Logger)m->log)(m->environment, status, category, text);
}

FUNCTION(fmi3SetDebugLogging, void *c, bool on, size_t n, const String categories[])
{
    ((Instance *)c)->logging = on;
    return OK;
}

EXPORTED void *FMI(fmi3InstantiateCoSimulation)(
    String, String, String, bool, bool, bool, bool, const Reference[], size_t, void *, Logger,
    Update);
void *FMI(fmi3InstantiateCoSimulation)(String name, String token, String resources, bool visible,
                                       bool logging, bool events, bool early,
                                       const Reference intermediate[], size_t intermediates,
                                       void *environment, Logger logger, Update update)
{
    /* Without Event Mode a request for it cannot be met; no variable is known within a step. */
    Instance *m = events || intermediates > 0 ? NULL : make(name, token);

    if (m == NULL) {
        if (logger != NULL)
            logger(environment, ERROR, "logStatusError",
                   "made with the token of another FMU, or for what this one does not offer");
        return NULL;
    }
    m->say = say;
    m->environment = environment;
    m->log = (void (*)(void))logger;
    m->logging = logging;
    return m;
}

EXPORTED void *FMI(fmi3InstantiateModelExchange)(
    String, String, String, bool, bool, void *, Logger);
void *FMI(fmi3InstantiateModelExchange)(String name, String token, String resources, bool visible,
                                        bool logging, void *environment, Logger logger)
{
    return NULL;
}

EXPORTED void *FMI(fmi3InstantiateScheduledExecution)(
    String, String, String, bool, bool, void *, Logger, void (*)(void *), void (*)(void),
    void (*)(void));
void *FMI(fmi3InstantiateScheduledExecution)(String name, String token, String resources,
                                             bool visible, bool logging, void *environment,
                                             Logger logger, void (*clock)(void *),
                                             void (*lock)(void), void (*unlock)(void))
{
    return NULL;
}

EXPORTED void FMI(fmi3FreeInstance)(void *);
void FMI(fmi3FreeInstance)(void *c)
{
    discard((Instance *)c);
}

FUNCTION(fmi3EnterInitializationMode, void *c, bool tolerant, double tolerance, double start_time,
         bool stops, double stop_time)
{
    return begin((Instance *)c, start_time);
}

FUNCTION(fmi3ExitInitializationMode, void *c)
{
    return begun((Instance *)c);
}

FUNCTION(fmi3Terminate, void *c)
{
    ((Instance *)c)->v.phase = TERMINATED;
    return OK;
}

FUNCTION(fmi3Reset, void *c)
{
    put_to_start(&((Instance *)c)->v);
    return OK;
}

FUNCTION(fmi3GetFloat64, void *c, const Reference reference[], size_t n, double value[],
         size_t values)
{
    Status status = OK;
    size_t i;

    if (n != values)
        return refused((Instance *)c, AS_MANY);
    for (i = 0; i < n; i++)
        status = worse(status, get_real((Instance *)c, reference[i], &value[i]));
    return status;
}

FUNCTION(fmi3SetFloat64, void *c, const Reference reference[], size_t n, const double value[],
         size_t values)
{
    Status status = OK;
    size_t i;

    if (n != values)
        return refused((Instance *)c, AS_MANY);
    for (i = 0; i < n; i++)
        status = worse(status, set_real((Instance *)c, reference[i], value[i]));
    return status;
}

#define WHOLE(type, ctype, kind)                                                              \
    FUNCTION(fmi3Get##type, void *c, const Reference reference[], size_t n, ctype value[],    \
             size_t values)                                                                   \
    {                                                                                         \
        Status status = n == values ? OK : refused((Instance *)c, AS_MANY), one;              \
        double y = 0.0;                                                                       \
        size_t i;                                                                             \
                                                                                              \
        for (i = 0; status != ERROR && i < n; i++) {                                          \
            one = get((Instance *)c, reference[i], kind, &y);                                 \
            if (one == OK)                                                                    \
                value[i] = (ctype)y;                                                          \
            status = worse(status, one);                                                      \
        }                                                                                     \
        return status;                                                                        \
    }                                                                                         \
    FUNCTION(fmi3Set##type, void *c, const Reference reference[], size_t n,                   \
             const ctype value[], size_t values)                                              \
    {                                                                                         \
        Status status = n == values ? OK : refused((Instance *)c, AS_MANY);                   \
        size_t i;                                                                             \
                                                                                              \
        for (i = 0; status != ERROR && i < n; i++)                                            \
            status = worse(status, set((Instance *)c, reference[i], kind, (double)value[i])); \
        return status;                                                                        \
    }

WHOLE(Int32, int32_t, 'i')
WHOLE(Boolean, bool, 'b')

/* No variable has any other type: only the question for none of them can be answered. */
#define NO_GETTER(name, type)                                                                  \
    FUNCTION(name, void *c, const Reference reference[], size_t n, type value[], size_t values) \
    {                                                                                          \
        return n == 0 ? OK : refused((Instance *)c, "no variable is of that type");           \
    }
#define NO_SETTER(name, type) NO_GETTER(name, const type)
#define NEITHER(type, ctype) NO_GETTER(fmi3Get##type, ctype) NO_SETTER(fmi3Set##type, ctype)

NEITHER(Float32, float)
NEITHER(Int8, int8_t)
NEITHER(UInt8, uint8_t)
NEITHER(Int16, int16_t)
NEITHER(UInt16, uint16_t)
NEITHER(UInt32, uint32_t)
NEITHER(Int64, int64_t)
NEITHER(UInt64, uint64_t)
NO_GETTER(fmi3GetString, String)
NO_GETTER(fmi3SetString, const String)

FUNCTION(fmi3GetBinary, void *c, const Reference reference[], size_t n, size_t sizes[],
         const uint8_t *value[], size_t values)
{
    return n == 0 ? OK : refused((Instance *)c, "no variable is of that type");
}

FUNCTION(fmi3SetBinary, void *c, const Reference reference[], size_t n, const size_t sizes[],
         const uint8_t *const value[], size_t values)
{
    return n == 0 ? OK : refused((Instance *)c, "no variable is of that type");
}

FUNCTION(fmi3GetFMUState, void *c, void **state)
{
    return save((const Instance *)c, state);
}

FUNCTION(fmi3SetFMUState, void *c, void *state)
{
    return restore((Instance *)c, state);
}

FUNCTION(fmi3FreeFMUState, void *c, void **state)
{
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return OK;
}

FUNCTION(fmi3SerializedFMUStateSize, void *c, void *state, size_t *size)
{
    *size = sizeof(Saved);
    return OK;
}

FUNCTION(fmi3SerializeFMUState, void *c, void *state, uint8_t bytes[], size_t size)
{
    return serialise((const Instance *)c, state, bytes, size);
}

FUNCTION(fmi3DeserializeFMUState, void *c, const uint8_t bytes[], size_t size, void **state)
{
    return deserialise((const Instance *)c, bytes, size, state);
}

FUNCTION(fmi3DoStep, void *c, double t, double h, bool no_return, bool *event, bool *ended,
         bool *early, double *last)
{
    Status status = advance((Instance *)c, t, h);

    *event = *ended = *early = false;
    *last = ((Instance *)c)->v.t;
    return status;
}

NOT_OFFERED(fmi3GetClock, const Reference reference[], size_t n, bool value[])
NOT_OFFERED(fmi3SetClock, const Reference reference[], size_t n, const bool value[])
NOT_OFFERED(fmi3GetNumberOfVariableDependencies, Reference reference, size_t *n)
NOT_OFFERED(fmi3GetVariableDependencies, Reference dependent, size_t of_dependent[],
            Reference independent[], size_t of_independent[], int kind[], size_t n)
NOT_OFFERED(fmi3GetDirectionalDerivative, const Reference unknown[], size_t unknowns,
            const Reference known[], size_t knowns, const double seed[], size_t seeds,
            double value[], size_t values)
NOT_OFFERED(fmi3GetAdjointDerivative, const Reference unknown[], size_t unknowns,
            const Reference known[], size_t knowns, const double seed[], size_t seeds,
            double value[], size_t values)
FUNCTION(fmi3EnterConfigurationMode, void *c)
{
    return refused((Instance *)c, "no structural parameters");
}
FUNCTION(fmi3ExitConfigurationMode, void *c)
{
    return refused((Instance *)c, "no structural parameters");
}
FUNCTION(fmi3EnterEventMode, void *c)
{
    return refused((Instance *)c, "no Event Mode");
}
FUNCTION(fmi3EnterStepMode, void *c)
{
    return refused((Instance *)c, "no Event Mode: it is in Step Mode after initialisation");
}
FUNCTION(fmi3EnterContinuousTimeMode, void *c)
{
    return refused((Instance *)c, "not for model exchange");
}
FUNCTION(fmi3EvaluateDiscreteStates, void *c)
{
    return refused((Instance *)c, "no Event Mode");
}
NOT_OFFERED(fmi3GetIntervalDecimal, const Reference reference[], size_t n, double interval[],
            int qualifier[])
NOT_OFFERED(fmi3GetIntervalFraction, const Reference reference[], size_t n, uint64_t counter[],
            uint64_t resolution[], int qualifier[])
NOT_OFFERED(fmi3GetShiftDecimal, const Reference reference[], size_t n, double shift[])
NOT_OFFERED(fmi3GetShiftFraction, const Reference reference[], size_t n, uint64_t counter[],
            uint64_t resolution[])
NOT_OFFERED(fmi3SetIntervalDecimal, const Reference reference[], size_t n,
            const double interval[])
NOT_OFFERED(fmi3SetIntervalFraction, const Reference reference[], size_t n,
            const uint64_t counter[], const uint64_t resolution[])
NOT_OFFERED(fmi3SetShiftDecimal, const Reference reference[], size_t n, const double shift[])
NOT_OFFERED(fmi3SetShiftFraction, const Reference reference[], size_t n,
            const uint64_t counter[], const uint64_t resolution[])
NOT_OFFERED(fmi3UpdateDiscreteStates, bool *again, bool *ended, bool *nominals, bool *values,
            bool *timed, double *next)
NOT_OFFERED(fmi3CompletedIntegratorStep, bool no_return, bool *event, bool *ended)
NOT_OFFERED(fmi3SetTime, double t)
NOT_OFFERED(fmi3SetContinuousStates, const double state[], size_t n)
NOT_OFFERED(fmi3GetContinuousStateDerivatives, double derivative[], size_t n)
NOT_OFFERED(fmi3GetEventIndicators, double indicator[], size_t n)
NOT_OFFERED(fmi3GetContinuousStates, double state[], size_t n)
NOT_OFFERED(fmi3GetNominalsOfContinuousStates, double nominal[], size_t n)
NOT_OFFERED(fmi3GetNumberOfEventIndicators, size_t *n)
NOT_OFFERED(fmi3GetNumberOfContinuousStates, size_t *n)
NOT_OFFERED(fmi3GetOutputDerivatives, const Reference reference[], size_t n,
            const int32_t order[], double value[], size_t values)
NOT_OFFERED(fmi3ActivateModelPartition, Reference clock, double t)

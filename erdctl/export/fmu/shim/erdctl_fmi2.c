/* FMI 2.0 for co-simulation: the functions of the standard around an instance of the block.
   Types as in section 2.1 of the standard, "Functional Mock-up Interface for Model Exchange and
   Co-Simulation", version 2.0. */

#include "erdctl_fmu.h"

/* Linked statically, functions carry the model's identifier (section 2.1.1). */
#ifdef FMI2_FUNCTION_PREFIX
#define JOINED(a, b) a##b
#define JOIN(a, b) JOINED(a, b)
#define FMI(name) JOIN(FMI2_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif

typedef void (*Logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger logger;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

typedef unsigned int Reference;
typedef int Boolean;
typedef const char *String;

EXPORTED const char *FMI(fmi2GetTypesPlatform)(void);
EXPORTED const char *FMI(fmi2GetVersion)(void);
EXPORTED Status FMI(fmi2SetDebugLogging)(void *, Boolean, size_t, const String[]);
EXPORTED void *FMI(fmi2Instantiate)(
    String, int, String, String, const Callbacks *, Boolean, Boolean);
EXPORTED void FMI(fmi2FreeInstance)(void *);
EXPORTED Status FMI(fmi2SetupExperiment)(void *, Boolean, double, double, Boolean, double);
EXPORTED Status FMI(fmi2EnterInitializationMode)(void *);
EXPORTED Status FMI(fmi2ExitInitializationMode)(void *);
EXPORTED Status FMI(fmi2Terminate)(void *);
EXPORTED Status FMI(fmi2Reset)(void *);
EXPORTED Status FMI(fmi2GetReal)(void *, const Reference[], size_t, double[]);
EXPORTED Status FMI(fmi2GetInteger)(void *, const Reference[], size_t, int[]);
EXPORTED Status FMI(fmi2GetBoolean)(void *, const Reference[], size_t, Boolean[]);
EXPORTED Status FMI(fmi2GetString)(void *, const Reference[], size_t, String[]);
EXPORTED Status FMI(fmi2SetReal)(void *, const Reference[], size_t, const double[]);
EXPORTED Status FMI(fmi2SetInteger)(void *, const Reference[], size_t, const int[]);
EXPORTED Status FMI(fmi2SetBoolean)(void *, const Reference[], size_t, const Boolean[]);
EXPORTED Status FMI(fmi2SetString)(void *, const Reference[], size_t, const String[]);
EXPORTED Status FMI(fmi2GetFMUstate)(void *, void **);
EXPORTED Status FMI(fmi2SetFMUstate)(void *, void *);
EXPORTED Status FMI(fmi2FreeFMUstate)(void *, void **);
EXPORTED Status FMI(fmi2SerializedFMUstateSize)(void *, void *, size_t *);
EXPORTED Status FMI(fmi2SerializeFMUstate)(void *, void *, char[], size_t);
EXPORTED Status FMI(fmi2DeSerializeFMUstate)(void *, const char[], size_t, void **);
EXPORTED Status FMI(fmi2GetDirectionalDerivative)(
    void *, const Reference[], size_t, const Reference[], size_t, const double[], double[]);
EXPORTED Status FMI(fmi2SetRealInputDerivatives)(
    void *, const Reference[], size_t, const int[], const double[]);
EXPORTED Status FMI(fmi2GetRealOutputDerivatives)(
    void *, const Reference[], size_t, const int[], double[]);
EXPORTED Status FMI(fmi2DoStep)(void *, double, double, Boolean);
EXPORTED Status FMI(fmi2CancelStep)(void *);
EXPORTED Status FMI(fmi2GetStatus)(void *, int, int *);
EXPORTED Status FMI(fmi2GetRealStatus)(void *, int, double *);
EXPORTED Status FMI(fmi2GetIntegerStatus)(void *, int, int *);
EXPORTED Status FMI(fmi2GetBooleanStatus)(void *, int, Boolean *);
EXPORTED Status FMI(fmi2GetStringStatus)(void *, int, String *);

const char *FMI(fmi2GetTypesPlatform)(void)
{
    return "default";
}

const char *FMI(fmi2GetVersion)(void)
{
    return "2.0";
}

static void say(const Instance *m, Status status, const char *category, const char *text)
{
    const Callbacks *callbacks = (const Callbacks *)m->callbacks;

    if (callbacks != NULL && callbacks->logger != NULL)
        callbacks->logger(callbacks->environment, m->name, (int)status, category, "%s", text);
}

Status FMI(fmi2SetDebugLogging)(void *c, Boolean on, size_t n, const String categories[])
{
    (void)n, (void)categories;
    ((Instance *)c)->logging = on;
    return OK;
}

void *FMI(fmi2Instantiate)(String name, int type, String token, String resources,
                           const Callbacks *callbacks, Boolean visible, Boolean logging)
{
    enum { CO_SIMULATION = 1 };
    Instance *m = type == CO_SIMULATION ? make(name, token) : NULL;

    (void)resources, (void)visible;
    if (m == NULL) {
        if (callbacks != NULL && callbacks->logger != NULL)
            callbacks->logger(callbacks->environment, name, ERROR, "logStatusError", "%s",
                              "not for co-simulation, or with the GUID of another FMU");
        return NULL;
    }
    m->say = say;
    m->callbacks = callbacks;
    m->logging = logging;
    return m;
}

void FMI(fmi2FreeInstance)(void *c)
{
    discard((Instance *)c);
}

Status FMI(fmi2SetupExperiment)(void *c, Boolean tolerant, double tolerance, double start_time,
                                Boolean stops, double stop_time)
{
    (void)tolerant, (void)tolerance, (void)stops, (void)stop_time;
    ((Instance *)c)->v.t = start_time;
    ((Instance *)c)->v.stale = 1;
    return OK;
}

Status FMI(fmi2EnterInitializationMode)(void *c)
{
    return begin((Instance *)c, ((Instance *)c)->v.t);
}

Status FMI(fmi2ExitInitializationMode)(void *c)
{
    return begun((Instance *)c);
}

Status FMI(fmi2Terminate)(void *c)
{
    ((Instance *)c)->v.phase = TERMINATED;
    return OK;
}

Status FMI(fmi2Reset)(void *c)
{
    put_to_start(&((Instance *)c)->v);
    return OK;
}

Status FMI(fmi2GetReal)(void *c, const Reference reference[], size_t n, double value[])
{
    Status status = OK;
    size_t i;

    for (i = 0; i < n; i++)
        status = worse(status, get_real((Instance *)c, reference[i], &value[i]));
    return status;
}

static Status get_whole(void *c, const Reference reference[], size_t n, char kind, int value[])
{
    Status status = OK, one;
    double y = 0.0;
    size_t i;

    for (i = 0; i < n; i++) {
        one = get((Instance *)c, reference[i], kind, &y);
        if (one == OK)
            value[i] = (int)y;
        status = worse(status, one);
    }
    return status;
}

Status FMI(fmi2GetInteger)(void *c, const Reference reference[], size_t n, int value[])
{
    return get_whole(c, reference, n, 'i', value);
}

Status FMI(fmi2GetBoolean)(void *c, const Reference reference[], size_t n, Boolean value[])
{
    return get_whole(c, reference, n, 'b', value);
}

static Status none(void *c, size_t n)
{
    return n == 0 ? OK : refused((Instance *)c, "there is no such variable");
}

Status FMI(fmi2GetString)(void *c, const Reference reference[], size_t n, String value[])
{
    (void)reference, (void)value;
    return none(c, n);
}

Status FMI(fmi2SetReal)(void *c, const Reference reference[], size_t n, const double value[])
{
    Status status = OK;
    size_t i;

    for (i = 0; i < n; i++)
        status = worse(status, set_real((Instance *)c, reference[i], value[i]));
    return status;
}

static Status set_whole(void *c, const Reference reference[], size_t n, char kind,
                        const int value[])
{
    Status status = OK;
    size_t i;

    for (i = 0; i < n; i++)
        status = worse(status, set((Instance *)c, reference[i], kind, (double)value[i]));
    return status;
}

Status FMI(fmi2SetInteger)(void *c, const Reference reference[], size_t n, const int value[])
{
    return set_whole(c, reference, n, 'i', value);
}

Status FMI(fmi2SetBoolean)(void *c, const Reference reference[], size_t n, const Boolean value[])
{
    return set_whole(c, reference, n, 'b', value);
}

Status FMI(fmi2SetString)(void *c, const Reference reference[], size_t n, const String value[])
{
    (void)reference, (void)value;
    return none(c, n);
}

Status FMI(fmi2GetFMUstate)(void *c, void **state)
{
    return save((const Instance *)c, state);
}

Status FMI(fmi2SetFMUstate)(void *c, void *state)
{
    return restore((Instance *)c, state);
}

Status FMI(fmi2FreeFMUstate)(void *c, void **state)
{
    (void)c;
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return OK;
}

Status FMI(fmi2SerializedFMUstateSize)(void *c, void *state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(Saved);
    return OK;
}

Status FMI(fmi2SerializeFMUstate)(void *c, void *state, char bytes[], size_t size)
{
    return serialise((const Instance *)c, state, bytes, size);
}

Status FMI(fmi2DeSerializeFMUstate)(void *c, const char bytes[], size_t size, void **state)
{
    return deserialise((const Instance *)c, bytes, size, state);
}

Status FMI(fmi2GetDirectionalDerivative)(void *c, const Reference unknown[], size_t unknowns,
                                         const Reference known[], size_t knowns,
                                         const double seed[], double value[])
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)seed, (void)value;
    return refused((Instance *)c, "no directional derivatives");
}

static Status set_slope(Instance *m, unsigned int reference, int order, double value)
{
    if (input_at(&m->v, reference) == NULL || order != 1)
        return refused(m, "only the first derivative of an input can be set");
    m->v.slope[reference - 1] = value;
    return OK;
}

Status FMI(fmi2SetRealInputDerivatives)(void *c, const Reference reference[], size_t n,
                                        const int order[], const double value[])
{
    Status status = OK;
    size_t i;

    for (i = 0; i < n; i++)
        status = worse(status, set_slope((Instance *)c, reference[i], order[i], value[i]));
    return status;
}

Status FMI(fmi2GetRealOutputDerivatives)(void *c, const Reference reference[], size_t n,
                                         const int order[], double value[])
{
    (void)reference, (void)order, (void)value;
    return none(c, n);
}

Status FMI(fmi2DoStep)(void *c, double t, double h, Boolean no_return)
{
    (void)no_return;
    return advance((Instance *)c, t, h);
}

Status FMI(fmi2CancelStep)(void *c)
{
    return refused((Instance *)c, "a step is done when fmi2DoStep returns");
}

Status FMI(fmi2GetStatus)(void *c, int kind, int *value)
{
    (void)c, (void)kind, (void)value;
    return DISCARD;
}

Status FMI(fmi2GetRealStatus)(void *c, int kind, double *value)
{
    enum { LAST_SUCCESSFUL_TIME = 2 };

    if (kind != LAST_SUCCESSFUL_TIME)
        return DISCARD;
    *value = ((Instance *)c)->v.t;
    return OK;
}

Status FMI(fmi2GetIntegerStatus)(void *c, int kind, int *value)
{
    (void)c, (void)kind, (void)value;
    return DISCARD;
}

Status FMI(fmi2GetBooleanStatus)(void *c, int kind, Boolean *value)
{
    enum { ENDED = 3 };

    (void)c;
    if (kind != ENDED)
        return DISCARD;
    *value = 0;
    return OK;
}

Status FMI(fmi2GetStringStatus)(void *c, int kind, String *value)
{
    (void)c, (void)kind, (void)value;
    return DISCARD;
}

/* A master that links the FMU of a damper statically and calls every function of FMI 2.0. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(fact)                                        \
    do {                                                   \
        if (!(fact)) {                                     \
            printf("line %d: %s\n", __LINE__, #fact);      \
            exit(1);                                       \
        }                                                  \
    } while (0)

enum { OK, WARNING, DISCARD, ERROR };
enum { X = 1, XDOT = 2, DUTY = 3, FORCE = 7, STATUS = 8, FIRST = 9, COMPRESSING = 19, REST = 20 };

typedef unsigned int Reference;
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

const char *damper_fmi2GetTypesPlatform(void);
const char *damper_fmi2GetVersion(void);
int damper_fmi2SetDebugLogging(void *, int, size_t, const char *const[]);
void *damper_fmi2Instantiate(const char *, int, const char *, const char *, const Callbacks *, int,
                             int);
void damper_fmi2FreeInstance(void *);
int damper_fmi2SetupExperiment(void *, int, double, double, int, double);
int damper_fmi2EnterInitializationMode(void *);
int damper_fmi2ExitInitializationMode(void *);
int damper_fmi2Terminate(void *);
int damper_fmi2Reset(void *);
int damper_fmi2GetReal(void *, const Reference[], size_t, double[]);
int damper_fmi2GetInteger(void *, const Reference[], size_t, int[]);
int damper_fmi2GetBoolean(void *, const Reference[], size_t, int[]);
int damper_fmi2GetString(void *, const Reference[], size_t, const char *[]);
int damper_fmi2SetReal(void *, const Reference[], size_t, const double[]);
int damper_fmi2SetInteger(void *, const Reference[], size_t, const int[]);
int damper_fmi2SetBoolean(void *, const Reference[], size_t, const int[]);
int damper_fmi2SetString(void *, const Reference[], size_t, const char *const[]);
int damper_fmi2GetFMUstate(void *, void **);
int damper_fmi2SetFMUstate(void *, void *);
int damper_fmi2FreeFMUstate(void *, void **);
int damper_fmi2SerializedFMUstateSize(void *, void *, size_t *);
int damper_fmi2SerializeFMUstate(void *, void *, char[], size_t);
int damper_fmi2DeSerializeFMUstate(void *, const char[], size_t, void **);
int damper_fmi2GetDirectionalDerivative(void *, const Reference[], size_t, const Reference[],
                                        size_t, const double[], double[]);
int damper_fmi2SetRealInputDerivatives(void *, const Reference[], size_t, const int[],
                                       const double[]);
int damper_fmi2GetRealOutputDerivatives(void *, const Reference[], size_t, const int[], double[]);
int damper_fmi2DoStep(void *, double, double, int);
int damper_fmi2CancelStep(void *);
int damper_fmi2GetStatus(void *, int, int *);
int damper_fmi2GetRealStatus(void *, int, double *);
int damper_fmi2GetIntegerStatus(void *, int, int *);
int damper_fmi2GetBooleanStatus(void *, int, int *);
int damper_fmi2GetStringStatus(void *, int, const char **);

static int said;

static void listen(void *environment, const char *name, int status, const char *category,
                   const char *text, ...)
{
    (void)environment, (void)name, (void)category, (void)text;
    said = status;
}

static double force(void *c)
{
    const Reference where = FORCE;
    double value = NAN;

    CHECK(damper_fmi2GetReal(c, &where, 1, &value) == OK);
    CHECK(isfinite(value));
    return value;
}

static int moved(void *c, int i, double x)
{
    const Reference where[3] = {X, XDOT, DUTY};
    const double values[3] = {x, 0.1 * cos(0.1 * i), 0.3};

    CHECK(damper_fmi2SetReal(c, where, 3, values) == OK);
    return damper_fmi2DoStep(c, 1e-3 * i, 1e-3, 1);
}

int main(void)
{
    const Callbacks callbacks = {listen, NULL, NULL, NULL, NULL};
    const Reference none = 999, first = FIRST, x = X, status = STATUS, rest = REST,
                    compressing = COMPRESSING;
    const int one = 1, two = 2;
    const double nan_ = NAN, big = 1e300, slope = 1.0;
    double value = 0.0, expected;
    int whole = 0, i;
    const char *text = NULL;
    char *bytes;
    size_t size = 0;
    void *c, *state = NULL, *other = NULL;

    CHECK(strcmp(damper_fmi2GetTypesPlatform(), "default") == 0);
    CHECK(strcmp(damper_fmi2GetVersion(), "2.0") == 0);
    CHECK(damper_fmi2Instantiate("one", 1, "{other}", "", &callbacks, 0, 1) == NULL);
    CHECK(said == ERROR);
    CHECK(damper_fmi2Instantiate("one", 0, GUID, "", &callbacks, 0, 1) == NULL);
    c = damper_fmi2Instantiate("one", 1, GUID, "", &callbacks, 0, 1);
    CHECK(c != NULL);
    CHECK(damper_fmi2SetDebugLogging(c, 1, 0, NULL) == OK);
    CHECK(damper_fmi2SetInteger(c, &rest, 1, &two) == DISCARD);
    CHECK(damper_fmi2SetInteger(c, &rest, 1, &one) == OK);
    CHECK(damper_fmi2GetInteger(c, &rest, 1, &whole) == OK && whole == 1);
    CHECK(damper_fmi2SetBoolean(c, &compressing, 1, &one) == OK);
    CHECK(damper_fmi2GetBoolean(c, &compressing, 1, &whole) == OK && whole == 1);
    CHECK(damper_fmi2SetupExperiment(c, 0, 0.0, 2.0, 0, 0.0) == OK);
    CHECK(damper_fmi2EnterInitializationMode(c) == OK);
    CHECK(damper_fmi2EnterInitializationMode(c) == ERROR);
    (void)force(c);
    CHECK(damper_fmi2ExitInitializationMode(c) == OK);
    for (i = 1; i < 50; i++)
        CHECK(moved(c, i, 1e-4 * i) == OK);

    /* A state, twice into the same memory; in bytes, and back. */
    CHECK(damper_fmi2GetFMUstate(c, &state) == OK && damper_fmi2GetFMUstate(c, &state) == OK);
    CHECK(moved(c, 50, 0.005) == OK);
    expected = force(c);
    CHECK(damper_fmi2SerializedFMUstateSize(c, state, &size) == OK);
    bytes = (char *)malloc(size);
    CHECK(bytes != NULL);
    CHECK(damper_fmi2SerializeFMUstate(c, state, bytes, size - 1) == ERROR);
    CHECK(damper_fmi2SerializeFMUstate(c, state, bytes, size) == OK);
    CHECK(damper_fmi2DeSerializeFMUstate(c, bytes, size - 1, &other) == ERROR);
    CHECK(damper_fmi2DeSerializeFMUstate(c, bytes, size, &other) == OK);
    CHECK(damper_fmi2SetFMUstate(c, NULL) == ERROR);
    CHECK(damper_fmi2SetFMUstate(c, other) == OK);
    CHECK(moved(c, 50, 0.005) == OK);
    value = force(c);
    CHECK(memcmp(&value, &expected, sizeof value) == 0);
    free(bytes);
    CHECK(damper_fmi2FreeFMUstate(c, &state) == OK && state == NULL);
    CHECK(damper_fmi2FreeFMUstate(c, &state) == OK);
    CHECK(damper_fmi2FreeFMUstate(c, &other) == OK);

    /* What makes no sense. */
    CHECK(damper_fmi2GetReal(c, &none, 1, &value) == ERROR);
    CHECK(damper_fmi2SetReal(c, &none, 1, &value) == ERROR);
    CHECK(damper_fmi2GetReal(c, &status, 1, &value) == ERROR);
    CHECK(damper_fmi2GetInteger(c, &none, 1, &whole) == ERROR);
    CHECK(damper_fmi2GetInteger(c, &x, 1, &whole) == ERROR);
    CHECK(damper_fmi2GetBoolean(c, &status, 1, &whole) == ERROR);
    CHECK(damper_fmi2SetInteger(c, &rest, 1, &one) == ERROR);
    CHECK(damper_fmi2SetReal(c, &first, 1, &nan_) == DISCARD);
    CHECK(damper_fmi2SetReal(c, &first, 1, &big) == DISCARD);
    CHECK(damper_fmi2GetString(c, &x, 1, &text) == ERROR);
    CHECK(damper_fmi2SetString(c, &x, 1, (const char *const *)&text) == ERROR);
    CHECK(damper_fmi2GetString(c, &x, 0, &text) == OK);
    CHECK(damper_fmi2SetRealInputDerivatives(c, &x, 1, &two, &slope) == ERROR);
    CHECK(damper_fmi2SetRealInputDerivatives(c, &first, 1, &one, &slope) == ERROR);
    CHECK(damper_fmi2SetRealInputDerivatives(c, &x, 1, &one, &slope) == OK);
    CHECK(damper_fmi2GetRealOutputDerivatives(c, &x, 1, &one, &value) == ERROR);
    CHECK(damper_fmi2GetDirectionalDerivative(c, &x, 1, &x, 1, &slope, &value) == ERROR);
    CHECK(damper_fmi2CancelStep(c) == ERROR);
    CHECK(damper_fmi2GetStatus(c, 0, &whole) == DISCARD);
    CHECK(damper_fmi2GetRealStatus(c, 2, &value) == OK && fabs(value - 0.051) < 1e-9);
    CHECK(damper_fmi2GetRealStatus(c, 0, &value) == DISCARD);
    CHECK(damper_fmi2GetIntegerStatus(c, 0, &whole) == DISCARD);
    CHECK(damper_fmi2GetBooleanStatus(c, 3, &whole) == OK && whole == 0);
    CHECK(damper_fmi2GetStringStatus(c, 1, &text) == DISCARD);

    /* Bad input: the last force, a warning that is told once, and on from there. */
    CHECK(moved(c, 51, 0.005) == OK);
    expected = force(c);
    said = OK;
    CHECK(moved(c, 52, NAN) == WARNING && said == WARNING);
    said = OK;
    CHECK(moved(c, 53, INFINITY) == WARNING && said == OK);
    CHECK(damper_fmi2GetInteger(c, &status, 1, &whole) == OK && whole != 0);
    value = force(c);
    CHECK(memcmp(&value, &expected, sizeof value) == 0);
    CHECK(damper_fmi2DoStep(c, 0.0, 0.0, 1) == WARNING);
    CHECK(damper_fmi2DoStep(c, NAN, -1.0, 1) == WARNING);
    (void)force(c);
    CHECK(moved(c, 54, 0.005) == OK);

    CHECK(damper_fmi2Terminate(c) == OK);
    CHECK(damper_fmi2DoStep(c, 0.0, 1e-3, 1) == ERROR);
    CHECK(damper_fmi2Reset(c) == OK);
    damper_fmi2FreeInstance(c);
    damper_fmi2FreeInstance(NULL);
    /* Neither name nor callbacks. */
    c = damper_fmi2Instantiate(NULL, 1, GUID, NULL, NULL, 0, 1);
    CHECK(c != NULL && damper_fmi2CancelStep(c) == ERROR);
    damper_fmi2FreeInstance(c);
    puts("ok");
    return 0;
}

/* What FMI 2.0 and 3.0 share: an instance of the block, its variables by value reference, its steps.

   Value references: 0 is time, then the inputs, the outputs, what is watched, the parameters, and
   what says how it begins, in the order in which erdctl_block.h has them.

   A step: the inputs as set hold at its END, where the outputs are those of the block. The outputs
   after initialisation are those of the first sample, at the start time. Before that every question
   for an output is answered from a block that is started anew, so that inputs and parameters may be
   set in any order.

   Memory of an instance is allocated once, when it is made; a step allocates nothing. */

#ifndef ERDCTL_FMU_H
#define ERDCTL_FMU_H

#include "erdctl_block.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

/* The codes of both versions of FMI. */
typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;
typedef enum { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED } Phase;

/* All that changes: copied, it is the FMU state. No pointers. */
typedef struct {
    BlockParams p;
    BlockState s;
    double u[INPUTS];
    double slope[INPUTS]; /* of the inputs over the next step, 0 if none was given [unit/s] */
    double y[OUTPUTS];
    double z[INITIAL + 1]; /* how it begins */
    double t; /* communication point [s] */
    int stale; /* y does not belong to u and p (before the first step only) */
    int status; /* that of the block at its last sample */
    Phase phase;
} Values;

typedef struct Instance {
    Values v;
    void (*say)(const struct Instance *m, Status status, const char *category, const char *text);
    const void *callbacks; /* of FMI 2.0 */
    void *environment;
    void (*log)(void); /* of FMI 3.0, cast to its type where it is called */
    int logging;
    char *name;
} Instance;

/* A state apart from its instance, and the first bytes of a serialised one. */
typedef struct {
    char token[sizeof TOKEN];
    Values v;
} Saved;

static Status complain(const Instance *m, Status status, const char *text)
{
    static const char *const CATEGORY[] = {
        "logAll", "logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal"};

    if (m->logging)
        m->say(m, status, CATEGORY[status], text);
    return status;
}

static Status refused(const Instance *m, const char *what)
{
    return complain(m, ERROR, what);
}

static void put_to_start(Values *v)
{
    size_t i;

    memset(v, 0, sizeof *v);
    block_defaults(&v->p);
    for (i = 0; i < INPUTS; i++)
        v->u[i] = INPUT_START[i];
    for (i = 0; i < INITIAL; i++)
        v->z[i] = INITIAL_VALUE[i].start;
    v->stale = 1;
    v->phase = INSTANTIATED;
}

static Instance *make(const char *name, const char *token)
{
    Instance *m;
    size_t length = name == NULL ? 0 : strlen(name);

    if (token == NULL || strcmp(token, TOKEN) != 0)
        return NULL;
    m = (Instance *)calloc(1, sizeof *m);
    if (m == NULL)
        return NULL;
    m->name = (char *)calloc(length + 1, 1);
    if (m->name == NULL) {
        free(m);
        return NULL;
    }
    if (length > 0)
        memcpy(m->name, name, length);
    put_to_start(&m->v);
    return m;
}

static void discard(Instance *m)
{
    if (m == NULL)
        return;
    free(m->name);
    free(m);
}

/* What the block says of its last sample; logged when it changes, not at every step. */
static Status judged(Instance *m)
{
    int before = m->v.status;
    const char *text;

    m->v.status = block_status(&m->v.s);
    if (m->v.status == 0)
        return OK;
    text = block_words(m->v.status);
    if (m->v.status != before)
        return complain(m, WARNING, text);
    return WARNING;
}

static Status start(Instance *m)
{
    block_init(&m->v.s, &m->v.p);
    block_begin(&m->v.s, m->v.t, m->v.z);
    block_step(&m->v.s, 0.0, m->v.u, m->v.y);
    m->v.stale = 0;
    return judged(m);
}

static Status begin(Instance *m, double t)
{
    if (m->v.phase != INSTANTIATED)
        return refused(m, "initialisation was entered before");
    m->v.t = t;
    m->v.stale = 1;
    m->v.phase = INITIALIZING;
    return OK;
}

static Status begun(Instance *m)
{
    Status status;

    if (m->v.phase != INITIALIZING)
        return refused(m, "initialisation was not entered");
    status = start(m);
    m->v.phase = STEPPING;
    return status;
}

static Status advance(Instance *m, double t, double h)
{
    Values *v = &m->v;
    double u[INPUTS];
    size_t i;

    if (v->phase != STEPPING)
        return refused(m, "a step needs an instance that is initialised and not terminated");
    for (i = 0; i < INPUTS; i++) {
        u[i] = v->slope[i] == 0.0 ? v->u[i] : v->u[i] + v->slope[i] * h;
        v->slope[i] = 0.0;
    }
    block_step(&v->s, h, u, v->y);
    if (isfinite(t) && isfinite(h) && h > 0.0)
        v->t = t + h;
    return judged(m);
}

static double *input_at(Values *v, unsigned int reference)
{
    return reference >= 1 && reference <= INPUTS ? &v->u[reference - 1] : NULL;
}

/* Place of a parameter in BlockParams; PARAMETERS if the reference is not one. */
static size_t parameter_at(unsigned int reference)
{
    unsigned int first = 1 + INPUTS + OUTPUTS;

    return reference >= first && reference - first < PARAMETERS ? reference - first : PARAMETERS;
}

static block_real *parameter(BlockParams *p, size_t i)
{
    return (block_real *)(void *)((char *)p + PARAMETER[i].at);
}

/* Place of a value that says how the block begins; INITIAL if the reference is not one. */
static size_t initial_at(unsigned int reference, char kind)
{
    unsigned int first = 1 + INPUTS + OUTPUTS + PARAMETERS;
    size_t i = reference >= first ? reference - first : INITIAL;

    return i < INITIAL && INITIAL_VALUE[i].kind == kind ? i : INITIAL;
}

/* The value of what has the given kind, which is neither input nor parameter. */
static Status get(Instance *m, unsigned int reference, char kind, double *value)
{
    size_t i = (size_t)reference - 1 - INPUTS, z = initial_at(reference, kind);

    if (z < INITIAL) {
        *value = m->v.z[z];
        return OK;
    }
    if (reference <= INPUTS || i >= OUTPUTS || OUTPUT_KIND[i] != kind)
        return refused(m, "no variable of this type has that value reference");
    if (m->v.stale)
        (void)start(m);
    *value = m->v.y[i];
    return OK;
}

static Status get_real(Instance *m, unsigned int reference, double *value)
{
    size_t i = parameter_at(reference);
    const double *u = input_at(&m->v, reference);

    if (reference == 0)
        *value = m->v.t;
    else if (u != NULL)
        *value = *u;
    else if (i < PARAMETERS)
        *value = (double)*parameter(&m->v.p, i);
    else
        return get(m, reference, 'r', value);
    return OK;
}

static Status beyond(const Instance *m)
{
    return complain(m, DISCARD, "a value beyond its bounds, or not finite: not taken");
}

static Status set(Instance *m, unsigned int reference, char kind, double value)
{
    size_t i = initial_at(reference, kind);

    if (i == INITIAL)
        return refused(m, "nothing of this type that can be set has that value reference");
    if (m->v.phase >= STEPPING)
        return refused(m, "how it begins can only be set before it does");
    if (!(value >= INITIAL_VALUE[i].low && value <= INITIAL_VALUE[i].high))
        return beyond(m);
    m->v.z[i] = value;
    m->v.stale = 1;
    return OK;
}

static Status set_real(Instance *m, unsigned int reference, double value)
{
    Values *v = &m->v;
    size_t i = parameter_at(reference);
    double *u = input_at(v, reference);

    if (u != NULL) {
        *u = value;
    } else if (i < PARAMETERS) {
        /* NaN fails both comparisons. */
        if (!(value >= PARAMETER[i].low && value <= PARAMETER[i].high))
            return beyond(m);
        *parameter(&v->p, i) = (block_real)value;
        if (v->phase == STEPPING)
            block_retune(&v->s, &v->p);
    } else {
        return set(m, reference, 'r', value);
    }
    if (v->phase < STEPPING)
        v->stale = 1;
    return OK;
}

static Status save(const Instance *m, void **state)
{
    Saved *saved = (Saved *)*state;

    if (saved == NULL)
        saved = (Saved *)calloc(1, sizeof *saved);
    if (saved == NULL)
        return refused(m, "out of memory");
    memcpy(saved->token, TOKEN, sizeof TOKEN);
    saved->v = m->v;
    *state = saved;
    return OK;
}

static Status restore(Instance *m, const void *state)
{
    if (state == NULL)
        return refused(m, "no state was given");
    m->v = ((const Saved *)state)->v;
    return OK;
}

static Status serialise(const Instance *m, const void *state, void *bytes, size_t size)
{
    if (state == NULL || size < sizeof(Saved))
        return refused(m, "no state was given, or too few bytes to hold it");
    memcpy(bytes, state, sizeof(Saved));
    return OK;
}

static Status deserialise(const Instance *m, const void *bytes, size_t size, void **state)
{
    Saved *saved = (Saved *)*state;

    /* Another block's state, or that of another model, would be read as nonsense. */
    if (size != sizeof(Saved) || memcmp(bytes, TOKEN, sizeof TOKEN) != 0)
        return refused(m, "these bytes are not a state of this FMU");
    if (saved == NULL)
        saved = (Saved *)malloc(sizeof *saved);
    if (saved == NULL)
        return refused(m, "out of memory");
    memcpy(saved, bytes, sizeof *saved);
    *state = saved;
    return OK;
}

static Status worse(Status a, Status b)
{
    return a > b ? a : b;
}

#endif

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "PREFIX.h"

typedef PREFIX_real real;
typedef PREFIX_state State;

#define K(number) ((real)(number))
#ifdef ERDCTL_FLOAT
#define EXP expf
#define EXPM1 expm1f
#define LOG1P log1pf
#define LOG logf
#define POW powf
#define TANH tanhf
#define SIN sinf
#define COS cosf
#define SQRT sqrtf
#define FABS fabsf
#define FLOOR floorf
#define FMIN fminf
#define FMAX fmaxf
#define COPYSIGN copysignf
#else
#define EXP exp
#define EXPM1 expm1
#define LOG1P log1p
#define LOG log
#define POW pow
#define TANH tanh
#define SIN sin
#define COS cos
#define SQRT sqrt
#define FABS fabs
#define FLOOR floor
#define FMIN fmin
#define FMAX fmax
#define COPYSIGN copysign
#endif

/* Motion and control at a sample, and at the one before; see PREFIX_step. */
typedef struct Sample {
    struct PREFIX_state *keeper; /* whose long memories are used: its own, or of whom it is a copy */
    int first;               /* nothing lies before it */
    int ahead;               /* a law is asked for the step that begins here */
    int rests;               /* the first sample begins at rest */
    int up, up0;             /* direction whose parameters apply, now and before */
    int turned;              /* it changed in this step */
    real h, t, clock;        /* [s] step before it, time since the first, time of the record */
    real clock_low;          /* [s] to be taken off the last, which its digits do not hold */
    real x, xdot, duty;      /* [m], [m/s] of the piston, [1] from now on */
    real x0, xdot0, duty0;   /* at the sample before; duty0 acted over the step */
    real before;             /* [1] part of the step before the turn */
    real sign, engaged;      /* [1] */
    real share;              /* [1] part of the sample that belongs to compression */
    real path, after;        /* [m] travel in the step, and after the turn in it */
} Sample;

/* Motion that a law of the joint alters; joint: a part of the samples is engaged. */
typedef struct Motion {
    real x, xdot, engaged;
    int joint;
} Motion;

/* Forces [N], or factors [1], of the groups of Eq. 13. */
typedef struct Groups {
    real gas, viscous, yield;
} Groups;

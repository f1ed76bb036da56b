#include <math.h>
#include "PREFIX.h"

typedef PREFIX_real real;
typedef PREFIX_params Params;
typedef PREFIX_state State;

#define K(number) ((real)(number))
#ifdef ERDCTL_FLOAT
#define EXPM1 expm1f
#define POW powf
#define FABS fabsf
#define FLOOR floorf
#define CEIL ceilf
#define RINT rintf
#define EQUAL K(1e-5) /* part of a time or of a step by which two differ by rounding only */
#else
#define EXPM1 expm1
#define POW pow
#define FABS fabs
#define FLOOR floor
#define CEIL ceil
#define RINT rint
#define EQUAL K(1e-9)
#endif

#define LARGEST K(1e6)     /* of any input: more is no measurement */
#define SHORTEST K(1e-9)   /* [s] of any step */
#define BAD_STEPS 8        /* calls in a row without a usable dt, after which the output is 0 */
#define STRAYED K(5e-3)    /* [m] travel between a standing signal and one that moves */
#define SECANTS 4          /* towards a duty between two that are near each other */
#define ON_GRID K(1e-6)    /* of a step of the resolution: a given duty this near is on it */

/* False for NaN as well. */
static int within(real value, real low, real high)
{
    return value >= low && value <= high;
}

static real clamped(real value, real low, real high)
{
    return value < low ? low : value > high ? high : value;
}

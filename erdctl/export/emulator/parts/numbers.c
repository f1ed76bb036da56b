
typedef PREFIX_params Settings;
typedef PREFIX_state Emulator;

#ifdef ERDCTL_FLOAT
#define CEIL ceilf
#define RINT rintf
#define EQUAL K(1e-5) /* part of a time or of a step by which two differ by rounding only */
#else
#define CEIL ceil
#define RINT rint
#define EQUAL K(1e-9)
#endif

#define LARGEST K(1e6)     /* of any input: more is no measurement */
#define SHORTEST K(1e-9)   /* [s] of any step */
#define BAD_STEPS 8        /* calls in a row without a usable dt, after which the output is 0 */
#define STRAYED K(5e-3)    /* [m] travel between a standing signal and one that moves */
/* Of the time that a slewing amplifier needs from 0 to its highest duty: the target is to be met in
   so much at least, or it would sweep to and fro after every force that one step does not reach. */
#define SWEEP K(0.1)
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

static int positive(real value, real most)
{
    return within(value, K(0.0), most);
}

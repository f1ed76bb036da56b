@DAMPER@#ifndef @GUARD@
#define @GUARD@

#ifdef __cplusplus
extern "C" {
#endif

@REAL@

/* May be changed between steps; what cannot be used closes the output (PREFIX_PARAMETER). */
typedef struct PREFIX_params {
@MEMBERS@
} PREFIX_params;

/* What was wrong with the inputs of a step, or why the output is closed: any of these, added. */
enum {
    PREFIX_OK = 0,
    PREFIX_INPUT = 1,     /* x, xdot or duty not finite, or beyond 1e6: the last duty is held, for
                             one update period at most (one sample at least), then it goes to 0 */
    PREFIX_STEP = 2,      /* dt not finite, 0, negative, or below 1e-9 s: no time has passed, nothing changes. After
                             8 such calls in a row nobody knows the time: the output is 0 at once,
                             whatever the slew limit says */
    PREFIX_DUTY = 4,      /* duty outside 0..1: the nearer end is taken */
    PREFIX_HOT = 8,       /* above the temperature limit, or the temperature not finite: goes to 0,
                             and opens again below the limit by the hysteresis */
    PREFIX_FACTOR = 16,   /* a fault factor not finite: the one before holds; or outside 0..1: the
                             nearer end is taken. Stands until factors are given again */
    PREFIX_PARAMETER = 32, /* a parameter or limit cannot be used: the output is 0 at once */
    PREFIX_STUCK = 64     /* x stands while xdot says that the piston moves, or xdot stands while x
                             moves otherwise, over 5 mm: computed as given, but not to be trusted */
};

/* Plain data without pointers: may be copied. Read duty_out, status, limited, out_of_reach. */
typedef struct PREFIX_state {
    PREFIX_params p;
    PREFIX_real f_oil, f_electrical, f_deformation; /* [1] 1 = healthy */
    PREFIX_real duty_out;           /* [1] what the amplifier has */
    int status;                     /* of the last step, see above */
    int limited;                    /* 1: the output is not what was wanted: held by the ceiling, the
                                       slew limit, the temperature or bad inputs (not by the update
                                       period or the resolution alone) */
    int out_of_reach;               /* 1: no duty gives the faulty force now: the yield force would
                                       have to push */
    int called, moved, closed;      /* a duty was given out; motion is known; too hot */
    int bad_steps, bad_factor;      /* calls in a row without a usable dt; a factor was not usable */
    PREFIX_real since_change;       /* [s] since duty_out changed */
    PREFIX_real step, even;         /* [s] the last good dt; for how long all were alike */
    PREFIX_real blind;              /* [s] since the last good inputs */
    PREFIX_real x, xdot, duty;      /* [m] [m/s] [1] the last good ones */
    PREFIX_real speed, slope, bend; /* [m/s] [m/s^2] [m/s^3] of the parabola that follows xdot */
@OBSERVED@
    PREFIX_real strayed_x, strayed_xdot; /* [m] travel that a standing signal misses */
} PREFIX_state;

/* The identified values, and the limits that were exported. */
void PREFIX_defaults(PREFIX_params *p);

/* Before the first step. A null pointer p takes the defaults. */
void PREFIX_init(PREFIX_state *s, const PREFIX_params *p);

/* What the damper is to have lost, 1 = healthy; held until called again. */
void PREFIX_faults(PREFIX_state *s, PREFIX_real f_oil, PREFIX_real f_electrical,
                   PREFIX_real f_deformation);

/* One sample: dt [s] since the one before (ignored at the first), deflection x [m] and xdot [m/s]
   (positive in compression), the healthy controller's duty [1], temperature [degC].
   Returns the duty for the amplifier [1]. */
PREFIX_real PREFIX_step(PREFIX_state *s, PREFIX_real dt, PREFIX_real x, PREFIX_real xdot,
                        PREFIX_real duty, PREFIX_real temperature);

#ifdef __cplusplus
}
#endif

#endif

#ifndef @GUARD@
#define @GUARD@

#ifdef __cplusplus
extern "C" {
#endif

#ifdef ERDCTL_FLOAT
typedef float PREFIX_real;
#else
typedef double PREFIX_real;
#endif

/* Bits of PREFIX_state.status after a step; 0 if all is well. */
enum PREFIX_status {
    PREFIX_OK = 0,
    PREFIX_NOT_FINITE = 1,        /* an input is NaN, infinite or beyond anything physical: held */
    PREFIX_STEP_NOT_POSITIVE = 2, /* dt <= 0: the last force is held */
    PREFIX_DUTY_LIMITED = 4,      /* the duty lay outside 0..1 */
    PREFIX_FAULT_LIMITED = 8      /* a fault factor lay outside 0..1, or was no number */
};

@PARAMETERS@

/* Plain data without pointers: a copy of it is the state, to return to or to go on with. */
typedef struct PREFIX_state {
    PREFIX_params p;
    int status;              /* of the last step, bits of PREFIX_status */
    int fault_status;        /* of the last PREFIX_faults */
    int started;             /* a sample has been taken */
    int moved;               /* the piston has moved */
    int up;                  /* direction whose parameters apply: 1 compression, 0 release */
    int rests;               /* begins at rest: 1, not: 0, by its first speed: -1 */
    PREFIX_real f_oil, f_electrical, f_deformation;
    PREFIX_real force;       /* [N] last good one */
    PREFIX_real waited;      /* [s] of steps with no usable input */
    PREFIX_real t, t_low;    /* [s] since the first sample, and what its digits do not hold */
    PREFIX_real clock;       /* [s] time of the first sample */
    PREFIX_real x, xdot;     /* [m], [m/s] of the piston at the last sample */
    PREFIX_real duty;        /* [1] as given at the last sample */
    PREFIX_real yielding;    /* [N] F_ER of Eq. 12 */
    PREFIX_real rises, falls; /* [1] factors of T_d in the step ahead */
@STATES@} PREFIX_state;

/* The identified values. */
void PREFIX_defaults(PREFIX_params *p);

/* A damper before its first sample, healthy. */
void PREFIX_init(PREFIX_state *s, const PREFIX_params *p);

/* Other parameters from now on; what the damper remembers stays. */
void PREFIX_retune(PREFIX_state *s, const PREFIX_params *p);

/* After init, where it is known: time of the first sample [s], which onsets count in; direction of
 * the first motion, 1 compression or 0 release, for a damper that begins at rest; whether it begins
 * at rest (1) or as a motion turns (0), or by its first speed (-1). Without: 0, 1, -1. */
void PREFIX_begin(PREFIX_state *s, PREFIX_real clock, int compression, int rests);

/* Effectiveness that is left after a fault, Eqs. 20, 22, 23: 1 is healthy. Held until called again. */
void PREFIX_faults(PREFIX_state *s, PREFIX_real f_oil, PREFIX_real f_electrical,
                   PREFIX_real f_deformation);

@TOLD@/* Force [N] at a sample: dt [s] since the last one (at the first, of no meaning), deflection x [m],
 * xdot [m/s] > 0 in compression, duty 0..1, which is held from this sample to the next. */
PREFIX_real PREFIX_step(PREFIX_state *s, PREFIX_real dt, PREFIX_real x, PREFIX_real xdot,
                        PREFIX_real duty);

#ifdef __cplusplus
}
#endif

#endif

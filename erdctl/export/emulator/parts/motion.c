
/* What the motion was, and what it will be as far as it can be told from the past. */

/* xdot is followed by a parabola that forgets what is older than some of these times [s]: short
   enough to follow a wheel's hop, long enough to leave out most of a sensor's noise. */
#define MEMORY K(0.0025)

/* Of its curvature, which a straight line has not: half the noise, and nearly all of the gain. */
#define TRUSTED K(0.5)

/* Takes in a good sample, `gap` after the last good one [s].
   Source of the gains: N. Morrison, Introduction to Sequential Smoothing and Prediction (1969),
   fading-memory polynomial filter of second degree. */
static void take_motion(Emulator *s, real gap, real x, real xdot)
{
    const real moved = x - s->x, told = K(0.5) * (xdot + s->xdot) * gap;
    const real keeps = MEMORY / (MEMORY + gap), fresh = K(1.0) - keeps;
    const real ahead = s->speed + gap * (s->slope + K(0.5) * gap * s->bend);
    const real missed = xdot - ahead;
    s->speed = ahead + (K(1.0) - keeps * keeps * keeps) * missed;
    s->slope += gap * s->bend + K(1.5) * (K(1.0) - keeps * keeps) * fresh * missed / gap;
    s->bend += fresh * fresh * fresh * missed / (gap * gap);
    /* A sensor that stands: what the other tells in the meantime, less what itself did. */
    s->strayed_x = x == s->x ? s->strayed_x + told : K(0.0);
    s->strayed_xdot = xdot == s->xdot ? s->strayed_xdot + moved - told : K(0.0);
}

/* How far ahead the parabola is drawn [s]; a hopping wheel turns round in a little more. */
#define FARTHEST K(0.016)

/* xdot [m/s] at a time h [s] from now. */
static real speed_ahead(const Emulator *s, real h)
{
    const real ahead = h < FARTHEST ? h : FARTHEST;
    return s->speed + ahead * (s->slope + K(0.5) * TRUSTED * ahead * s->bend);
}

static int stuck(const Emulator *s)
{
    return FABS(s->strayed_x) > STRAYED || FABS(s->strayed_xdot) > STRAYED;
}

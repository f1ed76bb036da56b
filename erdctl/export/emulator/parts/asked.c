/* A copy of the real damper is asked which duty brings its force to the faulty one's at the next
   moment at which the duty can change. */

#define TRIES 3            /* duties that are tried between none and the highest */
#define MET K(2e-3)        /* of the force that a duty can make up: near enough */
#define HIDDEN K(0.1)      /* of what Eq. 12 lets a duty show: below, the force says nothing of it, */
#define PLAIN K(0.3)       /* and from here on all */
#define FARTHER K(0.008)   /* [s] ahead of that moment it is asked again where it says nothing */

/* Force [N] that the real damper will have with a duty. */
static real force_with(Emulator *s, const Outlook *o, real duty)
{
    PREFIX_damper_state copy;
    real now;
    copy_of(&copy, &s->made);
    now = look(&copy, &s->made, o->dt, s->x, s->xdot, duty);
    if (!(o->h > K(0.0)))
        return now;
    if (o->late > K(0.0))
        look(&copy, &s->made, o->late, o->x_1, o->xdot_1, duty);
    return look(&copy, &s->made, o->held, o->x_2, o->xdot_2, duty);
}

/* By asking the damper: none and span are its force without a duty, and what the highest adds. */
static real duty_by_force(Emulator *s, const Outlook *o, real beta, real top, real goal,
                          real none, real span)
{
    const real part = (goal - none) / span;
    real low = K(0.0), high = K(1.0), miss_low = -part, miss_high = K(1.0) - part, w = part, miss;
    int i;
    if (!(part > K(0.0)))
        return K(0.0);
    if (part >= K(1.0))
        return part > K(1.0) ? K(2.0) : top;
    for (i = 0; i < TRIES; i++) {
        miss = (force_with(s, o, top * POW(w, K(1.0) / beta)) - none) / span - part;
        if (FABS(miss) < MET)
            break;
        if (miss < K(0.0)) {
            low = w;
            miss_low = miss;
        } else {
            high = w;
            miss_high = miss;
        }
        w = low - miss_low * (high - low) / (miss_high - miss_low);
    }
    return top * POW(w, K(1.0) / beta);
}

/* The duty by the force, and how far it is to be trusted: as far as what Eq. 12 lets a duty show is
   seen at the end. Below 0 more duty shows as less force. */
typedef struct {
    real duty, shown, trust;
} Answer;

static Answer asked(Emulator *s, const Outlook *o, const Law *law, const Goal *goal, real top)
{
    const real none = force_with(s, o, K(0.0)), span = force_with(s, o, top) - none;
    const real most = law->gone * law->sigma * POW(top, law->beta);
    Answer out = {K(0.0), K(0.0), K(0.0)};
    out.shown = law->way * span / (most > K(0.0) ? most : K(1.0));
    out.trust = clamped((out.shown - HIDDEN) / (PLAIN - HIDDEN), K(0.0), K(1.0));
    if (out.trust > K(0.0))
        out.duty = duty_by_force(s, o, law->beta, top, goal->force, none, span);
    return out;
}

/* What the force hides now (a joint in its play, a void) it may show in some time. If not, or if a
   duty shows the wrong way round, the yield force alone is aimed at. */
static real wanted_duty(Emulator *s, real dt, real top)
{
    const Outlook o = outlook(s, dt, top, K(0.0));
    const Goal goal = goal_of(s, &o);
    const Law law = law_at_the_end(s, &o, &goal);
    const Answer now = asked(s, &o, &law, &goal, top);
    real rest = K(0.0), out = now.trust * now.duty;
    if (now.trust < K(1.0)) {
        rest = K(1.0) - now.trust;
        if (o.h > K(0.0) && now.shown > -HIDDEN) {
            const Outlook far = outlook(s, dt, top, FARTHER);
            const Goal then = goal_of(s, &far);
            const Law at_end = law_at_the_end(s, &far, &then);
            const Answer later = asked(s, &far, &at_end, &then, top);
            out += rest * later.trust * later.duty;
            rest *= K(1.0) - later.trust;
        }
        out += rest > K(0.0) ? rest * duty_by_yield_force(s, &law, &goal) : K(0.0);
    }
    return out;
}

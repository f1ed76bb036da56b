
/* The exported damper itself, with all its effects: three of it run along, and a copy of the real
   one is asked which duty brings its force to the faulty one's at the next moment at which the duty
   can change. */

#define TRIES 3            /* duties that are tried between none and the highest */
#define MET K(2e-3)        /* of the force that a duty can make up: near enough */
#define SHOWS K(0.05)      /* of the most that was seen: where a duty shows less, it stays */

static void observe(Emulator *s, real dt, real x, real xdot, real duty)
{
    PREFIX_damper_faults(&s->faulty, s->f_oil, s->f_electrical, s->f_deformation);
    s->ideal = PREFIX_damper_step(&s->faulty, dt, x, xdot, duty);
    s->unfielded = PREFIX_damper_step(&s->idle, dt, x, xdot, K(0.0));
}

/* A time dt without good inputs: as if the last ones stood. */
static void observe_blind(Emulator *s, real dt)
{
    observe(s, dt, s->x, s->xdot, s->duty);
}

/* What the amplifier has from this sample on. */
static void settle(Emulator *s, real dt, int starts)
{
    (void)starts;
    PREFIX_damper_step(&s->made, dt, s->x, s->xdot, s->duty_out);
}

static int unreachable(const Emulator *s)
{
    return (s->ideal - s->unfielded) * s->xdot < K(0.0);
}

/* What is told of the motion to come. */
typedef struct {
    real dt;              /* [s] since the sample before, 0 at the first */
    real late, x_1, xdot_1; /* [s] after which a duty given now begins to show, [m], [m/s] then */
    real h, x_2, xdot_2;  /* [s] from then on, [m], [m/s] at its end */
    real held;            /* [s] over which a duty that is tried is held, h or more */
} Outlook;

/* Force [N] that the real damper will have with a duty. */
static real force_with(const Emulator *s, const Outlook *o, real duty)
{
    PREFIX_damper_state copy = s->made;
    const real now = PREFIX_damper_step(&copy, o->dt, s->x, s->xdot, duty);
    if (!(o->h > K(0.0)))
        return now;
    if (o->late > K(0.0))
        PREFIX_damper_step(&copy, o->late, o->x_1, o->xdot_1, duty);
    return PREFIX_damper_step(&copy, o->held, o->x_2, o->xdot_2, duty);
}

/* Force [N] that the faulty one will have. */
static real force_wanted(const Emulator *s, const Outlook *o)
{
    PREFIX_damper_state copy;
    if (!(o->h > K(0.0)))
        return s->ideal;
    copy = s->faulty;
    if (o->late > K(0.0))
        PREFIX_damper_step(&copy, o->late, o->x_1, o->xdot_1, s->duty);
    return PREFIX_damper_step(&copy, o->h, o->x_2, o->xdot_2, s->duty);
}

static Outlook outlook(const Emulator *s, real dt, real top)
{
    Outlook o = {0};
    o.dt = dt;
    if (dt > K(0.0)) {
        const real sweep = s->p.slew > K(0.0) ? SWEEP * top / s->p.slew : K(0.0);
        o.late = s->p.dead_time;
        o.h = until_next(&s->p, dt);
        o.xdot_1 = speed_ahead(s, o.late);
        o.x_1 = s->x + K(0.5) * o.late * (s->xdot + o.xdot_1);
        o.xdot_2 = speed_ahead(s, o.late + o.h);
        o.x_2 = o.x_1 + K(0.5) * o.h * (o.xdot_1 + o.xdot_2);
        o.held = sweep > o.h ? sweep : o.h;
    }
    return o;
}

/* The duty for the part w of the force that duties can make up, if that follows a power law. */
static real duty_of(real w, real top, real beta)
{
    return top * POW(w, K(1.0) / beta);
}

static real wanted_duty(Emulator *s, real dt, real top)
{
    const Outlook o = outlook(s, dt, top);
    const real none = force_with(s, &o, K(0.0)), span = force_with(s, &o, top) - none;
    const real shows = FABS(span);
    const real beta = (o.h > K(0.0) ? o.xdot_2 : s->xdot) > K(0.0) ? s->p.damper.compression_beta
                                                                    : s->p.damper.release_beta;
    real low = K(0.0), high = K(1.0), goal, w, short_of, miss_low, miss_high;
    int i;
    s->shown = shows > s->shown ? shows : s->shown;
    if (!(shows > SHOWS * s->shown))
        return s->wanted;
    goal = (force_wanted(s, &o) - none) / span;
    if (!(goal > K(0.0)))
        return s->wanted = K(0.0);
    if (goal >= K(1.0))
        return s->wanted = goal > K(1.0) ? K(2.0) : top;
    miss_low = -goal;
    miss_high = K(1.0) - goal;
    w = goal;
    for (i = 0; i < TRIES; i++) {
        short_of = (force_with(s, &o, duty_of(w, top, beta)) - none) / span - goal;
        if (FABS(short_of) < MET)
            break;
        if (short_of < K(0.0)) {
            low = w;
            miss_low = short_of;
        } else {
            high = w;
            miss_high = short_of;
        }
        w = low - miss_low * (high - low) / (miss_high - miss_low);
    }
    return s->wanted = duty_of(w, top, beta);
}

static void renew(Emulator *s)
{
    if (memcmp(&s->p.damper, &s->made.p, sizeof s->p.damper) == 0)
        return;
    PREFIX_damper_retune(&s->faulty, &s->p.damper);
    PREFIX_damper_retune(&s->made, &s->p.damper);
    PREFIX_damper_retune(&s->idle, &s->p.damper);
}

static void begin(Emulator *s)
{
    PREFIX_damper_init(&s->faulty, &s->p.damper);
    PREFIX_damper_init(&s->made, &s->p.damper);
    PREFIX_damper_init(&s->idle, &s->p.damper);
}

static int usable_model(const Settings *p)
{
    return positive(p->dead_time, K(1.0))
@USABLE@;
}

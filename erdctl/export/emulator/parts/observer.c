
/* The exported damper itself, with all its effects: three of it run along, and copies of them tell
   what force comes next. */

/* A copy to look ahead with, all but its long memories; `look` finds these where they are. */
static void copy_of(PREFIX_damper_state *copy, const PREFIX_damper_state *of)
{
    memcpy(copy, of, @COPIED@);
}

/* A step of a copy: its force [N]. What diverged has forgotten its past and stays where it is. */
static real look(PREFIX_damper_state *copy, PREFIX_damper_state *of, real dt, real x, real xdot,
                 real duty)
{
    if (of->started && !copy->started)
        return copy->force;
    return step_with(copy, of, dt, x, xdot, duty);
}

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

/* Of the time that the damper's own supply takes from no duty to the highest: a force that is to be
   met sooner sends the duty from one end to the other and back. */
#define SLEWING K(0.35)

/* What is told of the motion to come. */
typedef struct {
    real dt;              /* [s] since the sample before, 0 at the first */
    real late, x_1, xdot_1; /* [s] after which a duty given now begins to show, [m], [m/s] then */
    real h, x_2, xdot_2;  /* [s] from then on, [m], [m/s] at its end */
    real held;            /* [s] over which a duty that is tried is held, h or more */
} Outlook;

static Outlook outlook(const Emulator *s, real dt, real top, real more)
{
    Outlook o = {0};
    o.dt = dt;
    if (dt > K(0.0)) {
        const real sweep = s->p.slew > K(0.0) ? SWEEP * top / s->p.slew : K(0.0);
        o.late = s->p.dead_time;
        o.h = until_next(&s->p, dt);
        if (o.h < SLEWING * s->p.sweep_time * top)
            o.h = SLEWING * s->p.sweep_time * top;
        o.h += more;
        o.xdot_1 = speed_ahead(s, o.late);
        o.x_1 = s->x + K(0.5) * o.late * (s->xdot + o.xdot_1);
        o.xdot_2 = speed_ahead(s, o.late + o.h);
        o.x_2 = o.x_1 + K(0.5) * o.h * (o.xdot_1 + o.xdot_2);
        o.held = sweep > o.h ? sweep : o.h;
    }
    return o;
}

/* What is to be reached: force [N] of the faulty damper at the end, and the yield force [N] with
   which the real one has it by the paper's model, whatever of it shows. Below 0 none does. */
typedef struct {
    real force, yield;
    int up;               /* direction then: 1 compression, 0 release */
} Goal;

/* The second as Eqs. 26, 30, 34: what the fault takes of the faulty damper's own yield force, of
   its gas and of its viscous force. */
static Goal goal_of(Emulator *s, const Outlook *o)
{
    const PREFIX_damper_params *p = &s->p.damper;
    const PREFIX_damper_state *end = &s->faulty;
    PREFIX_damper_state copy;
    real x = s->x, xdot = s->xdot, lost;
    Goal out;
    out.force = s->ideal;
    if (o->h > K(0.0)) {
        copy_of(&copy, end);
        if (o->late > K(0.0))
            look(&copy, &s->faulty, o->late, o->x_1, o->xdot_1, s->duty);
        out.force = look(&copy, &s->faulty, o->h, o->x_2, o->xdot_2, s->duty);
        end = &copy;
        x = o->x_2;
        xdot = o->xdot_2;
    }
    /* Of the rod: where the piston does not go with it, its next stroke begins with it. */
    out.up = xdot > K(0.0) || (xdot == K(0.0) && s->made.up);
    lost = (s->f_oil - K(1.0)) * (out.up ? p->compression_k_nom : p->release_k_nom) * x;
    lost += (s->f_oil * s->f_deformation - K(1.0))
        * (out.up ? p->compression_c_vis : p->release_c_vis) * xdot;
    out.yield = (out.up ? lost : -lost)
        + s->f_oil * s->f_electrical * s->f_deformation * end->@YIELDING@;
    return out;
}

/* The law of Eq. 12 in the direction of the end. */
typedef struct {
    real sigma, beta, gone;
    real way; /* 1 compression, -1 release */
} Law;

static Law law_at_the_end(const Emulator *s, const Outlook *o, const Goal *goal)
{
    const PREFIX_damper_params *p = &s->p.damper;
    const real T = goal->up ? p->compression_T_d : p->release_T_d;
    Law law;
    law.sigma = goal->up ? p->compression_sigma : p->release_sigma;
    law.beta = goal->up ? p->compression_beta : p->release_beta;
    law.gone = o->h > K(0.0) && T > K(0.0) ? -EXPM1(-o->held / T) : K(1.0);
    law.way = goal->up ? K(1.0) : K(-1.0);
    return law;
}

/* By Eq. 12 alone, from the yield force. */
static real duty_by_yield_force(const Emulator *s, const Law *law, const Goal *goal)
{
    const real steady = (goal->yield - (K(1.0) - law->gone) * s->made.@YIELDING@) / law->gone;
    if (!(steady > K(0.0)) || !(law->sigma > K(0.0)))
        return K(0.0);
    return steady > law->sigma ? K(2.0) : POW(steady / law->sigma, K(1.0) / law->beta);
}

@WANTED@
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
    return positive(p->dead_time, K(1.0)) && positive(p->sweep_time, K(10.0))
@USABLE@;
}

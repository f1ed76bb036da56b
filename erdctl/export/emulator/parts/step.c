
/* What is left of the gas, the viscous and the yield force, Eqs. 20, 22, 23. */
typedef struct {
    real gas, viscous, yield;
} Left;

static Left left_of(const State *s)
{
    Left g;
    g.gas = s->f_oil;
    g.viscous = s->f_oil * s->f_deformation;
    g.yield = s->f_oil * s->f_deformation * s->f_electrical;
    return g;
}

/* Yield force [N] with which the healthy damper has the faulty one's force, Eqs. 26, 30, 34, from
   the healthy yield force F. Below 0 none does. Where the piston stands (direction 0) none shows,
   but the next stroke begins with it. */
static real target_of(const Params *p, Left g, int up, real direction, real x, real xdot, real F)
{
    const real k_nom = up ? p->compression_k_nom : p->release_k_nom;
    const real c_vis = up ? p->compression_c_vis : p->release_c_vis;
    const real others = (g.gas - K(1.0)) * k_nom * x + (g.viscous - K(1.0)) * c_vis * xdot;
    return direction * others + g.yield * F;
}

static real sign_of(real value)
{
    return value > K(0.0) ? K(1.0) : value < K(0.0) ? K(-1.0) : K(0.0);
}

/* Of the time that a slewing amplifier needs from 0 to its highest duty: the target is to be met in
   so much at least, or it would sweep to and fro after every force that one step does not reach. */
#define SWEEP K(0.1)

/* The duty that brings the yield force to the faulty one's target at the next moment at which the
   duty can change. What the motion will be until then is told from the past alone. */
static real wanted_duty(State *s, real dt, real top)
{
    const Params *p = &s->p;
    const Left g = left_of(s);
    const int up = s->up;
    const Law law = law_of(p, up), turned = law_of(p, !up);
    const real *u = s->steady;
    real h, sweep, x, xdot, part, target;
    int turns;
    Span span;
    target = target_of(p, g, up, sign_of(s->xdot), s->x, s->xdot, s->healthy);
    s->out_of_reach = target < K(0.0);
    if (!(dt > K(0.0))) /* the first sample: the steady force is the one to begin with */
        return duty_for(&law, target);
    h = until_next(p, dt);
    sweep = p->slew > K(0.0) ? SWEEP * top / p->slew : K(0.0);
    xdot = speed_ahead(s, h);
    x = s->x + K(0.5) * h * (s->xdot + xdot);
    turns = up ? xdot < K(0.0) : xdot > K(0.0);
    part = turns ? part_before(s->xdot, xdot) : K(1.0);
    span = turns ? turned_span(h, part, &law, &turned) : span_of(h, &law);
    target = target_of(p, g, up != turns, up != turns ? K(1.0) : K(-1.0), x, xdot,
                       span.a * s->healthy + span.before * u[up ? 0 : 1]
                       + span.after * u[up ? 1 : 0]);
    if (sweep > h)
        span = turns ? turned_span(sweep, part * h / sweep, &law, &turned) : span_of(sweep, &law);
    return meeting(target - span.a * s->made, &span, &law, &turned, top);
}

static int acting(const State *s)
{
    return s->f_oil < K(1.0) || s->f_electrical < K(1.0) || s->f_deformation < K(1.0);
}

static int too_hot(State *s, real temperature)
{
    const real limit = s->p.temperature_max;
    s->closed = !(temperature <= (s->closed ? limit - s->p.temperature_hysteresis : limit)
                  && temperature > K(-274.0));
    return s->closed;
}

/* Gives the amplifier what is wanted, as far as its limits let it. */
static void give(State *s, real wanted, int mimic, real dt)
{
    const real top = highest(&s->p);
    real next, level = mimic ? nearest(&s->p, top, wanted) : given(&s->p, top, wanted);
    if (mimic) {
        /* A fault that needs no change makes none, not even by rounding. */
        const real same = given(&s->p, top, s->duty);
        const real slight = ON_GRID * s->p.resolution;
        if (FABS(level - same) <= (slight > EQUAL ? slight : EQUAL))
            level = same;
    }
    if (!s->called)
        next = level;
    else if (level == s->duty_out || may_change(s))
        next = towards(s, level, dt);
    else
        return;
    s->limited = wanted > top * (K(1.0) + EQUAL) || next != level;
    if (!s->called || next != s->duty_out) {
        s->duty_out = next;
        s->since_change = K(0.0);
        set_steady(s, 2, next);
    }
    s->called = 1;
}

/* The healthy duty, or while a fault acts the one that mimics it. */
static void emulate(State *s, real dt)
{
    if (!acting(s)) {
        s->out_of_reach = 0;
        give(s, s->duty, 0, dt);
    } else {
        give(s, wanted_duty(s, dt, highest(&s->p)), 1, dt);
    }
}

/* What to do where the output must not stay. */
static real shut(State *s, real dt)
{
    give(s, K(0.0), 0, dt);
    s->limited = 1;
    s->out_of_reach = 0;
    return s->duty_out;
}

/* The motion, the controller's duty and the yield forces at a good sample. */
static void take(State *s, real gap, real x, real xdot, real duty, real dt)
{
    const int first = !s->moved, up0 = s->up, up = xdot > K(0.0) || (xdot == K(0.0) && up0);
    const Law law = law_of(&s->p, up0);
    if (!first) {
        take_motion(s, gap, x, xdot);
        if (up == up0 || !s->turning) {
            const Span span = span_of(dt, &law);
            relax(s, &span, up, up);
        } else {
            const Law then = law_of(&s->p, up);
            const Span span = turned_span(dt, part_before(s->xdot, xdot), &law, &then);
            relax(s, &span, up0, up);
        }
    }
    if (xdot != K(0.0))
        s->turning = 1;
    s->up = up;
    s->x = x;
    s->xdot = xdot;
    if (first)
        s->speed = xdot;
    if (first || duty != s->duty) {
        s->duty = duty;
        set_steady(s, 0, duty);
    }
    if (first)
        s->healthy = s->steady[up ? 0 : 1];
    s->moved = 1;
}

/* 0 at once, where no one can say what the amplifier's limits allow. */
static real drop(State *s)
{
    if (s->duty_out > K(0.0))
        s->since_change = K(0.0);
    s->duty_out = s->steady[2] = s->steady[3] = K(0.0);
    s->called = s->limited = 1;
    s->out_of_reach = 0;
    return s->duty_out;
}

/* Time passes; false if no one can say how much. */
static int pass(State *s, real dt)
{
    if (!s->called)
        return 1;
    if (!within(dt, SHORTEST, LARGEST)) {
        s->status |= PREFIX_STEP;
        if (++s->bad_steps > BAD_STEPS) {
            s->bad_steps = BAD_STEPS;
            drop(s);
        }
        return 0;
    }
    s->bad_steps = 0;
    s->since_change = s->since_change > LARGEST ? s->since_change : s->since_change + dt;
    s->even = FABS(dt - s->step) > EQUAL * dt ? dt : s->even > LARGEST ? s->even : s->even + dt;
    s->step = dt;
    return 1;
}

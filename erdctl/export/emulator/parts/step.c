
static int fault_acts(const Emulator *s)
{
    return s->f_oil < K(1.0) || s->f_electrical < K(1.0) || s->f_deformation < K(1.0);
}

static int too_hot(Emulator *s, real temperature)
{
    const real limit = s->p.temperature_max;
    s->closed = !(temperature <= (s->closed ? limit - s->p.temperature_hysteresis : limit)
                  && temperature > K(-274.0));
    return s->closed;
}

/* Gives the amplifier what is wanted, as far as its limits let it. */
static void give(Emulator *s, real wanted, int mimic, real dt)
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
    }
    s->called = 1;
}

/* The healthy duty, or while a fault acts the one that mimics it. */
static void emulate(Emulator *s, real dt)
{
    if (!fault_acts(s)) {
        s->out_of_reach = 0;
        give(s, s->duty, 0, dt);
    } else {
        s->out_of_reach = unreachable(s);
        if (!s->called || may_change(s))
            give(s, wanted_duty(s, dt, highest(&s->p)), 1, dt);
    }
}

/* What to do where the output must not stay. */
static void shut(Emulator *s, real dt)
{
    give(s, K(0.0), 0, dt);
    s->limited = 1;
    s->out_of_reach = 0;
}

/* A good sample. */
static void take_sample(Emulator *s, real dt, real x, real xdot, real duty)
{
    if (s->moved)
        take_motion(s, s->blind + dt, x, xdot);
    else
        s->speed = xdot;
    s->blind = K(0.0);
    observe(s, dt, x, xdot, duty);
    s->x = x;
    s->xdot = xdot;
    s->duty = duty;
    s->moved = 1;
}

/* 0 at once, where no one can say what the amplifier's limits allow. */
static void drop(Emulator *s)
{
    if (s->duty_out > K(0.0))
        s->since_change = K(0.0);
    s->duty_out = K(0.0);
    s->called = s->limited = 1;
    s->out_of_reach = 0;
}

/* Time passes; false if no one can say how much. */
static int pass(Emulator *s, real dt)
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


/* Whether parameters and limits make sense; NaN does not. */
static int usable_settings(const Settings *p)
{
    return usable_model(p) && positive(p->duty_max, K(1.0)) && positive(p->resolution, K(1.0))
        && positive(p->slew, K(1e9)) && positive(p->update_period, K(1e6))
        && within(p->temperature_max, K(-273.0), K(1e4))
        && positive(p->temperature_hysteresis, K(1e4));
}

void PREFIX_defaults(Settings *p)
{
@DEFAULTS@
}

void PREFIX_init(Emulator *s, const Settings *p)
{
    Emulator fresh = {0};
    PREFIX_defaults(&fresh.p);
    if (p)
        fresh.p = *p;
    fresh.f_oil = fresh.f_electrical = fresh.f_deformation = K(1.0);
    *s = fresh;
    begin(s);
}

static real factor(Emulator *s, real before, real value)
{
    if (within(value, K(0.0), K(1.0)))
        return value;
    s->bad_factor = 1;
    return within(value, -LARGEST, LARGEST) ? clamped(value, K(0.0), K(1.0)) : before;
}

void PREFIX_faults(Emulator *s, real f_oil, real f_electrical, real f_deformation)
{
    s->bad_factor = 0;
@FAULTS@
}

/* Inputs that cannot be used: time passes, and the last duty stands for as long as it is safe. */
static void go_blind(Emulator *s, real dt)
{
    const int hold = s->called && !s->closed
        && (!(s->blind > K(0.0)) || s->blind + dt <= s->p.update_period * (K(1.0) + EQUAL));
    if (s->moved)
        observe_blind(s, dt);
    s->blind = s->blind > LARGEST ? s->blind : s->blind + dt;
    s->limited = 1;
    if (!hold)
        shut(s, dt);
}

static void respond(Emulator *s, real dt, real x, real xdot, real duty)
{
    if (!usable_settings(&s->p)) {
        s->status |= PREFIX_PARAMETER;
        drop(s);
        return;
    }
    renew(s);
    if (!within(x, -LARGEST, LARGEST) || !within(xdot, -LARGEST, LARGEST)
        || !within(duty, -LARGEST, LARGEST)) {
        s->status |= PREFIX_INPUT;
        go_blind(s, dt);
        return;
    }
    if (!within(duty, K(0.0), K(1.0)))
        s->status |= PREFIX_DUTY;
    take_sample(s, dt, x, xdot, clamped(duty, K(0.0), K(1.0)));
    if (stuck(s))
        s->status |= PREFIX_STUCK;
    if (s->closed)
        shut(s, dt);
    else
        emulate(s, dt);
}

real PREFIX_step(Emulator *s, real dt, real x, real xdot, real duty, real temperature)
{
    const int starts = !s->called;
    s->status = s->bad_factor ? PREFIX_FACTOR : PREFIX_OK;
    if (too_hot(s, temperature))
        s->status |= PREFIX_HOT;
    if (pass(s, dt)) {
        dt = starts ? K(0.0) : dt;
        respond(s, dt, x, xdot, duty);
        if (s->moved)
            settle(s, dt, starts);
    }
    return s->duty_out;
}

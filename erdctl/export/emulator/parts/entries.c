
static int positive(real value, real most)
{
    return within(value, K(0.0), most);
}

/* Whether parameters and limits make sense; NaN does not. */
static int usable(const Params *p)
{
    return positive(p->compression_k_nom, K(1e9)) && positive(p->release_k_nom, K(1e9))
        && positive(p->compression_c_vis, K(1e9)) && positive(p->release_c_vis, K(1e9))
        && positive(p->compression_T_d, K(1e6)) && positive(p->release_T_d, K(1e6))
        && positive(p->compression_sigma, K(1e9)) && positive(p->release_sigma, K(1e9))
        && within(p->compression_beta, K(1e-2), K(1e2)) && within(p->release_beta, K(1e-2), K(1e2))
        && positive(p->duty_max, K(1.0)) && positive(p->resolution, K(1.0))
        && positive(p->slew, K(1e9)) && positive(p->update_period, K(1e6))
        && within(p->temperature_max, K(-273.0), K(1e4))
        && positive(p->temperature_hysteresis, K(1e4));
}

void PREFIX_defaults(Params *p)
{
@DEFAULTS@
}

void PREFIX_init(State *s, const Params *p)
{
    State fresh = {0};
    PREFIX_defaults(&fresh.p);
    if (p)
        fresh.p = *p;
    fresh.f_oil = fresh.f_electrical = fresh.f_deformation = K(1.0);
    fresh.up = 1;
    *s = fresh;
}

static real factor(State *s, real before, real value)
{
    if (within(value, K(0.0), K(1.0)))
        return value;
    s->bad_factor = 1;
    return within(value, -LARGEST, LARGEST) ? clamped(value, K(0.0), K(1.0)) : before;
}

void PREFIX_faults(State *s, real f_oil, real f_electrical, real f_deformation)
{
    s->bad_factor = 0;
@FAULTS@
}

/* Inputs that cannot be used: time passes, and the last duty stands for as long as it is safe. */
static real go_blind(State *s, real dt)
{
    const int hold = s->called && !s->closed
        && (!(s->blind > K(0.0)) || s->blind + dt <= s->p.update_period * (K(1.0) + EQUAL));
    if (s->moved) {
        const Law law = law_of(&s->p, s->up);
        const Span span = span_of(dt, &law);
        relax(s, &span, s->up, s->up);
    }
    s->blind = s->blind > LARGEST ? s->blind : s->blind + dt;
    if (!hold)
        return shut(s, dt);
    s->limited = 1;
    return s->duty_out;
}

real PREFIX_step(State *s, real dt, real x, real xdot, real duty, real temperature)
{
    const int starts = !s->called;
    s->status = s->bad_factor ? PREFIX_FACTOR : PREFIX_OK;
    if (too_hot(s, temperature))
        s->status |= PREFIX_HOT;
    if (!pass(s, dt))
        return s->duty_out;
    if (starts)
        dt = K(0.0);
    if (!usable(&s->p)) {
        s->status |= PREFIX_PARAMETER;
        return drop(s);
    }
    renew(s);
    if (!within(x, -LARGEST, LARGEST) || !within(xdot, -LARGEST, LARGEST)
        || !within(duty, -LARGEST, LARGEST)) {
        s->status |= PREFIX_INPUT;
        return go_blind(s, dt);
    }
    if (!within(duty, K(0.0), K(1.0)))
        s->status |= PREFIX_DUTY;
    take(s, s->blind + dt, x, xdot, clamped(duty, K(0.0), K(1.0)), dt);
    s->blind = K(0.0);
    if (stuck(s))
        s->status |= PREFIX_STUCK;
    if (s->closed)
        return shut(s, dt);
    emulate(s, dt);
    if (starts)
        s->made = s->steady[s->up ? 2 : 3];
    return s->duty_out;
}

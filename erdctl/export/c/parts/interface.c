void PREFIX_retune(PREFIX_state *s, const PREFIX_params *p)
{
    if (p != &s->p)
        s->p = *p;
    tabulate(s);
}

void PREFIX_init(PREFIX_state *s, const PREFIX_params *p)
{
    PREFIX_params own = *p;  /* which may be that of the state itself */

    memset(s, 0, sizeof *s);
    s->f_oil = s->f_electrical = s->f_deformation = K(1.0);
    s->rises = s->falls = K(1.0);
    s->up = 1;
    s->rests = -1;
    PREFIX_retune(s, &own);
}

void PREFIX_begin(PREFIX_state *s, PREFIX_real clock, int compression, int rests)
{
    s->clock = usable(clock, HUGEST) ? clock : K(0.0);
    s->up = compression != 0;
    s->rests = rests;
}

static real effectiveness(State *s, real wanted, real last)
{
    if (wanted >= K(0.0) && wanted <= K(1.0))
        return wanted;
    s->fault_status = PREFIX_FAULT_LIMITED;
    return wanted > K(1.0) ? K(1.0) : wanted < K(0.0) ? K(0.0) : last;
}

void PREFIX_faults(PREFIX_state *s, PREFIX_real f_oil, PREFIX_real f_electrical,
                   PREFIX_real f_deformation)
{
    s->fault_status = 0;
    s->f_oil = effectiveness(s, f_oil, s->f_oil);
    s->f_electrical = effectiveness(s, f_electrical, s->f_electrical);
    s->f_deformation = effectiveness(s, f_deformation, s->f_deformation);
}

/* What no parameters within their bounds lead to: it has no past any more that could be believed. */
static void forget(State *s)
{
    real f[3], force = s->force, clock = s->clock + s->t;
    int fault_status = s->fault_status, up = s->up;

    f[0] = s->f_oil;
    f[1] = s->f_electrical;
    f[2] = s->f_deformation;
    PREFIX_init(s, &s->p);
    s->f_oil = f[0];
    s->f_electrical = f[1];
    s->f_deformation = f[2];
    s->force = force;
    s->clock = clock;
    s->fault_status = fault_status;
    s->up = up;
}

/* A step with the long memories of `keeper`. */
static real step_with(State *s, State *keeper, real dt, real x, real xdot, real duty)
{
    Sample now;
    real force;
    int runs = !s->started || usable(dt, MOST);

    s->status = s->fault_status;
    if (!usable(x, MOST) || !usable(xdot, MOST) || !usable(duty, MOST) || !runs)
        s->status |= PREFIX_NOT_FINITE;
    if (s->started && dt <= K(0.0))
        s->status |= PREFIX_STEP_NOT_POSITIVE;
    if (s->status & (PREFIX_NOT_FINITE | PREFIX_STEP_NOT_POSITIVE)) {
        /* The time passes all the same. */
        if (s->started && runs && dt > K(0.0))
            s->waited = FMIN(s->waited + dt, MOST);
        return s->force;
    }
    if (duty < K(0.0) || duty > K(1.0)) {
        s->status |= PREFIX_DUTY_LIMITED;
        duty = duty < K(0.0) ? K(0.0) : K(1.0);
    }
    take(s, keeper, &now, dt, x, xdot, duty);
    force = acting(s, &now);
    keep(s, &now, duty);
    if (!usable(force, HUGEST)) {
        forget(s);
        s->status = s->fault_status | PREFIX_NOT_FINITE;
        return s->force;
    }
    s->force = force;
    return force;
}

PREFIX_real PREFIX_step(PREFIX_state *s, PREFIX_real dt, PREFIX_real x, PREFIX_real xdot,
                        PREFIX_real duty)
{
    return step_with(s, s, dt, x, xdot, duty);
}

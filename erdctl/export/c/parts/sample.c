static int heading(real xdot, int up)
{
    return xdot > K(0.0) ? 1 : xdot < K(0.0) ? 0 : up;
}

static void take(State *st, State *keeper, Sample *s, real dt, real x, real xdot, real duty)
{
    Motion m;

    memset(s, 0, sizeof *s);
    s->keeper = keeper;
    s->first = !st->started;
    s->h = s->first ? K(0.0) : dt + st->waited;
    if (!s->first)
        add_to(&st->t, &st->t_low, s->h);
    s->t = st->t;
    s->clock = st->clock;
    s->clock_low = st->t_low;
    add_to(&s->clock, &s->clock_low, st->t);
    s->x0 = s->first ? x : st->x;
    s->xdot0 = s->first ? xdot : st->xdot;
    s->x = x;
    s->xdot = xdot;
    s->duty = s->duty0 = duty;
    s->engaged = K(1.0);
    s->rests = s->first && (st->rests == 1 || (st->rests != 0 && !(xdot > K(0.0) || xdot < K(0.0))));
    s->up0 = st->up;
    s->up = heading(xdot, st->up);
    m.x = x;
    m.xdot = xdot;
    m.engaged = K(1.0);
    m.joint = 0;
    motion(st, s, &m);
    s->x = m.x;
    s->xdot = m.xdot;
    s->engaged = m.engaged;
    if (s->first) {
        s->x0 = m.x;
        s->xdot0 = m.xdot;
    }
    s->sign = (m.xdot > K(0.0) ? K(1.0) : m.xdot < K(0.0) ? K(-1.0) : K(0.0)) * m.engaged;
    s->up = heading(m.xdot, st->up);
    /* Before the first motion no direction is known, and the first one is no turn. */
    if (!st->moved)
        s->up0 = s->up;
    turn(s, m.joint);
    s->duty0 = control(st, s, s->first ? duty : st->duty);
    s->ahead = 1;
    s->duty = control(st, s, duty);
    s->ahead = 0;
}

static void keep(State *st, const Sample *s, real duty)
{
    st->x = s->x;
    st->xdot = s->xdot;
    st->duty = duty;
    st->up = s->up;
    st->moved = st->moved || s->xdot > K(0.0) || s->xdot < K(0.0);
    st->started = 1;
    st->waited = K(0.0);
    lags(st, s, &st->rises, &st->falls);
}

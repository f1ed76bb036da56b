/* sigma v^beta of Eq. 11 for either direction, over the step that has ended or begins. */
static real steady(State *st, const Sample *s, int way)
{
    real beta = way == 0 ? st->p.compression_beta : st->p.release_beta;
    real duty = s->ahead ? s->duty : s->duty0;
    real plain = duty > K(0.0) ? POW(duty, beta) : K(0.0);

    return field(st, s, plain, way) * (way == 0 ? st->p.compression_sigma : st->p.release_sigma);
}

/* Eq. 12 over the step that has ended, exact for a held field; in two parts if the piston turns. */
static void form(State *st, const Sample *s)
{
    real u[2], T[2], y, span, lag;
    int leg, legs, way;

    /* Powers cost: a direction that takes no part is left out, if nothing has to remember it. */
    for (way = 0; way < 2; way++)
        u[way] = FIELD_REMEMBERS || way == (s->up ? 0 : 1) || (s->turned && way == (s->up0 ? 0 : 1))
                     ? steady(st, s, way) : K(0.0);
    T[0] = st->p.compression_T_d;
    T[1] = st->p.release_T_d;
    if (!(T[0] > K(0.0)) && !(T[1] > K(0.0))) {
        Sample now = *s;

        now.ahead = 1;
        st->yielding = steady(st, &now, s->up ? 0 : 1);
        return;
    }
    if (s->first) {
        st->yielding = u[s->up ? 0 : 1];
        return;
    }
    y = st->yielding;
    legs = s->turned ? 2 : 1;
    for (leg = 0; leg < legs; leg++) {
        way = (leg == 0 ? s->up0 : s->up) ? 0 : 1;
        span = s->h;
        if (s->turned)
            span *= leg == 0 ? s->before : K(1.0) - s->before;
        lag = FMAX(T[way], AT_ONCE) * (FABS(u[way]) < FABS(y) ? st->falls : st->rises);
        y += (u[way] - y) * -EXPM1(-span / lag);
    }
    st->yielding = y;
}

/* Eqs. 20, 22, 23. */
static void fail(const State *st, Groups *f)
{
    f->gas *= st->f_oil;
    f->viscous *= st->f_oil * st->f_deformation;
    f->yield *= st->f_oil * st->f_electrical * st->f_deformation;
}

static real parallel(State *st, const Sample *s)
{
    Groups f, force;

    form(st, s);
    force.gas = gas_law(st, s) * along(s, st->p.compression_k_nom, st->p.release_k_nom);
    force.viscous = viscous_law(st, s) * along(s, st->p.compression_c_vis, st->p.release_c_vis);
    force.yield = yield_law(st, s, st->yielding * stretched(st, s, sign_law(st, s)));
    f.gas = f.viscous = f.yield = K(1.0);
    scale(st, s, &f);
    of_speed(st, s, &f);
    fail(st, &f);
    force.gas *= f.gas;
    force.viscous *= f.viscous;
    force.yield *= f.yield;
    feedback(st, s, &force);
    return force.gas + force.viscous + force.yield + terms(st, s) + driven(st, s, &force);
}

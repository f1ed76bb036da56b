
/* The paper's model: its two yield forces are solved for, Eq. 12, and inverted by formula. */

#define MOMENTS 8          /* of the time for which a duty will stand */
#define SECANTS 4          /* towards a duty between two that are near each other */

typedef struct {
    real sigma, beta, T;
} Law;

static Law law_of(const Settings *p, int up)
{
    Law law;
    law.sigma = up ? p->compression_sigma : p->release_sigma;
    law.beta = up ? p->compression_beta : p->release_beta;
    law.T = up ? p->compression_T_d : p->release_T_d;
    return law;
}

/* sigma v^beta, Eq. 11 [N]. */
static real steady_force(const Law *law, real duty)
{
    return duty > K(0.0) ? law->sigma * POW(duty, law->beta) : K(0.0);
}

/* Its inverse; 2 where no duty gives the force, 0 where it would have to push. */
static real duty_for(const Law *law, real force)
{
    if (!(force > K(0.0)) || !(law->sigma > K(0.0)))
        return K(0.0);
    return force > law->sigma ? K(2.0) : POW(force / law->sigma, K(1.0) / law->beta);
}

/* The yield force at the end of a time in which the motion may turn once:
       F_end = a F + before u_1 + after u_2,
   u_1 and u_2 the steady forces of the duty before and after the turn. Exact for a held duty. */
typedef struct {
    real a, before, after;
} Span;

/* 1 - exp(-h / T) */
static real gone(real h, real T)
{
    return T > K(0.0) ? -EXPM1(-h / T) : h > K(0.0) ? K(1.0) : K(0.0);
}

static Span span_of(real h, const Law *law)
{
    Span out;
    out.before = gone(h, law->T);
    out.a = K(1.0) - out.before;
    out.after = K(0.0);
    return out;
}

static Span turned_span(real h, real part, const Law *first, const Law *then)
{
    const real lost_1 = gone(part * h, first->T), lost_2 = gone(h - part * h, then->T);
    Span out;
    out.a = (K(1.0) - lost_1) * (K(1.0) - lost_2);
    out.before = lost_1 * (K(1.0) - lost_2);
    out.after = lost_2;
    return out;
}

/* Part of a step that passes before the motion turns, from the straight line between velocities. */
static real part_before(real xdot0, real xdot)
{
    const real change = xdot0 - xdot;
    return change == K(0.0) ? K(0.0) : clamped(xdot0 / change, K(0.0), K(1.0));
}

/* The duty with which F_ER meets its goal at the end of a span, above `top` where none does. */
static real meeting(real ask, const Span *span, const Law *law, const Law *turned, real top)
{
    real low, high, f_low, f_high, next, f;
    int i;
    if (!(ask > K(0.0)))
        return K(0.0);
    if (!(span->after > K(0.0)))
        return duty_for(law, ask / span->before);
    if (!(span->before > K(0.0)))
        return duty_for(turned, ask / span->after);
    next = ask / (span->before + span->after);
    low = duty_for(law, next);
    high = duty_for(turned, next);
    if (low == high)
        return low;
    /* Each law alone is short of the goal at the lower of these duties, or beyond it at the other. */
    if (low > high) {
        next = low;
        low = high;
        high = next;
    }
    low = clamped(low, K(0.0), top);
    high = clamped(high, K(0.0), top);
    f_low = span->before * steady_force(law, low) + span->after * steady_force(turned, low) - ask;
    f_high = span->before * steady_force(law, high) + span->after * steady_force(turned, high) - ask;
    if (f_high < K(0.0))
        return K(2.0);
    for (i = 0; i < SECANTS && f_low != f_high; i++) {
        next = clamped(high - f_high * (high - low) / (f_high - f_low), K(0.0), top);
        f = span->before * steady_force(law, next) + span->after * steady_force(turned, next) - ask;
        low = high;
        f_low = f_high;
        high = next;
        f_high = f;
    }
    return high;
}

/* Both yield forces at the end of a time dt [s], over which the duties were held. */
static void relax(Emulator *s, const Span *span, int up, int turned_up)
{
    const real *u = s->steady;
    s->healthy = span->a * s->healthy + span->before * u[up ? 0 : 1]
        + span->after * u[turned_up ? 0 : 1];
    s->made = span->a * s->made + span->before * u[up ? 2 : 3] + span->after * u[turned_up ? 2 : 3];
}

/* Steady forces of a duty, kept for as long as it is held: powers cost. */
static void set_steady(Emulator *s, int which, real duty)
{
    const Law compression = law_of(&s->p, 1), release = law_of(&s->p, 0);
    s->steady[which] = steady_force(&compression, duty);
    s->steady[which + 1] = steady_force(&release, duty);
}

/* The same where the parameters have been changed in between. */
static void renew(Emulator *s)
{
    const Law compression = law_of(&s->p, 1), release = law_of(&s->p, 0);
    if (s->of[0] == compression.sigma && s->of[1] == compression.beta
        && s->of[2] == release.sigma && s->of[3] == release.beta)
        return;
    s->of[0] = compression.sigma;
    s->of[1] = compression.beta;
    s->of[2] = release.sigma;
    s->of[3] = release.beta;
    set_steady(s, 0, s->duty);
    set_steady(s, 2, s->duty_out);
}

/* The good inputs of a sample, after those in `s`. */
static void observe(Emulator *s, real dt, real x, real xdot, real duty)
{
    const int up0 = s->up, up = xdot > K(0.0) || (xdot == K(0.0) && up0);
    const Law law = law_of(&s->p, up0), then = law_of(&s->p, up);
    const int first = !s->moved;
    Span span;
    (void)x;
    if (!first && (up == up0 || !s->turning)) {
        span = span_of(dt, &law);
        relax(s, &span, up, up);
    } else if (!first) {
        span = turned_span(dt, part_before(s->xdot, xdot), &law, &then);
        relax(s, &span, up0, up);
    }
    if (first || duty != s->duty)
        set_steady(s, 0, duty);
    if (first)
        s->healthy = s->steady[up ? 0 : 1];
    s->up = up;
    s->turning = s->turning || xdot != K(0.0);
}

/* A time dt without good inputs. */
static void observe_blind(Emulator *s, real dt)
{
    const Law law = law_of(&s->p, s->up);
    const Span span = span_of(dt, &law);
    relax(s, &span, s->up, s->up);
}

/* What the amplifier has from this sample on. */
static void settle(Emulator *s, real dt, int starts)
{
    (void)dt;
    if (s->duty_out != s->settled)
        set_steady(s, 2, s->duty_out);
    s->settled = s->duty_out;
    if (starts)
        s->made = s->steady[s->up ? 2 : 3];
}

/* What is left of the gas, the viscous and the yield force, Eqs. 20, 22, 23. */
typedef struct {
    real gas, viscous, yield;
} Left;

static Left left_of(const Emulator *s)
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
static real target_of(const Settings *p, Left g, int up, real direction, real x, real xdot, real F)
{
    const real k_nom = up ? p->compression_k_nom : p->release_k_nom;
    const real c_vis = up ? p->compression_c_vis : p->release_c_vis;
    const real others = (g.gas - K(1.0)) * k_nom * x + (g.viscous - K(1.0)) * c_vis * xdot;
    return direction * others + g.yield * F;
}

static real target_now(const Emulator *s)
{
    const real direction = s->xdot > K(0.0) ? K(1.0) : s->xdot < K(0.0) ? K(-1.0) : K(0.0);
    return target_of(&s->p, left_of(s), s->up, direction, s->x, s->xdot, s->healthy);
}

static int unreachable(const Emulator *s)
{
    return target_now(s) < K(0.0);
}

/* The duty that is nearest, in the mean of squares over the time h for which it will stand, to the
   target at each of some moments in it. A later one counts more: there the next duty begins. */
static real best_over(const Emulator *s, real h, Left g, real top)
{
    const Law laws[2] = {law_of(&s->p, 0), law_of(&s->p, 1)};
    const real part = h / K(MOMENTS);
    real x = s->x, xdot = s->xdot, healthy = s->healthy, kept = K(1.0), ask = K(0.0), target, ends[2];
    real shares[2] = {K(0.0), K(0.0)}; /* of the duty's steady forces, release and compression */
    Span span = {K(0.0), K(0.0), K(0.0)};
    int up = s->up, i, leg, turns;
    for (i = 1; i <= MOMENTS; i++) {
        const real next = speed_ahead(s, part * (real)i);
        real weight;
        turns = up ? next < K(0.0) : next > K(0.0);
        ends[0] = turns ? part_before(xdot, next) * part : part;
        ends[1] = part - ends[0];
        for (leg = 0; leg <= turns; leg++) {
            const real lost = gone(ends[leg], laws[up].T);
            healthy += (s->steady[up ? 0 : 1] - healthy) * lost;
            kept *= K(1.0) - lost;
            shares[!up] *= K(1.0) - lost;
            shares[up] += (K(1.0) - shares[up]) * lost;
            up = leg < turns ? !up : up;
        }
        x += K(0.5) * part * (xdot + next);
        xdot = next;
        target = target_of(&s->p, g, up, up ? K(1.0) : K(-1.0), x, xdot, healthy);
        target = (target > K(0.0) ? target : K(0.0)) - kept * s->made;
        weight = (real)i * (shares[0] + shares[1]);
        ask += weight * target;
        span.before += weight * shares[s->up];
        span.after += weight * shares[!s->up];
    }
    return meeting(ask, &span, &laws[s->up], &laws[!s->up], top);
}

/* The duty that brings the yield force to the faulty one's target at the next moment at which the
   duty can change. What the motion will be until then is told from the past alone. */
static real wanted_duty(Emulator *s, real dt, real top)
{
    const Settings *p = &s->p;
    const Left g = left_of(s);
    const int up = s->up;
    const Law law = law_of(p, up), turned = law_of(p, !up);
    const real *u = s->steady;
    real h, sweep, x, xdot, part, target;
    int turns;
    Span span;
    if (!(dt > K(0.0))) /* the first sample: the steady force is the one to begin with */
        return duty_for(&law, target_now(s));
    h = until_next(p, dt);
    sweep = p->slew > K(0.0) ? SWEEP * top / p->slew : K(0.0);
    if (h > dt * (K(1.0) + EQUAL) && !(sweep > h))
        return best_over(s, h, g, top);
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

static int usable_model(const Settings *p)
{
    return positive(p->compression_k_nom, K(1e9)) && positive(p->release_k_nom, K(1e9))
        && positive(p->compression_c_vis, K(1e9)) && positive(p->release_c_vis, K(1e9))
        && positive(p->compression_T_d, K(1e6)) && positive(p->release_T_d, K(1e6))
        && positive(p->compression_sigma, K(1e9)) && positive(p->release_sigma, K(1e9))
        && within(p->compression_beta, K(1e-2), K(1e2)) && within(p->release_beta, K(1e-2), K(1e2));
}

static void begin(Emulator *s)
{
    s->up = 1;
}

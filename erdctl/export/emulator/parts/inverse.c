
/* The yield force, Eq. 12, and its inverse. */

typedef struct {
    real sigma, beta, T;
} Law;

static Law law_of(const Params *p, int up)
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


/* The amplifier: which duties it knows, and how it goes from one to another. */

/* count * step; of a decimal step the decimal: 3 * 0.1 is 0.3, not 0.30000000000000004. */
static real of_steps(real count, real step)
{
    const real parts = RINT(K(1.0) / step);
    return FABS(parts * step - K(1.0)) < EQUAL ? count / parts : count * step;
}

/* The highest duty: the last step of the resolution below the ceiling. */
static real highest(const Settings *p)
{
    const real step = p->resolution;
    return step > K(0.0) ? of_steps(FLOOR(p->duty_max / step + EQUAL), step) : p->duty_max;
}

/* The duty that the amplifier knows nearest to a wanted one. */
static real nearest(const Settings *p, real top, real wanted)
{
    const real inside = clamped(wanted, K(0.0), top);
    if (!(p->resolution > K(0.0)))
        return inside;
    return clamped(of_steps(RINT(inside / p->resolution), p->resolution), K(0.0), top);
}

/* The same, but a given duty that it knows but for rounding stays as it is, bit for bit. */
static real given(const Settings *p, real top, real duty)
{
    const real found = nearest(p, top, duty);
    return FABS(found - duty) <= ON_GRID * p->resolution && duty <= top ? duty : found;
}

/* Time until the next sample at which the duty can change, if it changes at one now [s]. */
static real until_next(const Settings *p, real dt)
{
    const real parts = p->update_period / dt;
    return parts > K(1.0) ? CEIL(parts * (K(1.0) - EQUAL)) * dt : dt;
}

/* Time since the latest sample at which the last change could have been [s], or less. */
static real elapsed(const Emulator *s, real dt)
{
    const real next = until_next(&s->p, dt);
    /* With uneven steps nobody knows it without a memory of all: then the least that it can be. */
    return s->even >= next * (K(1.0) - EQUAL) || dt >= s->p.update_period ? next : s->p.update_period;
}

/* The duty that follows the last on the way to a target that the amplifier knows. */
static real towards(const Emulator *s, real target, real dt)
{
    const real last = s->duty_out, step = s->p.resolution, slew = s->p.slew;
    const real way = target - last, size = FABS(way);
    real reach, steps, next, at;
    if (!(slew > K(0.0)))
        return target;
    reach = slew * elapsed(s, dt) * (K(1.0) + EQUAL);
    if (size <= reach)
        return target;
    if (!(step > K(0.0)))
        return last + (way > K(0.0) ? reach : -reach) * (K(1.0) - K(2.0) * EQUAL);
    /* `last` may be on the grid but for rounding: the change counts, not the steps. */
    at = RINT(last / step);
    steps = FLOOR(reach / step);
    if (steps > K(0.0)) {
        next = of_steps(way > K(0.0) ? at + steps : at - steps, step);
        if (FABS(next - last) <= reach)
            return next;
        steps -= K(1.0);
    }
    if (steps > K(0.0))
        return of_steps(way > K(0.0) ? at + steps : at - steps, step);
    /* Too short for a whole step: it is due when the time since the last change is enough. */
    next = of_steps(way > K(0.0) ? at + K(1.0) : at - K(1.0), step);
    if (FABS(target - next) <= ON_GRID * step)
        next = target;
    return FABS(next - last) <= slew * s->since_change * (K(1.0) + EQUAL) ? next : last;
}

/* Whether the amplifier can be given another duty now. */
static int may_change(const Emulator *s)
{
    return s->since_change >= s->p.update_period * (K(1.0) - EQUAL);
}

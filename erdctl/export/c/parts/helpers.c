static real clipped(real v, real low, real high)
{
    return v < low ? low : v > high ? high : v;
}

/* Adds to a sum that grows large, with what its digits do not hold. */
static void add_to(real *sum, real *low, real more)
{
    volatile real total;
    real rest = more - *low;

    total = *sum + rest;
    *low = (total - *sum) - rest;
    *sum = total;
}

/* y one step on: dy/ds + y = target, a straight line from target0 to target over e in s, but for a
 * jump in a step that is made of the parts before and after one. */
static real follow(real y, real target0, real target, real e, int jumps, real before, real after)
{
    real gone, fresh;

    if (jumps) {
        y += (target0 - y) * -EXPM1(-before);
        return y + (target - y) * -EXPM1(-after);
    }
    gone = -EXPM1(-e);
    /* 1 - gone / e, whose digits cancel where e is small */
    fresh = e > K(0.01) ? K(1.0) - gone / e
                        : e * (K(0.5) - e * (K(1.0) / K(6.0) - e * (K(1.0) / K(24.0) - e / K(120.0))));
    return y + (target0 - y) * (gone - fresh) + (target - y) * fresh;
}

/* The turn in this step: its place on the straight line between the two speeds. */
static void turn(Sample *s, int joint)
{
    real span = s->xdot0 - s->xdot, last = s->up0 ? K(1.0) : K(0.0), now = s->up ? K(1.0) : K(0.0);

    s->turned = !s->first && s->up != s->up0;
    s->share = last + (now - last) * s->engaged;
    s->before = span > K(0.0) || span < K(0.0) ? s->xdot0 / span : K(0.0);
    s->before = FMIN(FMAX(s->before, K(0.0)), K(1.0));
    /* From rest in the play the piston sets off when that runs out, not as the step begins. */
    if (joint && !(s->xdot0 > K(0.0) || s->xdot0 < K(0.0)))
        s->before = FMIN(K(1.5) - s->engaged, K(1.0));
    if (s->turned) {
        s->after = K(0.5) * FABS(s->xdot) * (K(1.0) - s->before) * s->h;
        s->path = K(0.5) * FABS(s->xdot0) * s->before * s->h + s->after;
    } else {
        s->after = K(0.0);
        s->path = K(0.5) * (FABS(s->xdot0) + FABS(s->xdot)) * s->h;
    }
}

/* Motion in a chain of laws of the joint, as a sample of its own; past: of the one before. */
static void within(Sample *own, const Motion *m, real *past)
{
    own->x = m->x;
    own->xdot = m->xdot;
    own->engaged = m->engaged;
    own->sign = (m->xdot > K(0.0) ? K(1.0) : m->xdot < K(0.0) ? K(-1.0) : K(0.0)) * m->engaged;
    own->x0 = own->first ? m->x : past[0];
    own->xdot0 = own->first ? m->xdot : past[1];
    own->up0 = own->first ? own->up : past[2] > K(0.5);
    own->up = m->xdot > K(0.0) ? 1 : m->xdot < K(0.0) ? 0 : own->up0;
    if (own->first || !(past[3] > K(0.5))) /* the first motion is no turn */
        own->up0 = own->up;
    turn(own, m->joint);
    past[3] = (!own->first && past[3] > K(0.5)) || m->xdot > K(0.0) || m->xdot < K(0.0) ? K(1.0) : K(0.0);
    past[0] = m->x;
    past[1] = m->xdot;
    past[2] = (real)own->up;
}

/* At z the n natural cubic splines that are 1 at one of the knots and 0 at the others. */
static void splines(const real *knots, const real *bends, int n, real z, real *rows)
{
    real at = clipped(z, knots[0], knots[n - 1]), w, a, b, u, v;
    int i = 0, j;

    while (i < n - 2 && at > knots[i + 1])
        i++;
    w = knots[i + 1] - knots[i];
    b = (at - knots[i]) / w;
    a = K(1.0) - b;
    u = w * w / K(6.0) * (a * a * a - a);
    v = w * w / K(6.0) * (b * b * b - b);
    for (j = 0; j < n; j++)
        rows[j] = u * bends[i * n + j] + v * bends[(i + 1) * n + j];
    rows[i] += a;
    rows[i + 1] += b;
}

/* Spring and dashpot of a stop over its stiffness [m]; it pushes and does not pull. */
static real stop_contact(real depth, real speed, real theta, real e)
{
    if (!(depth > K(0.0)))
        return K(0.0);
    return FMAX(depth - theta * speed * EXPM1(-depth / e), K(0.0));
}

/* Integral of min(1, v / edge) from 0 to v. */
static real ramp_area(real v, real edge)
{
    real ramp = clipped(v, K(0.0), edge);

    return (edge > K(0.0) ? ramp * ramp / (K(2.0) * edge) : K(0.0)) + FMAX(v - edge, K(0.0));
}

/* How far a change has set in, a time after its onset: the mean over a step about it of a ramp over
 * t_r. Each case in a form whose digits do not cancel, as the rest of a step is what counts. */
static real onset_weight(real since, real t_r, real step)
{
    real low = since - K(0.5) * step, high = since + K(0.5) * step;

    if (high <= K(0.0) || low >= t_r)
        return low >= t_r ? K(1.0) : K(0.0);
    if (!(step > K(0.0)))
        return since / t_r;
    if (low >= K(0.0))
        return high <= t_r ? since / t_r
                           : K(1.0) - K(0.5) * (t_r - low) / step * ((t_r - low) / t_r);
    return high <= t_r ? K(0.5) * high / step * (high / t_r) : (high - K(0.5) * t_r) / step;
}

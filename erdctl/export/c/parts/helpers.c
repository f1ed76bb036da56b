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

/* How far a change has set in at a time: the mean over a step about it of a ramp from t_0 on. */
static real onset_weight(real t, real t_0, real t_r, real step)
{
    real since = t - t_0, low, high, area;

    if (!(step > K(0.0)))
        return since >= t_r ? K(1.0) : clipped(since / t_r, K(0.0), K(1.0));
    if (since >= K(0.5) * step && since <= t_r - K(0.5) * step)
        return since / t_r;  /* as below, with all its digits */
    low = clipped(since - K(0.5) * step, K(0.0), t_r);
    high = clipped(since + K(0.5) * step, K(0.0), t_r);
    area = t_r > K(0.0) ? K(0.5) * (high - low) * (high + low) / t_r : K(0.0);
    area += clipped(since + K(0.5) * step - t_r, K(0.0), step);
    return clipped(area / step, K(0.0), K(1.0));
}

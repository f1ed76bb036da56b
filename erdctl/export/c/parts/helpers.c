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

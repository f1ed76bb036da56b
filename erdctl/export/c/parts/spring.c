/* A spring in series with the damper, or with its fluid (erdctl.model.series_compliance):
 *
 *     de/dt = xdot - v,  s F = e beyond -g/2..g/2, 0 within,  F = gas(x - e) + viscous(v)
 *         + F_ER sign(v) + friction(v)
 *
 * implicit in v, with a stick branch v = 0; laws of v between their nodes are straight lines. */
enum { NODES = 192 };
typedef struct PREFIX_spring Spring;

static const real SLOWEST = K(0.25);  /* of the speed in a step that the end of it may have */

/* What a step behind the spring is given besides: compliance, half of the free play, stiffness of
 * the gas behind it, factors of the groups. */
typedef struct Joint {
    real s, half, k[2];
    Groups gain;
} Joint;

/* A law that falls goes on as it is beyond its table: on its last line it would turn round. */
static void level_beyond(real law[NODES])
{
    if (FABS(law[NODES - 1]) < FABS(law[NODES - 2]))
        law[NODES - 1] = law[NODES - 2];
}

static void tabulate(State *st)
{
    Sample s;
    Groups f;
    real top = K(4.0) * FMAX(st->p.fastest, K(1e-3));
    int way, j;

    for (j = 0; j < NODES; j++)
        st->grid[j] = K(1e-7) * POW(top / K(1e-7), (real)j / (real)(NODES - 1));
    for (way = 0; way < 2; way++) {
        for (j = 0; j < NODES; j++) {
            memset(&s, 0, sizeof s);
            s.first = 1;
            s.up = s.up0 = way == 0;
            s.share = way == 0 ? K(1.0) : K(0.0);
            s.engaged = K(1.0);
            s.sign = way == 0 ? K(1.0) : K(-1.0);
            s.xdot = s.xdot0 = s.sign * st->grid[j];
            f.gas = f.viscous = f.yield = K(1.0);
            of_speed(st, &s, &f);
            st->viscous_at[way][j] = viscous_law(st, &s) * f.viscous
                                     * (way == 0 ? st->p.compression_c_vis : st->p.release_c_vis);
            st->sign_at[way][j] = sign_law(st, &s) * f.yield;
            st->friction_at[way][j] = friction(st, &s);
        }
        level_beyond(st->sign_at[way]);
        level_beyond(st->friction_at[way]);
    }
}

/* Node above a speed, at least the second. */
static int above(const State *st, real speed)
{
    int low = 0, high = NODES - 1;

    while (high - low > 1) {
        int mid = (low + high) / 2;

        if (st->grid[mid] < speed)
            low = mid;
        else
            high = mid;
    }
    return high;
}

static real between(const real *law, int j, real w)
{
    return law[j - 1] * (K(1.0) - w) + law[j] * w;
}

static real part_of(const State *st, int j, real speed)
{
    return clipped((speed - st->grid[j - 1]) / (st->grid[j] - st->grid[j - 1]), K(0.0), K(1.0));
}

/* Force of the spring at a stretch. */
static real held(real e, const Joint *to)
{
    return (FMAX(e - to->half, K(0.0)) + FMIN(e + to->half, K(0.0))) / to->s;
}

/* Force of the damper beyond that of the spring, at node j. */
static real excess(const State *st, const Joint *to, real e, real x, real Y, int way, int j)
{
    return to->k[way] * (x - e) - held(e, to) + st->viscous_at[way][j] * to->gain.viscous
           + Y * st->sign_at[way][j] + st->friction_at[way][j];
}

/* One leg in one direction of the rod: its mean speed and the last, x as it ends, Y then. */
static void advance(const State *st, Spring *b, const Joint *to, real mean, real end, real dt,
                    real x, real Y)
{
    real e = b->stretch + mean * dt, ahead = K(1.0), way, span, rest, at_low, at_high, h, share;
    real slow, fast;
    int branch, low, high, mid, reach, side;

    if (mean * end > K(0.0))
        ahead = FMIN(FMAX(end / mean, SLOWEST), K(2.0));
    b->stretch = e;
    b->speed = K(0.0);
    for (branch = 0; branch < 2; branch++) {
        way = branch == 0 ? K(1.0) : K(-1.0);
        span = mean * way > K(0.0) ? dt / ahead : dt;
        rest = to->k[branch] * (x - e) - held(e, to);
        rest += Y * st->sign_at[branch][0] + st->friction_at[branch][0];
        if (rest * way >= K(0.0))
            continue;
        low = 0;
        high = NODES - 1;
        /* Speeds change little from sample to sample: outwards from the last in growing steps. */
        mid = b->near < 1 ? 1 : b->near > NODES - 2 ? NODES - 2 : b->near;
        reach = 1;
        while (high - low > 1) {
            h = excess(st, to, e - way * st->grid[mid] * span, x, Y, branch, mid);
            if (h * way < K(0.0))
                low = mid;
            else
                high = mid;
            if (low > 0 && high < NODES - 1) {
                mid = (low + high) / 2;
            } else if (high == NODES - 1) {
                mid = low + reach < high ? (low + reach < NODES - 2 ? low + reach : NODES - 2)
                                         : (low + high) / 2;
                reach *= 4;
            } else {
                mid = high - reach > low ? (high - reach > 1 ? high - reach : 1)
                                         : (low + high) / 2;
                reach *= 4;
            }
        }
        at_low = excess(st, to, e - way * st->grid[low] * span, x, Y, branch, low);
        at_high = excess(st, to, e - way * st->grid[high] * span, x, Y, branch, high);
        slow = st->grid[low];
        fast = st->grid[high];
        /* The spring bends where it loses or takes up its play: straight on either side. */
        for (side = 0; to->half > K(0.0) && span > K(0.0) && side < 2; side++) {
            real edge = side == 0 ? to->half : -to->half, u = way * (e - edge) / span, w;

            if (!(u > slow && u < fast))
                continue;
            w = (u - st->grid[low]) / (st->grid[high] - st->grid[low]);
            h = to->k[branch] * (x - edge) - held(edge, to)
                + between(st->viscous_at[branch], high, w) * to->gain.viscous
                + Y * between(st->sign_at[branch], high, w)
                + between(st->friction_at[branch], high, w);
            if (h * way < K(0.0)) {
                slow = u;
                at_low = h;
            } else {
                fast = u;
                at_high = h;
            }
        }
        share = FABS(at_high - at_low) > K(0.0) ? -at_low / (at_high - at_low) : K(0.0);
        b->speed = way * (slow + share * (fast - slow));
        b->stretch = e - b->speed * span;
        b->near = low;
        return;
    }
    b->near = 1;
}

/* No step lies before the first sample: it begins with the spring's force steady. */
static void set_out(const State *st, Spring *b, const Joint *to, const Sample *s, real x,
                    const real u[2])
{
    int way = s->up ? 0 : 1, j = above(st, FABS(s->xdot));
    int still = (s->rests && to->half > K(0.0)) || !(FABS(s->xdot) > K(0.0));
    real w = part_of(st, j, FABS(s->xdot)), moving = K(0.0), F;

    b->up = s->up;
    b->yielding = u[way];
    if (!still)
        moving = between(st->viscous_at[way], j, w) * to->gain.viscous
                 + between(st->sign_at[way], j, w) * b->yielding * to->gain.yield
                 + between(st->friction_at[way], j, w);
    F = (to->k[way] * x + moving) / (K(1.0) + to->k[way] * to->s);
    b->near = j - 1;
    b->stretch = to->s * F + (still ? K(0.0) : F > K(0.0) ? to->half : -to->half);
    b->speed = s->xdot;
    b->faces = s->up;
}

/* One sample; returns the force of the spring. A step in which the rod turns has two legs. */
static real march(const State *st, Spring *b, const Joint *to, const Sample *s, real x,
                  const real u[2])
{
    real v0 = s->xdot0, v1 = s->xdot, mean, end, span, x_end, before, lag;
    int leg, way, turning = v0 * v1 < K(0.0);

    if (s->first) {
        set_out(st, b, to, s, x, u);
        return held(b->stretch, to);
    }
    before = turning ? v0 / (v0 - v1) * s->h : s->h;
    for (leg = 0; leg < (turning ? 2 : 1); leg++) {
        mean = K(0.5) * (v0 + v1);
        end = v1;
        span = s->h;
        x_end = x;
        if (turning && leg == 0) {
            mean = K(0.5) * v0;
            end = K(0.0);
            span = before;
            x_end = st->gas_past + mean * span;
        } else if (turning) {
            mean = K(0.5) * v1;
            span = s->h - before;
        }
        way = b->up ? 0 : 1;
        lag = FMAX(way == 0 ? st->p.compression_T_d : st->p.release_T_d, K(1e-9));
        lag *= FABS(u[way]) < FABS(b->yielding) ? st->falls : st->rises;
        b->yielding += (u[way] - b->yielding) * -EXPM1(-span / lag);
        advance(st, b, to, mean, end, span, x_end, b->yielding * to->gain.yield);
        if (b->speed > K(0.0) || b->speed < K(0.0))
            b->up = b->speed > K(0.0);
    }
    if (b->speed > K(0.0) || b->speed < K(0.0))
        b->faces = b->speed > K(0.0);
    return held(b->stretch, to);
}

/* Forces of the groups as they are behind the spring, of a force of it. */
static Groups behind(const State *st, const Spring *b, const Joint *to, const Sample *s, real x,
                     real force)
{
    Groups out;
    real speed = FABS(b->speed), friction_now = K(0.0);
    int way = b->speed > K(0.0) ? 0 : 1, j = above(st, speed);
    real w = part_of(st, j, speed);

    out.viscous = K(0.0);
    if (speed > K(0.0)) {
        out.viscous = between(st->viscous_at[way], j, w) * to->gain.viscous;
        friction_now = between(st->friction_at[way], j, w);
    }
    if (WHOLE) {
        out.gas = (x - b->stretch) * to->k[b->faces ? 0 : 1];
        out.yield = force - out.gas - out.viscous - friction_now;
    } else {
        out.gas = x * along(s, st->p.compression_k_nom, st->p.release_k_nom) * to->gain.gas;
        out.yield = force - out.viscous;
    }
    return out;
}

static Joint joint_of(const State *st, const Groups *gain)
{
    Joint to;

    to.s = compliance(st);
    to.half = K(0.5) * free_play(st);
    to.k[0] = WHOLE ? st->p.compression_k_nom * gain->gas : K(0.0);
    to.k[1] = WHOLE ? st->p.release_k_nom * gain->gas : K(0.0);
    to.gain = *gain;
    return to;
}

static real in_series(State *st, const Sample *s)
{
    Groups gain, parts;
    Joint to;
    real x = gas_law(st, s), u[2], force;

    u[0] = steady(st, s, 0);
    u[1] = steady(st, s, 1);
    gain.gas = gain.viscous = gain.yield = K(1.0);
    scale(st, s, &gain);
    fail(st, &gain);
@FEEDBACK@    to = joint_of(st, &gain);
    force = march(st, &st->spring[@LAST@], &to, s, x, u);
    parts = behind(st, &st->spring[@LAST@], &to, s, x, force);
    st->gas_past = x;
    return force + (WHOLE ? K(0.0) : parts.gas) + outside(st, s) + driven(st, s, &parts);
}

static real acting(State *st, const Sample *s)
{
    return compliance(st) > K(0.0) ? in_series(st, s) : parallel(st, s);
}

/* A spring in series with the damper, or with its fluid (erdctl.model.series_compliance):
 *
 *     de/dt = xdot - v,  F = e / s beyond -g/2..g/2, 0 within, + c de/dt,
 *     F = gas(x - e) + viscous(v) + F_ER sign(v) + friction(v)
 *
 * implicit in v, with a stick branch v = 0; laws of v between their nodes are straight lines. */
enum { NODES = 256 };
typedef struct PREFIX_spring Spring;

static const real BEGUN = K(0.16);  /* s that a first force has acted before: as in 1 Hz */
static const real LONGEST = K(4.0);  /* of the mean speed in a step over the last one */
/* Of the spring's force, which it takes to move a piston: above rounding. */
static const real NEARLY = sizeof(real) < sizeof(double) ? K(3e-6) : K(1e-12);

/* What a step behind the spring is given besides: compliance, half of the free play, damping,
 * stiffness of the gas behind it, factors of the groups, forces that the rod's motion makes, divisor
 * of the speed in the sign law. */
typedef struct Joint {
    real s, half, c, k[2];
    Groups gain;
    real beside, by;
} Joint;

/* A step, or a part of it, in one direction of the rod, as it ends: its length, x of the gas force,
 * deflection of the rod, forces beside, F_ER, and as it began; slope of mass and damping by the
 * piston's speed, and their force at rest; its speed if it is accelerated as the rod, and if as in
 * its last step. */
typedef struct Leg {
    real dt, x, rod, beside, Y, Y0, pull, push, level, kept;
} Leg;

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
            s.engaged = s.duty = s.duty0 = K(1.0);
            s.sign = way == 0 ? K(1.0) : K(-1.0);
            s.xdot = s.xdot0 = s.sign * st->grid[j];
            f.gas = f.viscous = f.yield = K(1.0);
            of_speed(st, &s, &f);
            st->viscous_at[way][j] = viscous_law(st, &s) * f.viscous
                                     * (way == 0 ? st->p.compression_c_vis : st->p.release_c_vis);
            st->sign_at[way][j] = sign_law(st, &s) * (OTHER ? K(1.0) : f.yield);
            st->factor_at[way][j] = OTHER ? f.yield : K(1.0);
            st->friction_at[way][j] = friction(st, &s);
        }
        level_beyond(st->sign_at[way]);
        level_beyond(st->factor_at[way]);
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

/* The sign law at a speed v, at 0 from the side `way` (0 compression, 1 release). */
static real sign_along(const State *st, real v, int way)
{
    real speed = FABS(v);
    int j = above(st, speed);

    way = v > K(0.0) ? 0 : v < K(0.0) ? 1 : way;
    return between(st->sign_at[way], j, part_of(st, j, speed));
}

/* What jumps in the sign law with the direction of a speed, at 0 with the side `way`. */
static real jump_of(const State *st, real v, int way)
{
    real jump = K(0.5) * (st->sign_at[0][0] - st->sign_at[1][0]);

    return v < K(0.0) || (!(v > K(0.0)) && way == 1) ? -jump : jump;
}

/* Signed yield force at a speed v of the piston, its sign law there but for the jump, and the
 * hysteretic variable. It follows a straight line, in which what jumps has the direction of now from
 * the start. */
static real followed(const State *st, const Spring *b, const Joint *to, const Leg *leg, real v,
                     int way, real travel, real e, real *smooth, real *h)
{
    real T = yield_time(st), d = yield_travel(st), z, gone, fresh;
    real sheared = (v + sign_lead(st) * (leg->rod - e)) / to->by;
    real law = sign_along(st, sheared, way), jump = jump_of(st, sheared, way);

    *smooth = law - jump;
    *h = b->h;
    if (!(T > K(0.0)) && !(d > K(0.0)))
        return leg->Y * law;
    z = T > K(0.0) ? leg->dt / T : travel / d;
    if (!(z > K(0.0)))
        return T > K(0.0) ? b->was : leg->Y * b->h;
    gone = -EXPM1(-z);
    fresh = K(1.0) - gone / z;
    if (T > K(0.0))
        return (K(1.0) - gone) * b->was + (gone - fresh) * leg->Y0 * (b->smooth + jump)
               + fresh * leg->Y * law;
    *h = (K(1.0) - gone) * b->h + (gone - fresh) * (b->smooth + jump) + fresh * law;
    return leg->Y * *h;
}

/* Part of the friction that follows the direction, after a travel of the piston. */
static real slid(const State *st, const Spring *b, int way, real travel)
{
    real there = way == 0 ? K(1.0) : K(-1.0);

    return there + (b->z - there) * EXP(-travel / slide_travel(st));
}

/* Force of the damper beyond that of the spring, at a speed u a part w of the way from node j to
 * the next; e is the stretch that the rod alone would leave. */
static real excess(const State *st, const Spring *b, const Joint *to, const Leg *leg, real u, int j,
                   real w, int way, real span, real e)
{
    real direction = way == 0 ? K(1.0) : K(-1.0), at = e - direction * u * span, yields, smooth, h;

    if (OTHER)
        yields = followed(st, b, to, leg, direction * u, way, u * span, at, &smooth, &h)
                 * between(st->factor_at[way], j + 1, w);
    else
        yields = leg->Y * between(st->sign_at[way], j + 1, w);
    return to->k[way] * (leg->x - at) + leg->beside - held(at, to)
           + leg->pull * direction * u - leg->push
           + between(st->viscous_at[way], j + 1, w) * to->gain.viscous + yields * to->gain.yield
           + between(st->friction_at[way], j + 1, w)
           + (SLIDES ? slide_force(st) * slid(st, b, way, u * span) : K(0.0));
}

/* The same of a piston that is about to move. */
static real starting(const State *st, const Spring *b, const Joint *to, const Leg *leg, int way,
                     real e)
{
    real yields = leg->Y * st->sign_at[way][0], smooth, h;

    if (OTHER)
        yields = followed(st, b, to, leg, K(0.0), way, K(0.0), e, &smooth, &h)
                 * st->factor_at[way][0];
    return to->k[way] * (leg->x - e) + leg->beside - held(e, to) - leg->push
           + yields * to->gain.yield + st->friction_at[way][0]
           + (SLIDES ? slide_force(st) * b->z : K(0.0));
}

/* What sticks is held by as much of what it could take from either side as balances the rest. */
static void stick(const State *st, Spring *b, const Joint *to, const Leg *leg, real e)
{
    real smooth, h, up, down, go, apart;

    b->near = 1;
    if (OTHER) {
        down = followed(st, b, to, leg, K(0.0), 1, K(0.0), e, &smooth, &h);
        up = followed(st, b, to, leg, K(0.0), 0, K(0.0), e, &smooth, &h);
        go = starting(st, b, to, leg, 0, e);
        apart = go - starting(st, b, to, leg, 1, e);
        b->was = up + (down - up) * (apart > K(0.0) ? clipped(go / apart, K(0.0), K(1.0)) : K(0.5));
        b->smooth = smooth;
    }
}

/* Mean speed over the last one, in the direction of a branch, of a piston that would go from one
 * speed to another. Without a jump, but at rest: rounding must not move the force. */
static real mean_part(real first, real last)
{
    if (first > K(0.0)) {
        if (last > K(0.0))
            return FMIN(K(0.5) * (first + last) / last, LONGEST);
        return FMAX(LONGEST + (LONGEST - K(1.0)) * last / first, K(1.0));
    }
    if (last > K(0.0))
        return first < K(0.0) ? FMAX(K(1.0) + K(0.5) * last / first, K(0.5)) : K(0.5);
    return K(1.0);
}

/* Last speed of a piston that moves on a branch, and the node below it: the excess grows with it. */
static real speed_on(const State *st, const Spring *b, const Joint *to, const Leg *leg, int branch,
                     real span, real e, int *node)
{
    real way = branch == 0 ? K(1.0) : K(-1.0), at_low, at_high, slow, fast, share, u, h;
    int low, high, mid, reach, side;

    low = 0;
    high = NODES - 1;
    /* Speeds change little from sample to sample: outwards from the last in growing steps. */
    mid = b->near < 1 ? 1 : b->near > NODES - 2 ? NODES - 2 : b->near;
    reach = 1;
    while (high - low > 1) {
        h = excess(st, b, to, leg, st->grid[mid], mid, K(0.0), branch, span, e);
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
    at_low = excess(st, b, to, leg, st->grid[low], low, K(0.0), branch, span, e);
    at_high = excess(st, b, to, leg, st->grid[high], low, K(1.0), branch, span, e);
    slow = st->grid[low];
    fast = st->grid[high];
    if (low == 0 && at_low * way >= K(0.0)) { /* below the first node, where it may bend as well */
        fast = slow;
        at_high = at_low;
        slow = K(0.0);
        at_low = excess(st, b, to, leg, slow, 0, -st->grid[0] / (st->grid[1] - st->grid[0]), branch,
                        span, e);
    }
    /* The spring bends where it loses or takes up its play: straight on either side. */
    for (side = 0; to->half > K(0.0) && span > K(0.0) && side < 2; side++) {
        u = way * (e - (side == 0 ? to->half : -to->half)) / span;
        if (!(u > slow && u < fast))
            continue;
        h = excess(st, b, to, leg, u, low,
                   (u - st->grid[low]) / (st->grid[high] - st->grid[low]), branch, span, e);
        if (h * way < K(0.0)) {
            slow = u;
            at_low = h;
        } else {
            fast = u;
            at_high = h;
        }
    }
    share = FABS(at_high - at_low) > K(0.0) ? -at_low / (at_high - at_low) : K(0.0);
    *node = low;
    return slow + share * (fast - slow);
}

/* One leg, by the rod's mean speed and the last. */
static void advance(const State *st, Spring *b, const Joint *to, const Leg *leg, real mean,
                    real end)
{
    real dt = leg->dt, e = b->stretch + mean * dt, began = b->speed, way, span, part, u, smooth, h;
    real nearly = NEARLY * FABS(held(e, to) + to->c * end), go = K(0.0), last, lag, start, least;
    real stiff = dt + to->c * to->s;
    real fastest = FMAX(FMAX(FABS(began), FABS(end)),
                        FMAX(FABS(K(2.0) * mean - end), K(1e-12)));
    int branch, node = b->near;

    /* Of a piston accelerated as the rod, the more the stiffer the spring, or as it was. */
    node = node < 0 ? 0 : node > NODES - 2 ? NODES - 2 : node;
    branch = b->speed > K(0.0) ? 0 : 1;
    lag = FABS(st->viscous_at[branch][node + 1] - st->viscous_at[branch][node])
          / (st->grid[node + 1] - st->grid[node]) * to->gain.viscous * to->s;
    last = leg->kept + (leg->level - leg->kept) * (stiff / FMAX(stiff + lag, K(1e-12)));
    b->stretch = e;
    b->speed = K(0.0);
    for (branch = 0; branch < 2; branch++) {
        way = branch == 0 ? K(1.0) : K(-1.0);
        part = mean_part(began * way, last * way);
        span = dt * part;
        start = starting(st, b, to, leg, branch, e);
        if (branch == 0)
            go = start;
        if (start * way >= -nearly || (branch == 1 && go <= nearly))
            continue;
        u = speed_on(st, b, to, leg, branch, span, e, &node);
        least = mean * way / fastest;
        if (u > fastest && part < least) { /* no spring makes the piston outrun the rod */
            real slower = speed_on(st, b, to, leg, branch, dt * least, e, &node);
            real share = slower < fastest ? (u - fastest) / (u - slower) : K(1.0);

            span = dt * (part + (least - part) * share);
            u = speed_on(st, b, to, leg, branch, span, e, &node);
        }
        b->speed = way * u;
        b->stretch = e - b->speed * span;
        b->near = node;
        if (OTHER) {
            b->was = followed(st, b, to, leg, b->speed, branch, u * span, b->stretch, &smooth, &h);
            b->smooth = smooth;
            b->h = h;
        }
        b->z = SLIDES ? slid(st, b, branch, u * span) : K(0.0);
        return;
    }
    stick(st, b, to, leg, e);
}

/* Force of the first sample. No step lies before it: it begins with the spring's force steady, as
 * far as its damping lets it be by then. */
static real set_out(const State *st, Spring *b, const Joint *to, const Sample *s, real x,
                    const real u[2])
{
    int way = s->up ? 0 : 1, j = above(st, FABS(s->xdot)), i;
    int still = (s->rests && to->half > K(0.0)) || !(FABS(s->xdot) > K(0.0));
    real w = part_of(st, j, FABS(s->xdot)), rest = to->beside, F;
    real soft = to->s / (K(1.0) + to->c * to->s / BEGUN);

    b->z = s->xdot > K(0.0) ? K(1.0) : s->xdot < K(0.0) ? K(-1.0) : K(0.0);
    rest += SLIDES ? slide_force(st) * b->z : K(0.0);

    b->up = s->up;
    b->yielding = u[way];
    b->was = b->smooth = b->h = K(0.0);
    if (still) { /* what rubs holds what it can of them */
        real held_by[2];

        for (i = 0; i < 2; i++)
            held_by[i] = u[i] * st->sign_at[i][0] * st->factor_at[i][0] * to->gain.yield
                         + st->friction_at[i][0];
        rest -= clipped(rest, held_by[1], held_by[0]);
    } else {
        real sheared = (s->xdot + sign_lead(st) * s->x) / to->by, law = sign_along(st, sheared, way);

        b->h = law;
        b->was = b->yielding * law;
        b->smooth = law - jump_of(st, sheared, 1);
        rest += between(st->viscous_at[way], j, w) * to->gain.viscous
                + b->was * to->gain.yield * between(st->factor_at[way], j, w)
                + between(st->friction_at[way], j, w);
    }
    F = (to->k[way] * x + rest) / (K(1.0) + to->k[way] * soft);
    b->near = j - 1;
    b->stretch = soft * F + (still ? K(0.0) : F > K(0.0) ? to->half : -to->half);
    b->speed = s->xdot;
    b->rate = b->pulled = K(0.0);
    b->faces = s->up;
    b->beside = to->beside;
    return F;
}

/* One sample; returns the force of the spring. A step in which the rod turns has two legs. */
static real march(const State *st, Spring *b, const Joint *to, const Sample *s, real x,
                  const real u[2])
{
    real v0 = s->xdot0, v1 = s->xdot, was = b->speed, mean, end, begun, part, lag;
    real pull;
    int leg, way, turning = v0 * v1 < K(0.0);
    Leg now;

    if (s->first)
        return set_out(st, b, to, s, x, u);
    part = turning ? v0 / (v0 - v1) : K(1.0);
    for (leg = 0; leg < (turning ? 2 : 1); leg++) {
        mean = K(0.5) * (v0 + v1);
        end = v1;
        begun = v0;
        now.dt = s->h;
        now.x = x;
        now.rod = s->x;
        now.beside = to->beside;
        if (turning && leg == 0) {
            mean = K(0.5) * v0;
            end = K(0.0);
            now.dt = part * s->h;
            now.x = st->gas_past + mean * now.dt;
            now.rod = s->x0 + mean * now.dt;
            now.beside = b->beside + (to->beside - b->beside) * part;
        } else if (turning) {
            mean = K(0.5) * v1;
            begun = K(0.0);
            now.dt = s->h - part * s->h;
        }
        way = b->up ? 0 : 1;
        lag = FMAX(way == 0 ? st->p.compression_T_d : st->p.release_T_d, K(1e-9));
        lag *= FABS(u[way]) < FABS(b->yielding) ? st->falls : st->rises;
        now.Y0 = b->yielding;
        b->yielding += (u[way] - b->yielding) * -EXPM1(-now.dt / lag);
        now.Y = b->yielding;
        pull = piston_mass(st) / FMAX(now.dt, K(1e-9));
        now.level = end + b->speed - begun;
        now.pull = pull + to->c;
        now.push = pull * now.level + to->c * end;
        now.kept = b->speed + b->rate * now.dt;
        advance(st, b, to, &now, mean, end);
        b->pulled = pull * (b->speed - now.level);
        if (FABS(b->speed) >= st->grid[0]) /* rounding turns what comes to rest */
            b->up = b->speed > K(0.0);
    }
    b->rate = (b->speed - was) / FMAX(s->h, K(1e-9));
    if (b->speed > K(0.0) || b->speed < K(0.0))
        b->faces = b->speed > K(0.0);
    b->beside = to->beside;
    return held(b->stretch, to) + to->c * (v1 - b->speed);
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
        out.yield = force - out.gas - out.viscous - friction_now - to->beside
                    - b->pulled - (SLIDES ? slide_force(st) * b->z : K(0.0));
    } else {
        out.gas = x * along(s, st->p.compression_k_nom, st->p.release_k_nom) * to->gain.gas;
        out.yield = force - out.viscous;
    }
    return out;
}

static Joint joint_of(State *st, const Sample *s, const Groups *gain, real besides)
{
    Joint to;

    to.s = compliance(st);
    to.half = K(0.5) * free_play(st);
    to.c = spring_damping(st);
    to.k[0] = WHOLE ? st->p.compression_k_nom * gain->gas : K(0.0);
    to.k[1] = WHOLE ? st->p.release_k_nom * gain->gas : K(0.0);
    to.gain = *gain;
    to.beside = besides;
    to.by = sign_by(st, s);
    return to;
}

static real in_series(State *st, const Sample *s)
{
    Groups gain, parts;
    Joint to;
    real x = gas_law(st, s), besides = beside(st, s), u[2], force;

    u[0] = steady(st, s, 0);
    u[1] = steady(st, s, 1);
    gain.gas = gain.viscous = gain.yield = K(1.0);
    scale(st, s, &gain);
    fail(st, &gain);
@FEEDBACK@    to = joint_of(st, s, &gain, besides);
    force = march(st, &st->spring[@LAST@], &to, s, x, u);
    parts = behind(st, &st->spring[@LAST@], &to, s, x, force);
    st->gas_past = x;
    return force + (WHOLE ? K(0.0) : parts.gas) + outside(st, s) + driven(st, s, &parts);
}

static real acting(State *st, const Sample *s)
{
    return compliance(st) > K(0.0) ? in_series(st, s) : parallel(st, s);
}

static const real MOST = K(1e6);       /* [m], [m/s], [s] of an input: far beyond any damper */
static const real HUGEST = K(1e30);    /* [N] */
static const real AT_ONCE = K(1e-12);  /* [s] a time constant of none */

static int usable(real v, real most)
{
    return FABS(v) <= most;
}

static real along(const Sample *s, real compression, real release)
{
    return s->share >= K(1.0) ? compression
           : s->share <= K(0.0) ? release : release + (compression - release) * s->share;
}

static void tabulate(State *st)
{
    (void)st;
}

static real acting(State *st, const Sample *s)
{
    return parallel(st, s);
}

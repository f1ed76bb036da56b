/* Behind a spring a duty shows in the force long after it was given, and each question costs many
   steps; in another damper it shows the wrong way first. The yield force alone is aimed at. */
static real wanted_duty(Emulator *s, real dt, real top)
{
    const Outlook o = outlook(s, dt, top, K(0.0));
    const Goal goal = goal_of(s, &o);
    const Law law = law_at_the_end(s, &o, &goal);
    return duty_by_yield_force(s, &law, &goal);
}

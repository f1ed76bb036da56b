"""What an effect declares of its C: the body of one function for each thing that it does.

The export (`erdctl.export.c`) puts each body into a function whose head the effect's slot fixes,
and calls it once a sample. All heads share

    p : const struct *, the effect's parameters by symbol (`p->x_d`)
    z : struct *, its state, the members that `state` names (`z->heat`); only there if it has any.
        All 0 after init; `s->first` is the time to set it
    w : struct *, its long memory, the arrays that `past` names; only there if it has any. Who looks
        ahead copies the state and shares this: a step may write only where, by its state, nothing
        of the past stands that is still needed, and it must have room for a few steps so
    s : const Sample *, motion and control at this sample and at the one before, see below

and real is double, or float. Every literal goes through K (`K(0.5)`), every function of <math.h>
through its name in capitals (EXP, EXPM1, LOG1P, POW, TANH, SQRT, FABS, FMIN, FMAX), and the helpers
of `erdctl/export/c/parts/helpers.c` may be called.

    slot       code                                    is given besides      returns
    Motion     void: alters m->x, m->xdot, m->engaged  Motion *m
    Control    duty that acts over a step              real duty             real
    Field      normalised steady yield over a step     real field, int way   real
    Lag        factor of T_d in the step ahead                               real
    Sign, Viscous, Gas   in place of sign, xdot, x                           real
    Yield      what becomes of the yield force         real force            real
    Scale      void: multiplies f->gas, f->viscous, f->yield  Groups *f
    Feedback   the same, from the forces               const Groups *force, Groups *f
    Driven     a further force                         const Groups *force   real
    Series     compliance [m/N]; knows p alone                               real

`force` is what `Effect.columns` add, with their amplitudes [N]; of an effect of speed alone it may
use s->xdot and s->sign only. `play` is the free play [m] that a spring takes over, `damping` what
damps a spring [N s/m], from p alone.

Sample:

    first            it is the first since init: nothing lies before it
    h, t, clock      step from the sample before [s]; time since the first; the same in the time of
                     the record as logged, where that is known [s]
    clock_low        to be taken off a difference to the clock: what its digits do not hold [s]
    x, xdot, duty    motion of the piston [m], [m/s]; duty that acts from now on [1]
    x0, xdot0, duty0 the same at the sample before; duty0 acted over the step
    up, up0          1 where the parameters of compression apply, now and before
    turned, before   the direction changed in this step; part of the step before it did
    sign, engaged    sign(xdot) of Eq. 18; part of the sample in which the piston moves with the rod
    path, after      travel in this step, and of it after the turn [m]
    rests            the first sample begins at rest, and not as a motion turns
    ahead            see below

In Python a value at a sample may rest on the step that follows, here it cannot: all that belongs to
a step is computed as the step ends. A Control or Field law is called for the step that has ended,
with s->ahead = 0 (and at the first sample, to begin), and again with s->ahead = 1 for the duty that
acts from this sample on, as if the next step were as long as the last. Then it must leave what it
has of the past as it is; it may note what it needs of this sample as the next step ends.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Told:
    """What a program may tell an effect, besides motion, control and faults, by a function for it.

    name : of the function: PREFIX_temperature(state, temperature); one for all effects that ask
    given : its arguments, reals; a call with one that is no number changes nothing
    words : what they are with units, and what holds before the first call, for the header
    code : body of the function, which has `p`, `z` and what is given
    """

    name: str
    given: tuple[str, ...]
    words: str
    code: str


@dataclass(frozen=True, kw_only=True)
class CLaw:
    """An effect in C99.

    code : body of the function that its slot calls; empty where the slot has none (a term)
    force : body of the function that gives its added force [N]; empty if it adds none
    play : body of the function that gives a joint's free play [m]
    damping : body of the function that gives what damps a `SeriesSlot` [N s/m]
    by : body of the function that gives a `SignSlot` its `by` [1], behind a spring
    state : members of its state, reals: a name, or an array with its length, "past[64]"
    past : members of its long memory, arrays too large to be copied for each look ahead
    told : what a program may tell it
    note : what the causal form cannot do that Python does, for the header
    """

    code: str = ""
    force: str = ""
    play: str = ""
    damping: str = ""
    by: str = ""
    state: tuple[str, ...] = ()
    past: tuple[str, ...] = ()
    told: tuple[Told, ...] = ()
    note: str = ""

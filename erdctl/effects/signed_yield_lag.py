"""First-order lag of the signed yield force: it rebuilds after every reversal.

    T_s dF_y/dt + F_y = F_ER sign(xdot)

F_ER : (n,) yield force of Eq. 12 [N];  F_y : (n,) what acts [N];  T_s : [s] >= 0, off at 0
Solved exactly for an input that is a straight line between samples, or, in a step in which the
piston turns, jumps where it does. A record begins with F_y steady.
Valid where chains break and form anew at a reversal. Where this is the lag that the damper has,
T_d of Eq. 12, which acts on the unsigned force, goes to 0.
Check: F_ER = 10 N, T_s = 20 ms: 20 ms after a reversal F_y = 10 - 20 exp(-1) = 2.6424 N.
>>> s = signals([-0.1, 0.0, 0.1], step=0.02)  # the reversal at the second sample
>>> signed_yield_lag(np.array([-10.0, -10.0, 10.0]), s, {"T_s": 0.02}).round(4).tolist()
[-10.0, -10.0, 2.6424]

Source: D. R. Gamota, F. E. Filisko, Dynamic mechanical studies of electrorheological materials:
moderate frequencies, J. Rheol. 35 (1991) 399-425 (elastic stress that rebuilds after a reversal).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.kernels import follow
from erdctl.model.slots import Values, YieldSlot


def signed_yield_lag(force: Array, s: Signals, p: Values) -> Array:
    """(n,) yield force after the lag, in the unit of the signed yield force."""
    T_s = p["T_s"]
    if T_s == 0.0:
        return force
    decay = s.step / T_s if s.common_step is None else s.common_step / T_s
    i, part = s.turns
    before, after = part * s.step[i] / T_s, (1.0 - part) * s.step[i] / T_s
    return follow(force, decay, i, before, after, force[s.starts[:-1]], s.starts)


EFFECT = Effect(
    name="signed_yield_lag",
    stage=Stage.FLUID,
    slot=YieldSlot(signed_yield_lag, time="T_s"),
    title="the lag acts on the signed yield force, which rebuilds after every reversal",
    equation="T_s dF_y/dt + F_y = F_ER sign(xdot)",
    said="{T_s} of lag in the signed yield force",
    alters=(("yield", "F_y"),),
    source="Gamota and Filisko, J. Rheol. 35 (1991) 399-425",
    validity="in addition to Eq. 12, whose T_d goes to 0 where this is the only lag",
    requires=(Requirement.FIELD, Requirement.REVERSALS),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="T_s", unit="s", title="time constant of the signed yield force",
            low=1e-5, high=10.0, start=0.01, scale=Scale.LOG,
        ),
    ),
    c=CLaw(
        state=("force", "past"),
        code="""
        real past = z->past, e;

        z->past = force;
        if (!(p->T_s > K(0.0)))
            return force;
        e = s->h / p->T_s;
        z->force = s->first ? force : follow(z->force, past, force, e, s->turned, s->before * e,
                                             (K(1.0) - s->before) * e);
        return z->force;
        """,
    ),
)  # fmt: skip

"""Loss of fluid: the whole force of the paper's model shrinks.

    F = f [k_nom x + c_vis xdot + F_ER sign(xdot)]   once it has set in

f : effectiveness that is left [1], 0..1, off at 1
t_0 : onset [s], in the time of each record as logged
t_r : time over which the factor falls linearly from 1 to f [s], >= 0; 0 is at once
Which forces it takes `erdctl.model.faults` says, for mimic and simulate too; `erdctl.model.onset`
how it sets in.
Valid for a fault that sets in once and stays; a record that ends before t_0 is healthy.
Check: f = 0.5, t_0 = 15 s: 10 N of gas, 6 N of viscous and 4 N of yield force, 20 N at 14 s, are
10 N at 16 s.
>>> s = signals(np.ones(9), t=np.linspace(14.0, 16.0, 9))
>>> left = oil_leakage(s, {"f": 0.5, "t_0": 15.0, "t_r": 0.0})
>>> force = 10.0 * left["gas"] + 6.0 * left["viscous"] + 4.0 * left["yield"]
>>> force[[0, -1]].round(9).tolist()
[20.0, 10.0]

Source: the ER damper paper, Eq. 20.
"""

from __future__ import annotations

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.faults import FaultKind, set_in, set_in_c
from erdctl.model.onset import ONSET, anywhere
from erdctl.model.slots import ScaleSlot, Values


def oil_leakage(s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the groups, (n,) each [1]."""
    return set_in(FaultKind.OIL, s, p)


EFFECT = Effect(
    name="oil_leakage",
    stage=Stage.FAULT,
    slot=ScaleSlot(oil_leakage),
    title="leakage of the fluid takes a part of all forces",
    equation="F = f [gas + viscous + yield], f = 1 until t_0 and its value from t_0 + t_r",
    said="{f:%} of all forces left from {t_0} on",
    alters=(("gas", "f {}"), ("viscous", "f {}"), ("yield", "f {}")),
    source="the ER damper paper, Eq. 20",
    validity="a fault that sets in once, at once or over a ramp, and stays",
    requires=(Requirement.TIME,),
    shows=Variable.TIME,
    quantities=ONSET,
    guesses=anywhere,
    earlier=(("t_r", 0.0),),
    sets_in=FaultKind.OIL.groups,
    c=set_in_c(FaultKind.OIL),
)

"""Deformed duct: viscous and yield force shrink, the gas force stays.

    F = k_nom x + f [c_vis xdot + F_ER sign(xdot)]   once it has set in

f : effectiveness that is left [1], 0..1, off at 1
t_0 : onset [s], in the time of each record as logged
t_r : time over which the factor falls linearly from 1 to f [s], >= 0; 0 is at once
Which forces it takes `erdctl.model.faults` says, for mimic and simulate too; `erdctl.model.onset`
how it sets in.
Valid for a fault that sets in once and stays; a record that ends before t_0 is healthy.
Check: f = 0.5, t_0 = 15 s: 10 N of gas, 6 N of viscous and 4 N of yield force, 20 N at 14 s, are
15 N at 16 s.
>>> s = signals(np.ones(9), t=np.linspace(14.0, 16.0, 9))
>>> left = deformation_fault(s, {"f": 0.5, "t_0": 15.0, "t_r": 0.0})
>>> force = 10.0 + 6.0 * left["viscous"] + 4.0 * left["yield"]
>>> force[[0, -1]].round(9).tolist()
[20.0, 15.0]

Source: the ER damper paper, Eq. 23.
"""

from __future__ import annotations

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.faults import FaultKind, set_in, set_in_c
from erdctl.model.onset import ONSET, anywhere
from erdctl.model.slots import ScaleSlot, Values


def deformation_fault(s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the groups, (n,) each [1]."""
    return set_in(FaultKind.DEFORMATION, s, p)


EFFECT = Effect(
    name="deformation_fault",
    stage=Stage.FAULT,
    slot=ScaleSlot(deformation_fault),
    title="a deformed duct takes a part of the viscous and the yield force",
    equation="F = gas + f [viscous + yield], f = 1 until t_0 and its value from t_0 + t_r",
    said="{f:%} of the viscous and the yield force left from {t_0} on",
    alters=(("viscous", "f {}"), ("yield", "f {}")),
    source="the ER damper paper, Eq. 23",
    validity="a fault that sets in once, at once or over a ramp, and stays",
    requires=(Requirement.TIME,),
    shows=Variable.TIME,
    quantities=ONSET,
    guesses=anywhere,
    earlier=(("t_r", 0.0),),
    sets_in=FaultKind.DEFORMATION.groups,
    c=set_in_c(FaultKind.DEFORMATION),
)

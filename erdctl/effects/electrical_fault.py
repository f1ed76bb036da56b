"""Loss of field: only the yield force shrinks.

    F = k_nom x + c_vis xdot + f F_ER sign(xdot)   for t >= t_0

f : effectiveness that is left [1], 0..1, off at 1
t_0 : onset [s], in the time of each record as logged
From t_0 on the factor acts; it sets in over four samples about t_0, so that the force is
continuous in t_0. Which forces it takes is what `erdctl.faults` says, for mimic and simulate too.
Valid for a fault that sets in at once and stays; a record that ends before t_0 is healthy.
Check: f = 0.5, t_0 = 15 s: 10 N of gas, 6 N of viscous and 4 N of yield force, 20 N at 14 s, are
18 N at 16 s.
Source: the ER damper paper, Eq. 22.
"""

from __future__ import annotations

from erdctl.effect import Effect, Requirement, Slot, Stage, Values, Variable
from erdctl.faults import Fault, FaultKind, factors, onsets
from erdctl.quantity import Quantity
from erdctl.recording import Array
from erdctl.signals import Signals

EDGE = 4.0  # samples


def electrical_fault(s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the groups, (n,) each [1]."""
    if p["f"] == 1.0:
        return {}
    ramp = EDGE * s.typical_step
    fault = Fault(kind=FaultKind.ELECTRICAL, factor=p["f"], start=p["t_0"] - 0.5 * ramp, ramp=ramp)
    found = factors([fault], s.t, s.xdot, s.starts)
    return {"gas": found.gas, "viscous": found.viscous, "yield": found.yield_}


def starts(s: Signals) -> list[Values]:
    """Onsets over the length of the records, where half of the effectiveness goes."""
    return [{"f": 0.5, "t_0": t_0} for t_0 in onsets(s.t)]


EFFECT = Effect(
    name="electrical_fault",
    stage=Stage.FAULT,
    slot=Slot.SCALE,
    title="a fault of the supply takes a part of the yield force",
    equation="F = gas + viscous + f yield for t >= t_0",
    source="the ER damper paper, Eq. 22",
    validity="a fault that sets in at once and stays",
    requires=(Requirement.FIELD, Requirement.TIME),
    shows=Variable.TIME,
    quantities=(
        Quantity(
            symbol="f", unit="1", title="effectiveness that is left",
            low=0.0, high=1.0, start=0.7, off=1.0,
        ),
        Quantity(
            symbol="t_0", unit="s", title="onset, in the time of each record",
            low=-1e6, high=1e6, start=10.0, off=10.0,
        ),
    ),
    apply=electrical_fault,
    guesses=starts,
)  # fmt: skip

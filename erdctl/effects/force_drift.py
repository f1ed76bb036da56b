"""Slow drift of the zero of the force channel.

    F = d_1 (t - t_0) + d_2 (t - t_0)^2

t : (n,) time [s];  t_0 : first time of the record [s]
d_1 [N/s], d_2 [N/s^2] : of either sign, off at 0
Valid for drifts that a parabola follows over a record, each record beginning with its zero set.
Check: d_1 = -0.1 N/s, d_2 = 0.01 N/s^2, 20 s into a record: -2 + 4 = 2 N.
>>> ([-0.1, 0.01] @ force_drift(signals([0.0, 0.0], t=[5.0, 25.0]), {})).round(9).tolist()
[0.0, 2.0]

Source: VDI/VDE/DKD 2638, Characteristics for force transducers (2008), drift of the zero signal.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def force_drift(s: Signals, p: Values) -> Array:
    """(2, n) forces for d_1 = 1 N/s [s] and for d_2 = 1 N/s^2 [s^2]."""
    since = s.t - np.repeat(s.t[s.starts[:-1]], np.diff(s.starts))
    return np.array([since, since * since])


EFFECT = Effect(
    name="force_drift",
    stage=Stage.SENSOR,
    slot=TermSlot(),
    title="slow zero drift of the force channel",
    equation="F = d_1 (t - t_0) + d_2 (t - t_0)^2, t_0 the first time of the record",
    said="{d_1} of drift at the beginning of a record",
    source="VDI/VDE/DKD 2638 (2008)",
    validity="drifts that a parabola follows, the zero set before each record",
    requires=(Requirement.TIME,),
    shows=Variable.TIME,
    quantities=(
        Quantity(
            symbol="d_1", unit="N/s", title="drift",
            low=-1e9, high=1e9, start=0.1, linear=True,
        ),
        Quantity(
            symbol="d_2", unit="N/s^2", title="change of the drift",
            low=-1e9, high=1e9, start=1e-3, linear=True,
        ),
    ),
    columns=force_drift,
)  # fmt: skip

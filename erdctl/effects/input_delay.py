"""Dead time between duty and yield stress.

    T_d dF_ER/dt + F_ER = sigma v(t - tau)^beta

v : (n,) duty cycle, held from its sample to the next [1];  tau : dead time [s] >= 0, off at 0
The delayed steady force has its mean over each step, which Eq. 12 needs: exact for any sampling
and continuous in tau. (Averaging v itself would err, as v^beta is steep at 0.) Before a record
its first duty holds.
Valid for a constant dead time (control cycle, amplifier).
Check: samples 10 ms apart, v^beta = 0, 1, 1, 1, tau = 4 ms: the step that begins at 10 ms has the
old value for 4 of its 10 ms, so the field is 0, 0.6, 1, 1.
>>> field = np.array([0.0, 1.0, 1.0, 1.0])
>>> input_delay(field, signals(np.ones(4)), {"tau": 4e-3}, "release").round(9).tolist()
[0.0, 0.6, 1.0, 1.0]

Source: J.-H. Koo, F. D. Goncalves, M. Ahmadian, A comprehensive analysis of the response time of MR
dampers, Smart Mater. Struct. 15 (2006) 351-358 (delay before the response sets in).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import FieldSlot, Values


def input_delay(field: Array, s: Signals, p: Values, way: str) -> Array:
    """(n,) normalised steady yield force [1], its mean over each step; alike both ways."""
    if p["tau"] == 0.0:
        return field
    out = np.empty_like(field)
    for a, b in pairwise(s.starts.tolist()):
        t, step = s.t[a:b] - s.t[a], s.step[a : b - 1]
        area = np.concatenate([[0.0], np.cumsum(field[a : b - 1] * step)])
        late = t - p["tau"]
        passed = np.interp(late, t, area) + np.minimum(late, 0.0) * field[a]
        out[a : b - 1] = np.diff(passed) / np.diff(late)
        out[b - 1] = np.interp(late[-1], t, field[a:b])
    return out


EFFECT = Effect(
    name="input_delay",
    stage=Stage.FIELD,
    slot=FieldSlot(input_delay),
    title="dead time between duty and yield stress",
    equation="T_d dF_ER/dt + F_ER = sigma v(t - tau)^beta",
    said="{tau} of dead time",
    alters=(("v", "v(t - tau)"),),
    source="Koo, Goncalves and Ahmadian, Smart Mater. Struct. 15 (2006) 351-358",
    validity="a constant dead time",
    requires=(Requirement.FIELD, Requirement.STEPS),
    shows=Variable.SINCE_DUTY_STEP,
    quantities=(
        Quantity(
            symbol="tau", unit="s", title="dead time",
            low=0.0, high=1.0, start=5e-3,
        ),
    ),
    order=10,  # of a constant delay and a memoryless law the order does not matter
)  # fmt: skip

"""Force channel that picks up the control voltage.

    F_rec = F + F_u duty

F, F_rec : (n,) force of the damper, and as recorded [N];  duty : (n,) logged duty cycle [1]
F_u : what the channel shows at full duty [N], of either sign, off at 0
Valid for a pickup in proportion to the mean voltage, as of a cable of the load cell beside that of
the electrodes, or a current to ground through its shield. It has one sign in compression and in
release, which no yield force has; of records that hold one duty each nothing tells it from a zero
of theirs.
Check: F_u = -2 N, duty = 0, 0.5, F = 3, -3 N gives 3, -4 N.
>>> s, F = signals([0.1, -0.1], duty=[0.0, 0.5]), np.array([3.0, -3.0])
>>> (F - 2.0 * force_crosstalk(s, {})[0]).tolist()
[3.0, -4.0]

Source: H. W. Ott, Electromagnetic Compatibility Engineering (2009), ch. 2 (coupling into cables).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import TermSlot, Values


def force_crosstalk(s: Signals, p: Values) -> Array:
    """(1, n) force for F_u = 1 N [1]."""
    return s.duty[None]


EFFECT = Effect(
    name="force_crosstalk",
    stage=Stage.SENSOR,
    slot=TermSlot(),
    title="force channel that picks up the control voltage",
    equation="F = F_u duty",
    said="{F_u} picked up at full duty",
    source="Ott, Electromagnetic Compatibility Engineering (2009) ch. 2",
    validity="a pickup in proportion to the mean voltage",
    requires=(Requirement.FIELD, Requirement.STEPS),
    shows=Variable.DUTY,
    quantities=(
        Quantity(
            symbol="F_u", unit="N", title="force shown at full duty",
            low=-1e9, high=1e9, start=1.0, linear=True,
        ),
    ),
    columns=force_crosstalk,
    gives_way_to=("force_offset", "gas_preload"),  # which any duty has
)  # fmt: skip

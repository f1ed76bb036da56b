"""Duty channel recorded late against motion and force.

    T_d dF_ER/dt + F_ER = sigma v(t + tau)^beta

v : (n,) logged duty cycle, held from its sample to the next [1];  tau : how late it is [s] >= 0,
off at 0
The steady force has its mean over each step, which Eq. 12 needs: exact for any sampling and
continuous in tau. After a record its last duty holds.
Valid for a constant delay of the channel: a controller that reports what it has set once a cycle,
a bus between the amplifier and the recorder. The force then answers before the log says why, which
no damper does; a duty that is recorded early is nothing but input_delay.
Check: samples 10 ms apart, v^beta = 0, 0, 1, 1, tau = 4 ms: the step that begins at 10 ms has the
new value for 4 of its 10 ms, so the field is 0, 0.4, 1, 1.
>>> field = np.array([0.0, 0.0, 1.0, 1.0])
>>> duty_skew(field, signals(np.ones(4)), {"tau": 4e-3}, "release").round(9).tolist()
[0.0, 0.4, 1.0, 1.0]

Source: T. I. Laakso et al., Splitting the unit delay, IEEE Signal Processing Magazine 13 (1996)
30-60 (delays between channels by parts of a sample).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.delayed_field import delayed_field
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import FieldSlot, Values


def duty_skew(field: Array, s: Signals, p: Values, way: str) -> Array:
    """(n,) normalised steady yield force [1], its mean over each step; alike both ways."""
    return field if p["tau"] == 0.0 else delayed_field(field, s, -p["tau"])


def within_a_sample(p: Values, step: float) -> str:
    """Half a step is what a duty has in the mean that switches when it likes."""
    if p["tau"] >= step:
        return ""
    between = f"less than the {1e3 * step:.3g} ms between samples"
    return f"{between}, as of a duty that switches between them"


EFFECT = Effect(
    name="duty_skew",
    stage=Stage.SENSOR,
    slot=FieldSlot(duty_skew),
    title="duty channel recorded late against motion and force",
    equation="T_d dF_ER/dt + F_ER = sigma v(t + tau)^beta",
    said="{tau} of delay of the duty channel",
    alters=(("v", "v(t + tau)"),),
    source="Laakso et al., IEEE Signal Processing Magazine 13 (1996) 30-60",
    validity="a constant delay of the channel",
    requires=(Requirement.FIELD, Requirement.STEPS),
    shows=Variable.SINCE_DUTY_STEP,
    quantities=(
        Quantity(
            symbol="tau", unit="s", title="delay of the duty channel",
            low=0.0, high=1.0, start=5e-3,
        ),
    ),
    caveat=within_a_sample,
    order=-10,  # the measuring chain comes before the supply
)  # fmt: skip

"""What one physical effect declares; the catalogue in `erdctl.effects` holds one file for each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum

from erdctl.quantity import Quantity

Values = Mapping[str, float]


class Stage(Enum):
    """Part of the damper or the bench that an effect belongs to."""

    MOTION = "motion"
    FIELD = "field"
    FLUID = "fluid"
    FRICTION = "friction"
    GAS = "gas"
    POSITION = "position"
    FAULT = "fault"
    SENSOR = "sensor"


class Slot(Enum):
    """Where an effect enters the model, and so what its function receives and returns.

    s is a `Signals`, p maps the effect's symbols to values, (n,) arrays are samples:

    MOTION    (s, p) -> Signals                       motion of the piston from that of the rod
    CONTROL   (s, p) -> (n,) duty                     what reaches the electrodes
    FIELD     (field, s, p) -> (n,)                   normalised yield force, from v^beta
    LAG       (lag, s, sign, p) -> (u_c, u_r) -> (n,) signed yield force from its steady values
    SIGN      (s, p) -> (n,) in -1..1                 in place of sign(xdot)
    VISCOUS   (s, p) -> (n,) [m/s]                    in place of xdot
    GAS       (s, p) -> (n,) [m]                      in place of x
    TERM      (s, p) -> (k, n)                        added forces, linear in k amplitudes
    SCALE     (s, p) -> {group: (n,)}                 multipliers of gas, viscous, yield
    CHANNEL   (column, s, p) -> (n,)                  what the force channel makes of the force
    """

    MOTION = "motion"
    CONTROL = "control"
    FIELD = "field"
    LAG = "lag"
    SIGN = "sign"
    VISCOUS = "viscous"
    GAS = "gas"
    TERM = "term"
    SCALE = "scale"
    CHANNEL = "channel"


@dataclass(frozen=True, kw_only=True)
class Effect:
    """One physical effect: facts for people and programs, and one pure function.

    name : as in the contract;  stage, slot : where it belongs and where it enters the model
    quantities : its parameters; those marked linear are amplitudes of a TERM, in its order
    apply : the pure function, see `Slot`
    equation, source, validity : text for people
    needs : what a log must contain for the effect to be seen;  signature : where it shows
    order : effects of one slot act in this order
    """

    name: str
    stage: Stage
    slot: Slot
    title: str
    equation: str
    source: str
    validity: str
    needs: str
    signature: str
    quantities: tuple[Quantity, ...]
    apply: Callable[..., object] = field(repr=False)
    order: int = 0

    def __post_init__(self) -> None:
        amplitudes = [q for q in self.quantities if q.linear]
        if bool(amplitudes) != (self.slot is Slot.TERM):
            raise ValueError(f"{self.name}: a TERM has amplitudes, every other slot has none")

    @property
    def amplitudes(self) -> tuple[Quantity, ...]:
        """The parameters in which the force is linear."""
        return tuple(q for q in self.quantities if q.linear)

    def key(self, symbol: str) -> str:
        """Name of a parameter among those of a whole model, e.g. `coulomb_friction.F_c`."""
        return f"{self.name}.{symbol}"

    def local(self, values: Values) -> dict[str, float]:
        """This effect's own values out of those of a whole model."""
        return {q.symbol: values[self.key(q.symbol)] for q in self.quantities}

    @property
    def off(self) -> dict[str, float]:
        """Values with which the effect is exactly absent, as in those of a whole model."""
        return {self.key(q.symbol): q.off for q in self.quantities}

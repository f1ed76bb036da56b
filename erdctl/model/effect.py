"""What one physical effect declares; the catalogue in `erdctl.effects` holds one file for each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array

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

    MOTION    (s, p) -> Signals           motion of the piston from that of the rod
    CONTROL   (s, p) -> (n,) duty         what reaches the electrodes
    FIELD     (field, s, p, way) -> (n,)  normalised yield force, from v^beta, in the direction
              `way`, compression or release
    LAG       (s, p) -> (n,)              factor of T_d while the yield force falls
    SIGN      (s, p) -> (n,) in -1..1     in place of sign(xdot)
    YIELD     (force, s, p) -> (n,)       what becomes of the signed yield force
    VISCOUS   (s, p) -> (n,) [m/s]        in place of xdot
    GAS       (s, p) -> (n,) [m]          in place of x
    SCALE     (s, p) -> {group: (n,)}     multipliers of the groups gas, viscous, yield
    TERM      nothing but added forces, see `Effect.columns`
    FEEDBACK  (parts, s, p) -> {group: (n,)}  multipliers that depend on the forces themselves:
              parts are those that act without it, by group and `other`, for it to march through
    SERIES    (p) -> float [m/N]          compliance in series with the groups of `Effect.carries`
    CHANNEL   (column, s, p) -> (n,)      what the force channel makes of the force
    """

    MOTION = "motion"
    CONTROL = "control"
    FIELD = "field"
    LAG = "lag"
    SIGN = "sign"
    YIELD = "yield"
    VISCOUS = "viscous"
    GAS = "gas"
    SCALE = "scale"
    TERM = "term"
    FEEDBACK = "feedback"
    SERIES = "series"
    CHANNEL = "channel"


class Requirement(Enum):
    """What a log must contain for an effect to be seen; unmet means "cannot be tested"."""

    REVERSALS = "reversals of the motion"
    FIELD = "samples with a duty above zero"
    LEVELS = "at least three duty levels above zero"
    STEPS = "steps of the duty within a record"
    SPEEDS = "a range of speeds"
    STROKE = "a range of deflections"
    FREQUENCIES = "accelerations that no spring makes, that is of clearly different frequencies"
    TIME = "records of at least several seconds"


class Variable(Enum):
    """A variable over which a misfit can gather; the contract's names."""

    XDOT = "xdot"
    X = "x"
    DUTY = "duty"
    TIME = "t"
    SINCE_REVERSAL = "since_reversal"
    SINCE_DUTY_STEP = "since_duty_step"
    ENERGY = "dissipated_energy"


@dataclass(frozen=True, kw_only=True)
class Effect:
    """One physical effect: facts for people and programs, and pure functions.

    name : as in the contract;  stage, slot : where it belongs and where it enters the model
    quantities : its parameters; those marked linear are amplitudes of `columns`, in its order
    apply : the pure function of its slot, see `Slot`; None for a TERM
    columns : (s, p) -> (k, n) forces for unit amplitudes that the effect adds, in any slot
    of_speed : apply or columns depend on xdot alone, sample by sample
    carries : groups behind a SERIES compliance, or None for the whole force
    equation, source, validity : text for people
    requires : what a log must contain;  shows : where the misfit gathers when it is left out
    guesses : (s) -> starts of a search by symbol, where one start would not do (several dips of the
        cost, or a scale that depends on the motion)
    free_play : (p) -> play [m] in the joint of a compliance in series with the whole damper, which
        takes it over from `apply`: a play bears no force, so that what is stretched unloads first
    companions : effects that commonly come with it, and without which it may improve no fit
    equivalents : effects that force data can hardly tell from this one, whatever the log
    order : effects of one slot act in this order
    """

    name: str
    stage: Stage
    slot: Slot
    title: str
    equation: str
    source: str
    validity: str
    requires: tuple[Requirement, ...]
    shows: Variable
    quantities: tuple[Quantity, ...]
    apply: Callable[..., object] | None = field(default=None, repr=False)
    columns: Callable[[Any, Values], Array] | None = field(default=None, repr=False)
    guesses: Callable[[Any], Sequence[Values]] | None = field(default=None, repr=False)
    of_speed: bool = False
    carries: tuple[str, ...] | None = None
    free_play: Callable[[Values], float] | None = field(default=None, repr=False)
    companions: tuple[str, ...] = ()
    equivalents: tuple[str, ...] = ()
    order: int = 0

    def __post_init__(self) -> None:
        if bool(self.amplitudes) != (self.columns is not None):
            raise ValueError(f"{self.name}: linear parameters and columns go together")
        if (self.apply is None) != (self.slot is Slot.TERM):
            raise ValueError(f"{self.name}: every slot but TERM needs a function")

    def act(self, *arguments: Any) -> Any:
        """The function of the effect's slot."""
        if self.apply is None:
            raise ValueError(f"{self.name} only adds forces")
        return self.apply(*arguments)

    @property
    def amplitudes(self) -> tuple[Quantity, ...]:
        """The parameters in which the force is linear."""
        return tuple(q for q in self.quantities if q.linear)

    def key(self, symbol: str) -> str:
        """Name of a parameter among those of a whole model, e.g. `coulomb_friction.F_c`."""
        return f"{self.name}.{symbol}"

    def local(self, values: Values) -> dict[str, float]:
        """This effect's own values out of those of a whole model; amplitudes may be missing."""
        keys = {q.symbol: self.key(q.symbol) for q in self.quantities}
        return {symbol: values[key] for symbol, key in keys.items() if key in values}

    @property
    def off(self) -> dict[str, float]:
        """Values with which the effect is exactly absent, as in those of a whole model."""
        return {self.key(q.symbol): q.off for q in self.quantities}


def in_slot(effects: Iterable[Effect], slot: Slot) -> list[Effect]:
    """The effects of one slot in the order in which they act."""
    return sorted((e for e in effects if e.slot is slot), key=lambda e: e.order)

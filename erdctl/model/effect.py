"""What one physical effect declares; the catalogue in `erdctl.effects` holds one file for each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TypeVar

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.checked import added_forces, checked_most, checked_starts
from erdctl.model.slot_functions import MostFunction, StartsFunction, TermFunction
from erdctl.model.slots import Slot, TermSlot, Values

S = TypeVar("S", bound=Slot)


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
    TEMPERATURE = "a temperature that is logged, and changes"


class Variable(Enum):
    """A variable over which a misfit can gather; the contract's names."""

    XDOT = "xdot"
    X = "x"
    DUTY = "duty"
    TIME = "t"
    SINCE_REVERSAL = "since_reversal"
    SINCE_DUTY_STEP = "since_duty_step"
    ENERGY = "dissipated_energy"
    RECORD = "record"  # by its number, from 1


@dataclass(frozen=True, kw_only=True)
class Causal:
    """What `simulate` and C do at a sample, where a fit, which has the whole log, looks ahead.

    slot, columns : in the place of the effect's own; None where that knows the past alone already
    """

    slot: Slot | None = None
    columns: TermFunction | None = None


@dataclass(frozen=True, kw_only=True)
class Effect:
    """One physical effect: facts for people and programs, and pure functions.

    name : as in the contract;  stage : where it belongs
    slot : where it enters the model, with the function that does it, see `erdctl.model.slots`
    quantities : its parameters; those marked linear are amplitudes of `columns`, in its order
    columns : forces for unit amplitudes that the effect adds, in any slot
    smooth : near its off values the force changes in proportion to its parameters, so that a start
        is read from the rest at once
    of_speed : what it does depends on xdot alone, sample by sample
    equation, source, validity : text for people
    said : its main numbers as a phrase, e.g. "{g} of free play"; {f:%} in per cent
    alters : what becomes of a piece of the paper's equations, see `model.corrected_equation`
    requires : what a log must contain;  shows : where the misfit gathers when it is left out
    guesses : starts of a search where the grid would not do (several dips of the cost, a scale that
        depends on the motion, a frequency). The grid is made by unit: m, m/s, m/N, N s/m, 1/m,
        1/m^2, s and 1/J from what the recording spans, others from 0.1 to 10 times the start
    most : what a log allows at most of a parameter by the measured force alone: a hypothesis that
        asks for more is none, however well it fits
    least : what a log resolves at least of a parameter, between one sample and the next
    companions : effects that commonly come with it, and without which it may improve no fit
    equivalents : effects that force data can hardly tell from this one, whatever the log
    includes : effects of which it has the whole in parameters of its own
    richer_than : effects of which it is a form with a parameter more: it is never beside them, but
        tried in their place, and by itself only where it promises clearly more
    gives_way_to : effects that have the name where a log does not tell it from them
    sets_in : groups of which it takes a part from a time on, by the law of `erdctl.model.onset`,
        whose time a fit finds by a search of all (`estimate.onsets`); no others
    order : effects of one slot act in this order
    c : the same in C99, for the export;  writes_c : makes it, where that costs something
    caveat : (p, step) what a value says besides, on samples so far apart [s], "" for nothing; p are
        the effect's own values by symbol and those of the whole model by name
    causal : what goes on sample by sample, where the effect itself, for fits, looks ahead
    earlier : parameters that files lack which were written before there were any, and what they are
        there: a number, or the symbol whose value it is
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
    columns: TermFunction | None = field(default=None, repr=False)
    guesses: StartsFunction | None = field(default=None, repr=False)
    most: MostFunction | None = field(default=None, repr=False)
    least: MostFunction | None = field(default=None, repr=False)
    of_speed: bool = False
    smooth: bool = False
    companions: tuple[str, ...] = ()
    equivalents: tuple[str, ...] = ()
    includes: tuple[str, ...] = ()
    richer_than: tuple[str, ...] = ()
    gives_way_to: tuple[str, ...] = ()
    said: str = ""
    alters: tuple[tuple[str, str], ...] = ()
    sets_in: tuple[str, ...] = ()
    order: int = 0
    earlier: tuple[tuple[str, float | str], ...] = ()
    c: CLaw | None = field(default=None, repr=False)
    causal: Causal | None = field(default=None, repr=False)
    caveat: Callable[[Values, float], str] | None = field(default=None, repr=False, compare=False)
    writes_c: Callable[[], CLaw] | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        if bool(self.amplitudes) != (self.columns is not None):
            raise ValueError(f"{self.name}: linear parameters and columns go together")
        if isinstance(self.slot, TermSlot) and self.columns is None:
            raise ValueError(f"{self.name}: a term needs columns")

    def added(self, s: Signals, p: Values) -> Array:
        """(k, n) forces at unit amplitudes, k = 0 if the effect adds none [N]."""
        if self.columns is None:
            return np.empty((0, len(s)))
        return added_forces(self.columns, len(self.amplitudes), s, p)

    def with_c(self) -> Effect:
        """Itself with its C, where that is made only for an export."""
        return self if self.writes_c is None else replace(self, c=self.writes_c())

    def past_alone(self) -> Effect:
        """Itself as `simulate` and its C have it: no sample ahead is known."""
        if self.causal is None:
            return self
        return replace(
            self, slot=self.causal.slot or self.slot, columns=self.causal.columns or self.columns
        )

    def starts(self, s: Signals, rest: Array) -> list[dict[str, float]] | None:
        """Starts of a search by symbol; None where the effect leaves them to a grid."""
        if self.guesses is None:
            return None
        return checked_starts(self.guesses, [q.symbol for q in self.shape], s, rest)

    def allowed(self, s: Signals, force: Array) -> dict[str, float]:
        """What a log with this force (n,) allows at most of its parameters, as in a whole model."""
        return self._limits(self.most, s, force)

    def resolved(self, s: Signals, force: Array) -> dict[str, float]:
        """What a log with this force (n,) resolves at least of its parameters, likewise."""
        return self._limits(self.least, s, force)

    def _limits(self, said: MostFunction | None, s: Signals, force: Array) -> dict[str, float]:
        if said is None:
            return {}
        found = checked_most(said, [q.symbol for q in self.quantities], s, force)
        return {self.key(symbol): value for symbol, value in found.items()}

    @property
    def carried(self) -> bool:
        """Whether a spring in series with the whole damper carries its forces."""
        return self.stage is not Stage.SENSOR

    @property
    def shape(self) -> tuple[Quantity, ...]:
        """The parameters that a fit searches for."""
        return tuple(q for q in self.quantities if not q.linear)

    @property
    def amplitudes(self) -> tuple[Quantity, ...]:
        """The parameters in which the force is linear."""
        return tuple(q for q in self.quantities if q.linear)

    @property
    def sizes(self) -> tuple[Quantity, ...]:
        """The parameters to which, near its off values, the force changes in proportion."""
        return tuple(q for q in self.quantities if q.linear or (self.smooth and q.off == 0.0))

    def key(self, symbol: str) -> str:
        """Name of a parameter among those of a whole model, e.g. `coulomb_friction.F_c`."""
        return f"{self.name}.{symbol}"

    def among(self, values: Values) -> dict[str, float]:
        """Its own values by symbol, beside all of a model."""
        return {**values, **self.local(values)}

    def local(self, values: Values) -> dict[str, float]:
        """This effect's own values out of those of a whole model; amplitudes may be missing."""
        keys = {q.symbol: self.key(q.symbol) for q in self.quantities}
        return {symbol: values[key] for symbol, key in keys.items() if key in values}

    @property
    def says_as_well(self) -> tuple[str, ...]:
        """Parameters of the paper's model that it says as well; they keep their value beside it."""
        return ()

    @property
    def off(self) -> dict[str, float]:
        """Values with which the effect is exactly absent, as in those of a whole model."""
        return {self.key(q.symbol): q.off for q in self.quantities}


def in_slot(effects: Iterable[Effect], kind: type[S]) -> list[tuple[Effect, S]]:
    """The effects of one slot, each with it, in the order in which they act."""
    found = [(e, e.slot) for e in effects if isinstance(e.slot, kind)]
    return sorted(found, key=lambda f: f[0].order)

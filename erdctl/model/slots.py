"""Where an effect enters the model, and what its function receives and must return there.

One class a slot: it holds the effect's function, whose type is a Protocol (`model.slot_functions`),
so that a type checker holds every effect to its slot; and it calls the function, so that what comes
back is checked where it is used. Common to all:

s : `Signals`, motion and control at the samples;  p : the effect's values by symbol;  (n,) : one
value a sample. Values are those *at* a sample, but for two that hold until the next one:

- the duty that `ControlSlot` returns is **held** from its sample to the next, as an amplifier does;
- the normalised yield force that `FieldSlot` returns is the **mean over the step** that begins at
  its sample, which Eq. 12 needs: what swings or jumps within a step and is given at the sample
  comes out half a step late.

A function is pure, finite for all values within the bounds of its parameters, and returns its
argument itself (or what has no effect) at the off values. It sees records one after the other,
divided by `s.starts`, and must not let one see another.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

from erdctl.core.errors import EffectFailed
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.checked import Groups, called, groups, in_words, number, samples
from erdctl.model.slot_functions import (
    ColumnFunction,
    DrivenFunction,
    FeedbackFunction,
    FieldFunction,
    MotionFunction,
    NumberFunction,
    SamplesFunction,
    ScaleFunction,
)
from erdctl.model.slot_functions import Values as Values

F = TypeVar("F", bound=Callable[..., object])


class FunctionSlot(Generic[F]):
    """A slot with its function; two are equal if their functions are.

    Plain classes: a dozen of dataclasses would cost each command 7 ms to make.
    """

    def __init__(self, function: F) -> None:
        self.function = function

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and vars(self) == vars(other)

    def __hash__(self) -> int:
        return hash((type(self), self.function))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({getattr(self.function, '__name__', self.function)})"


class MotionSlot(FunctionSlot[MotionFunction]):
    """The piston's motion, at the samples and on straight lines between them.

    free_play : (p) -> play [m] in the joint of a compliance in series with the whole damper, which
        takes it over from `function`: a play bears no force, so that what is stretched unloads
    of_samples : it counts by samples of the log, and means another thing between them
    """

    def __init__(
        self,
        function: MotionFunction,
        free_play: NumberFunction | None = None,
        *,
        of_samples: bool = False,
    ) -> None:
        super().__init__(function)
        self.free_play, self.of_samples = free_play, of_samples

    def __call__(self, s: Signals, p: Values) -> Signals:
        out = called(self.function, s, p)
        if not isinstance(out, Signals):
            raise EffectFailed(self.function, f"returned {in_words(out)}, expected Signals")
        for name in ("x", "xdot"):
            samples(self.function, getattr(out, name), s, name)
        return out


class SampledSlot(FunctionSlot[SamplesFunction]):
    """What takes a place among the model's signals: (n,) values."""

    def __call__(self, s: Signals, p: Values) -> Array:
        return samples(self.function, called(self.function, s, p), s)


class ControlSlot(SampledSlot):
    """(n,) duty [1] that reaches the electrodes, held from its sample to the next."""


class LagSlot(SampledSlot):
    """(n,) factor of T_d [1] in the step that begins here, while the yield force falls.

    rising : while it rises, too
    """

    def __init__(self, function: SamplesFunction, *, rising: bool = False) -> None:
        super().__init__(function)
        self.rising = rising


class SignSlot(SampledSlot):
    """(n,) in -1..1, in place of sign(xdot), at the samples.

    Behind a spring the speed is the piston's, and the law one of speed alone: that of an effect
    `of_speed`, or the one at x = 0 and full duty, at the speed (xdot + lead x) / by.

    lead : symbol of a parameter [1/s];  by : (s, p) -> (n,) [1]
    """

    def __init__(
        self,
        function: SamplesFunction,
        *,
        lead: str | None = None,
        by: SamplesFunction | None = None,
    ) -> None:
        super().__init__(function)
        self.lead, self.by = lead, by

    @property
    def of_another(self) -> bool:
        """Whether it is the law of another speed."""
        return self.lead is not None or self.by is not None


class ViscousSlot(SampledSlot):
    """(n,) in place of xdot [m/s] in the viscous force, at the samples."""


class GasSlot(SampledSlot):
    """(n,) in place of x [m] in the gas force, at the samples."""


class FieldSlot(FunctionSlot[FieldFunction]):
    """(n,) steady yield force over sigma [1], from v^beta: its mean over the step that begins here.

    way : "compression" or "release", the direction for which it is
    """

    def __call__(self, field: Array, s: Signals, p: Values, way: str) -> Array:
        return samples(self.function, called(self.function, field, s, p, way), s)


class ColumnSlot(FunctionSlot[ColumnFunction]):
    """What becomes of a force (n,) [N]."""

    def __call__(self, column: Array, s: Signals, p: Values) -> Array:
        return samples(self.function, called(self.function, column, s, p), s)


class HysteresisSlot(ColumnSlot):
    """(n,) hysteretic variable [1] in place of a sign law (n,), which it follows; linear in it.

    travel : symbol of the travel [m] over which it follows, exponentially; 0 at once
    """

    def __init__(self, function: ColumnFunction, *, travel: str) -> None:
        super().__init__(function)
        self.travel = travel


class YieldSlot(ColumnSlot):
    """(n,) what becomes of the signed yield force [N], at the samples; may remember.

    time : symbol of the time [s] over which it follows, exponentially: what a spring in series
        needs to know of it
    """

    def __init__(self, function: ColumnFunction, *, time: str | None = None) -> None:
        super().__init__(function)
        self.time = time


class ChannelSlot(ColumnSlot):
    """(n,) what the force channel records of a force [N], at the samples; linear in it."""


class ScaleSlot(FunctionSlot[ScaleFunction]):
    """(n,) factors [1] of the groups `gas`, `viscous`, `yield`, at the samples."""

    def __call__(self, s: Signals, p: Values) -> Groups:
        return groups(self.function, called(self.function, s, p), s)


class FeedbackSlot(FunctionSlot[FeedbackFunction]):
    """(n,) factors [1] of groups that depend on the forces themselves, at the samples.

    It is to march free-running, with the forces that its own factors leave.
    """

    def __call__(self, parts: Groups, s: Signals, p: Values) -> Groups:
        return groups(self.function, called(self.function, parts, s, p), s)


class DrivenSlot(FunctionSlot[DrivenFunction]):
    """(n,) a further force [N] from those of the groups `gas`, `viscous`, `yield`, at the samples.

    It acts beside them and is not fed back: what it is made from does not hold it.
    """

    def __call__(self, parts: Groups, s: Signals, p: Values) -> Array:
        return samples(self.function, called(self.function, parts, s, p), s)


class SeriesSlot(FunctionSlot[NumberFunction]):
    """Compliance [m/N] in series with some groups, or with the whole damper (`carries` None).

    damping, free_play : (p) -> what damps it, across a play as well [N s/m]; play of its own [m]
    """

    def __init__(
        self,
        function: NumberFunction,
        carries: tuple[str, ...] | None = None,
        damping: NumberFunction | None = None,
        free_play: NumberFunction | None = None,
    ) -> None:
        super().__init__(function)
        self.carries, self.damping, self.free_play = carries, damping, free_play

    def __call__(self, p: Values) -> float:
        return number(self.function, called(self.function, p))


class TermSlot:
    """Nothing but added forces: `Effect.columns`.

    travel : symbol of the travel [m] over which the one column follows sign(xdot), exponentially;
        behind a spring in series it follows the piston's direction over its travel
    mass : symbol of the mass [kg] whose one column is the acceleration of the rod; behind a spring
        in series it goes with the piston
    """

    def __init__(self, *, travel: str | None = None, mass: str | None = None) -> None:
        self.travel, self.mass = travel, mass

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TermSlot) and self._symbols() == other._symbols()

    def __hash__(self) -> int:
        return hash((TermSlot, *self._symbols()))

    def _symbols(self) -> tuple[str | None, str | None]:
        return self.travel, self.mass


Slot = (
    MotionSlot | ControlSlot | FieldSlot | LagSlot | SignSlot | HysteresisSlot | YieldSlot
    | ViscousSlot | GasSlot | ScaleSlot | TermSlot | FeedbackSlot | DrivenSlot | SeriesSlot
    | ChannelSlot
)  # fmt: skip


def number_of(function: NumberFunction | None, p: Values) -> float:
    """What a slot's further function gives; 0 where it has none."""
    return 0.0 if function is None else number(function, called(function, p))

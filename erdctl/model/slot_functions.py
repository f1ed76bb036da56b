"""What the functions of effects are given and return: a type for each slot, see `model.slots`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.checked import Groups

Values = Mapping[str, float]


class MotionFunction(Protocol):
    """Motion of the piston from that of the rod; `Signals.with_motion` makes it."""

    def __call__(self, s: Signals, p: Values, /) -> Signals: ...


class SamplesFunction(Protocol):
    """(n,) of what the slot takes the place of; see the slot."""

    def __call__(self, s: Signals, p: Values, /) -> Array: ...


class FieldFunction(Protocol):
    """(n,) normalised steady yield force from `field`, in one direction."""

    def __call__(self, field: Array, s: Signals, p: Values, way: str, /) -> Array: ...


class ColumnFunction(Protocol):
    """(n,) what becomes of a force (n,) [N]."""

    def __call__(self, column: Array, s: Signals, p: Values, /) -> Array: ...


class ScaleFunction(Protocol):
    """(n,) factors of groups; a group that is not in it keeps its force."""

    def __call__(self, s: Signals, p: Values, /) -> Groups: ...


class FeedbackFunction(Protocol):
    """(n,) factors of groups from the forces that act without it, by group and `other`."""

    def __call__(self, parts: Groups, s: Signals, p: Values, /) -> Groups: ...


class DrivenFunction(Protocol):
    """(n,) force [N] that the forces of the groups bring about."""

    def __call__(self, parts: Groups, s: Signals, p: Values, /) -> Array: ...


class NumberFunction(Protocol):
    """One number."""

    def __call__(self, p: Values, /) -> float: ...


class TermFunction(Protocol):
    """(k, n) forces at unit amplitudes, one row for each linear parameter, in their order [N]."""

    def __call__(self, s: Signals, p: Values, /) -> Array: ...


class StartsFunction(Protocol):
    """Starts of a search, each with a number for every parameter that is not linear.

    `rest` is what the present model leaves of the force (n,) [N], 0 where it has no weight: from it
    a frequency or a time can be read. All starts are looked at with one evaluation of the model
    each, so some tens are cheap and thousands are not; the best few are searched from.
    """

    def __call__(self, s: Signals, rest: Array, /) -> Sequence[Values]: ...


class MostFunction(Protocol):
    """Largest values of some parameters that a log allows, by symbol, whatever else acts in it."""

    def __call__(self, s: Signals, force: Array, /) -> Values: ...

"""What the catalogue can say of a hidden effect: whether it can be named at all, and by what names.

The plant knows nothing of the catalogue, so that an effect added to it, by a file or by another
package, needs no word here: a twin of that name is from then on no stranger to the diagnosis.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.signals import Signals
from erdctl.effects import catalogue
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.slots import Values


def nameable() -> frozenset[str]:
    """Hidden effects that a diagnosis can name: those in the catalogue, and those that one of its
    effects says it is equivalent to."""
    return frozenset(n for e in catalogue() for n in (e.name, *e.equivalents))


def right_names(
    hidden: str, equivalent: tuple[str, ...] = (), beside: Iterable[str] = ()
) -> tuple[str, ...]:
    """Names other than its own that are right for a hidden effect.

    equivalent : what the plant says no force channel tells from it; what the catalogue says of it,
    from either side, is added.
    beside : what else is hidden; of these, an effect that includes this one names both
    """
    said = [e.equivalents for e in catalogue() if e.name == hidden]
    back = [e.name for e in catalogue() if hidden in e.equivalents]
    both = [e.name for e in catalogue() if hidden in e.includes and e.name in beside]
    names = dict.fromkeys([*equivalent, *(n for names in said for n in names), *back, *both])
    return tuple(n for n in names if n != hidden)


def structures(hidden: str) -> tuple[Effect, ...]:
    """The catalogue's effects for a hidden one: of its name, and those that are equivalent.

    Of two that no force tells apart one may have bounds that what is hidden has not: a preload
    pushes outwards, whatever the zero of a channel does.
    """
    found = [e for e in catalogue() if e.name == hidden]
    said = {n for e in found for n in e.equivalents}
    return (*found, *(e for e in catalogue() if e.name in said or hidden in e.equivalents))


def no_model_has(names: Collection[str], beside: Model, s: Signals, values: Values) -> bool:
    """Whether none of some effects can act in one model with those of another, whose values are
    given: no diagnosis that begins with that can name one."""
    for effect in (e for e in catalogue() if e.name in names):
        start = {effect.key(q.symbol): q.start for q in effect.quantities}
        try:
            Model((*beside.effects, effect)).force(s, {**values, **start})
        except IncompatibleEffects:
            continue
        return False
    return True

"""What the catalogue can say of a hidden effect: whether it can be named at all, and by what names.

The plant knows nothing of the catalogue, so that an effect added to it, by a file or by another
package, needs no word here: a twin of that name is from then on no stranger to the diagnosis.
"""

from __future__ import annotations

from collections.abc import Iterable

from erdctl.effects import catalogue
from erdctl.model.effect import Effect


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


def structure(hidden: str) -> Effect:
    """The catalogue's effect for a hidden one: of its name, or the first that is equivalent."""
    own = [e for e in catalogue() if e.name == hidden]
    return (own or [e for e in catalogue() if hidden in e.equivalents])[0]

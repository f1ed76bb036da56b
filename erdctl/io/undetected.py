"""Effects that were not named, and the size from which data would have shown them, as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from erdctl.diagnose.detectable import Detectable


class Sized(TypedDict):
    """A value without an error."""

    value: float
    unit: str


class UndetectedDocument(TypedDict):
    """An effect that was not named, and the size from which these data would have shown it.

    parameter, size, unit : how much of it there would be; `off` is none of it
    parameters : all at that size;  force_rms : of the force that it would make [N];  beyond_rms :
    of what no other parameter absorbs [N];  detectable : false where no size would have been seen,
    for the reason given
    """

    effect: str
    parameter: str
    size: float | None
    unit: str
    off: float
    parameters: dict[str, Sized]
    force_rms: float | None
    beyond_rms: float | None
    detectable: bool
    reason: str | None


class Limit(TypedDict):
    """From which size an effect that was not named would have been seen."""

    parameter: str
    value: float
    unit: str


def limits(found: Sequence[Detectable]) -> dict[str, Limit]:
    """The sizes alone, by effect; none for those that no size would show."""
    return {
        d.effect.name: {
            "parameter": d.quantity.symbol, "value": d.size, "unit": d.quantity.unit,
        }
        for d in found if d.size is not None
    }  # fmt: skip


def undetected(found: Sequence[Detectable]) -> list[UndetectedDocument]:
    """One entry for each effect."""
    return [
        {
            "effect": d.effect.name,
            "parameter": d.quantity.symbol,
            "size": d.size,
            "unit": d.quantity.unit,
            "off": d.quantity.off,
            "parameters": {
                q.symbol: {"value": d.values[q.symbol], "unit": q.unit}
                for q in d.effect.quantities
            } if d.values else {},
            "force_rms": d.force,
            "beyond_rms": d.beyond,
            "detectable": d.size is not None,
            "reason": d.reason,
        }
        for d in found
    ]  # fmt: skip

"""Closed forms of the field, each of size 1, over a coordinate z.

Z : the largest size of z where the form was learned; m, w : a place and a width, in the unit of z
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.model.slots import Values

STEEPEST = 50.0  # exp of it, and of less it, is a number that a size can make up for


class Form(NamedTuple):
    """One form: its equation, its parameters over a range, and its value at z (n,) by Z.

    bends : whether a curve through few knots can be it
    grows : whether it grows without end beyond a range, on one side or on both
    steps : widths, at least, from one value of z that was seen to the next: what swings or bulges
        in between would be told by nothing
    """

    equation: str
    parameters: Callable[[str, float, float], tuple[Quantity, ...]]
    value: Callable[[Array, float, Values], Array]
    bends: bool = True
    grows: bool = False
    steps: float = 0.0

    def narrowest(self, z: Array) -> float:
        """Least width w that samples of the coordinate (n,) tell, in the unit of z.

        Check: a sine over levels of 0, 1 and 3 has a period of 4 at least, twice their widest step.
        >>> FORMS["sine"].narrowest(np.array([3.0, 0.0, 1.0, 1.0]))
        4.0
        """
        levels = np.unique(z)
        return self.steps * float(np.max(np.diff(levels), initial=0.0))


def _none(unit: str, low: float, high: float) -> tuple[Quantity, ...]:
    return ()


def _width(unit: str, low: float, high: float) -> Quantity:
    span = high - low
    return Quantity(
        symbol="w", unit=unit, title="width", low=1e-3 * span, high=1e2 * span,
        start=0.3 * span, off=0.3 * span, scale=Scale.LOG,
    )  # fmt: skip


def _place(unit: str, low: float, high: float) -> Quantity:
    mid = 0.5 * (low + high)
    return Quantity(symbol="m", unit=unit, title="place", low=low, high=high, start=mid, off=mid)


def _widths(unit: str, low: float, high: float) -> tuple[Quantity, ...]:
    return (_width(unit, low, high),)


def _places(unit: str, low: float, high: float) -> tuple[Quantity, ...]:
    return (_place(unit, low, high),)


def _both(unit: str, low: float, high: float) -> tuple[Quantity, ...]:
    return _place(unit, low, high), _width(unit, low, high)


def _period(unit: str, low: float, high: float) -> tuple[Quantity, ...]:
    """At least one period is seen: a part of one is no sine."""
    span = high - low
    period = Quantity(
        symbol="w", unit=unit, title="period", low=0.02 * span, high=span,
        start=0.5 * span, off=0.5 * span, scale=Scale.LOG,
    )  # fmt: skip
    return _place(unit, low, high), period


def _frequency(unit: str, low: float, high: float) -> tuple[Quantity, ...]:
    """Of any number of periods."""
    span = high - low
    frequency = Quantity(
        symbol="n", unit=f"1/{unit}", title="frequency", low=1.0 / span, high=1e5 / span,
        start=10.0 / span, off=10.0 / span, scale=Scale.LOG,
    )  # fmt: skip
    phase = Quantity(symbol="p", unit="1", title="phase, in turns", low=-1.0, high=1.0, start=0.0)
    return frequency, phase


def _power(unit: str, low: float, high: float) -> tuple[Quantity, ...]:
    return (
        Quantity(symbol="n", unit="1", title="exponent", low=0.1, high=8.0, start=2.0, off=2.0),
    )


def _fall(z: Array, p: Values) -> Array:
    """-z/w, no higher than any size could make up for: below 0 it grows without end."""
    return np.minimum(-z / p["w"], STEEPEST)


FORMS: Mapping[str, Form] = {
    "line": Form("a z/Z", _none, lambda z, Z, p: z / Z, grows=True),
    "power": Form(
        "a |z/Z|^n sign(z)", _power, lambda z, Z, p: np.sign(z) * np.abs(z / Z) ** p["n"],
        grows=True,
    ),
    "exponential": Form("a exp(-z/w)", _widths, lambda z, Z, p: np.exp(_fall(z, p)), grows=True),
    "saturation": Form(
        "a (1 - exp(-z/w))", _widths, lambda z, Z, p: -np.expm1(_fall(z, p)), grows=True
    ),
    "tanh": Form("a tanh(z/w)", _widths, lambda z, Z, p: np.tanh(z / p["w"])),
    "hinge": Form(
        "a max(z - m, 0)/Z", _places, lambda z, Z, p: np.maximum(z - p["m"], 0.0) / Z, grows=True
    ),
    "threshold": Form(
        "a/2 (1 + tanh((z - m)/w))", _both,
        lambda z, Z, p: 0.5 * (1.0 + np.tanh((z - p["m"]) / p["w"])),
    ),
    "bell": Form(
        "a exp(-((z - m)/w)^2)", _both,
        lambda z, Z, p: np.exp(-np.minimum(((z - p["m"]) / p["w"]) ** 2, STEEPEST)), steps=1.0,
    ),
    "sine": Form(
        "a sin(2 pi (z - m)/w)", _period,
        lambda z, Z, p: np.sin(2.0 * np.pi * (z - p["m"]) / p["w"]), steps=2.0,
    ),
    "swing": Form(
        "a sin(2 pi (n z - p))", _frequency,
        lambda z, Z, p: np.sin(2.0 * np.pi * (p["n"] * z - p["p"])), bends=False,
    ),
}  # fmt: skip

"""What it takes to hide an effect in a plant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from erdctl.plant.plant import Plant

Random = np.random.Generator
Shape = Mapping[str, float]
Law = tuple[Plant, dict[str, float]]


@dataclass(frozen=True)
class Scales:
    """Sizes of a campaign and of the plain damper in it, which make a strength dimensionless.

    x, v, a : largest |x|, |xdot|, |xddot|;  stroke : rated;  force : half its range
    duty : highest, 1 without control;  shortest, longest : records [s]
    energy : most that a record dissipates [J]
    tick : step of the simulation [s]
    """

    x: float
    v: float
    a: float
    stroke: float
    force: float
    duty: float
    shortest: float
    longest: float
    energy: float
    tick: float


@dataclass(frozen=True)
class Lies:
    """Where a law acts, of what it is, and how, in words that a key can say.

    slot : "force", "friction" (a force times sign(xdot)), "yield", "viscous", "gas", "fluid",
        "lag", "duty" or "deflection"
    coordinates : by the contract's names;  curve : its value in z and y, in the order of these
    alike : (slot, coordinates) in which the same law can be said as well
    """

    slot: str
    coordinates: tuple[str, ...]
    curve: str
    alike: tuple[tuple[str, tuple[str, ...]], ...] = ()


@dataclass(frozen=True, kw_only=True)
class Twin:
    """An effect: how a strength s becomes physics.

    name : as the file's;  family : effects of one family fill the same place, and are not paired
    also : a second family, of what fills two places
    part : of the force ("gas", "viscous", "yielding" or "") without which it cannot be seen
    low, start, high : strengths between which the wanted level is sought; low is all but nothing
    build : plant, s, drawn shape, scales -> plant
    law : a plant with the effect -> the nearest whose law is the one usually fitted, and its
        parameters by the field's symbols ("compression.T_d" for one of the paper's that the law
        changes); None where this twin's law is always another
    shows : fields of the plant that state its parameters, and their SI units: "physics.gap",
        "channel.skew", or "own.n" for a parameter that the twin's own file brings
    shape : name -> lowest and highest of a uniform draw
    lies : where its law acts and of what it is, if it is one of the motion and the control
    hidden : never logged, as a temperature
    soft : what lies behind it no longer moves as the rod does
    rigid : acts by the rod's motion, and is not paired with what is soft
    equivalents : names that no force channel at the rod tells from it
    """

    name: str
    family: str
    low: float
    start: float
    high: float
    build: Callable[[Plant, float, Shape, Scales], Plant]
    shows: Mapping[str, str]
    law: Callable[[Plant], Law] | None = None
    lies: Lies | None = None
    also: str = ""
    part: str = ""
    shape: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    hidden: bool = False
    soft: bool = False
    rigid: bool = False
    equivalents: tuple[str, ...] = ()

    def drawn(self, random: Random) -> dict[str, float]:
        """A shape."""
        return {k: float(random.uniform(a, b)) for k, (a, b) in self.shape.items()}

    def goes_with(self, other: Twin) -> bool:
        """Whether one damper can have both."""
        stiff = not ((self.soft and other.rigid) or (self.rigid and other.soft))
        apart = {self.family, self.also}.isdisjoint({other.family, other.also} - {""})
        return stiff and apart

"""What it takes to hide an effect in a plant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from erdctl.plant.plant import Plant

Random = np.random.Generator
Shape = Mapping[str, float]


@dataclass(frozen=True)
class Scales:
    """Sizes of a campaign and of the plain damper in it, which make a strength dimensionless.

    x, v, a : largest |x|, |xdot|, |xddot|;  stroke : rated;  force : half its range
    duty : highest;  shortest, longest : records [s];  energy : most that a record dissipates [J]
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
class Twin:
    """An effect: how a strength s becomes physics.

    family : effects of one family fill the same place, and are not paired
    part : of the force ("gas", "viscous", "yielding" or "") without which it cannot be seen
    low, start, high : strengths between which the wanted level is sought; low is all but nothing
    build : plant, s, drawn shape, scales -> plant
    shows : fields of the plant that state its parameters, as paths
    shape : name -> lowest and highest of a uniform draw
    hidden : never logged, as a temperature
    """

    name: str
    family: str
    part: str
    low: float
    start: float
    high: float
    build: Callable[[Plant, float, Shape, Scales], Plant]
    shows: tuple[str, ...]
    shape: Mapping[str, tuple[float, float]]
    hidden: bool = False

    def drawn(self, random: Random) -> dict[str, float]:
        """A shape."""
        return {k: float(random.uniform(a, b)) for k, (a, b) in self.shape.items()}

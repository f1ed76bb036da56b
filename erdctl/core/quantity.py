"""A physical parameter: symbol, unit, bounds, start, scale and off value."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

NEAR = 1e-3  # of a standard error
HARMLESS = 0.1  # of one while all others are held: a move that costs a hundredth of a variance


class Scale(Enum):
    """How a fit steps through a parameter."""

    LINEAR = "linear"
    LOG = "log"


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """One parameter of a model or an effect.

    symbol : the field's symbol, also its name in JSON
    unit : SI unit as text, "1" when it has none
    low, high : physical bounds (inclusive)
    start : where a fit begins
    off : finite value at which the physics that it belongs to is exactly absent
    scale : LINEAR or LOG; LOG needs low > 0; an off value of 0 then lies outside the bounds
    linear : the force is linear in it, so a fit solves for it instead of searching
    read_low : where given, the lowest value of a file; earlier versions fitted below `low`
    """

    symbol: str
    unit: str
    title: str
    low: float
    high: float
    start: float
    off: float = 0.0
    scale: Scale = Scale.LINEAR
    linear: bool = False
    read_low: float | None = None

    def __post_init__(self) -> None:
        if not self.low <= self.start <= self.high:
            raise ValueError(f"{self.symbol}: start {self.start} outside {self.low}..{self.high}")
        if self.scale is Scale.LOG and self.low <= 0:
            raise ValueError(f"{self.symbol}: a logarithmic scale needs a low bound above 0")

    def bound_at(
        self, value: float, stderr: float | None = None, alone: float = float("inf")
    ) -> float | None:
        """The bound that an estimate lies at, or None.

        stderr : of the estimate; nearer to the bound than a thousandth of it is at the bound, since
            a search that steps towards one stops just short of it
        alone : its error while all others are held: by a tenth of that an amplitude can be moved to
            its bound, and the data tell nothing of it. A shape is moved by a thousandth of its
            start, or of its range where that is logarithmic: farther off the force may be another
        Check: 4e-13 with an error of 77 is at a bound of 0, 0.5 is not; nor is 2000 with one of
        1e17 that others make up for.
        >>> q = Quantity(symbol="k", unit="N/m", title="", low=0, high=1e9, start=1, linear=True)
        >>> q.bound_at(4e-13, 77.0), q.bound_at(0.5, 77.0), q.bound_at(2000.0, 1e17, 3.0)
        (0, None, None)
        """
        bound = min(self.low, self.high, key=lambda b: abs(value - b))
        near = min(NEAR * (stderr or 0.0), HARMLESS * alone)
        if self.scale is Scale.LOG:
            bound = self.low if value * value < self.low * self.high else self.high
            near = min(near, NEAR * math.log(self.high / self.low) * bound)
        elif not self.linear:
            near = min(near, NEAR * (abs(self.start) or self.high - self.low))
        return bound if abs(value - bound) <= max(near, NEAR**3 * abs(bound)) else None

    def snapped(self, value: float) -> float:
        """The value; the bound, where it lies beyond that by no more than rounding.

        Units, logarithms and printed digits move a value at its bound to just beyond it.
        Check: exp(log(100)) is 100 and an ulp, and 100 is what was meant; 100.1 is not.
        >>> q = Quantity(symbol="g", unit="1", title="", low=0.05, high=100.0, start=1.0)
        >>> q.snapped(100.00000000000004), q.snapped(100.1)
        (100.0, 100.1)
        """
        near = min(max(value, self.low), self.high)
        return near if abs(value - near) <= NEAR**3 * abs(near) else value

    def admits(self, value: float) -> bool:
        """Whether a model may have this value: within the bounds, or off."""
        low = self.low if self.read_low is None else self.read_low
        return low <= value <= self.high or value == self.off

"""A physical parameter: symbol, unit, bounds, start, scale and off value."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

NEAR = 1e-3  # of a standard error


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
    absent : value where a file does not list it, since it was written before there was such a
        parameter; None if every file must
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
    absent: float | None = None

    def __post_init__(self) -> None:
        if not self.low <= self.start <= self.high:
            raise ValueError(f"{self.symbol}: start {self.start} outside {self.low}..{self.high}")
        if self.scale is Scale.LOG and self.low <= 0:
            raise ValueError(f"{self.symbol}: a logarithmic scale needs a low bound above 0")

    def bound_at(self, value: float, stderr: float | None = None) -> float | None:
        """The bound that an estimate lies at, or None.

        stderr : of the estimate; nearer to the bound than a thousandth of it is at the bound, since
            a search that steps towards one stops just short of it
        Check: 4e-13 with an error of 77 is at a bound of 0, 0.5 is not.
        >>> q = Quantity(symbol="k", unit="N/m", title="", low=0.0, high=1e9, start=1.0)
        >>> q.bound_at(4e-13, 77.0), q.bound_at(0.5, 77.0)
        (0.0, None)
        """
        near = NEAR * (stderr or 0.0)
        for bound in (self.low, self.high):
            if abs(value - bound) <= max(near, NEAR**3 * abs(bound)):
                return bound
        return None

    def admits(self, value: float) -> bool:
        """Whether a model may have this value: within the bounds, or off."""
        return self.low <= value <= self.high or value == self.off

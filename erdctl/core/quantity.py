"""A physical parameter: symbol, unit, bounds, start, scale and off value."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


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

    def __post_init__(self) -> None:
        if not self.low <= self.start <= self.high:
            raise ValueError(f"{self.symbol}: start {self.start} outside {self.low}..{self.high}")
        if self.scale is Scale.LOG and self.low <= 0:
            raise ValueError(f"{self.symbol}: a logarithmic scale needs a low bound above 0")

    def admits(self, value: float) -> bool:
        """Whether a model may have this value: within the bounds, or off."""
        return self.low <= value <= self.high or value == self.off

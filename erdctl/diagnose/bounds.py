"""Between what values a log tells parameters, whatever else acts in it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from erdctl.core.blocks import Block
from erdctl.model.effect import Effect
from erdctl.model.slots import Values


class Bounds(NamedTuple):
    """Values of parameters that a log resolves at least, and allows at most, by name."""

    least: Values
    most: Values

    @classmethod
    def of(cls, effects: Iterable[Effect], block: Block) -> Bounds:
        """What the effects say of a log."""
        least, most = dict[str, float](), dict[str, float]()
        for effect in effects:
            least |= effect.resolved(block.signals, block.force)
            most |= effect.allowed(block.signals, block.force)
        return cls(least, most)

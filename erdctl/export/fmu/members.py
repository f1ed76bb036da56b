"""The parameters of a block of C as variables of FMI, within the bounds that are known of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Protocol

from erdctl.core.recording import DIRECTIONS
from erdctl.export.c.names import identifier
from erdctl.export.fmu.block import FmuVariable
from erdctl.model.paper import QUANTITIES
from erdctl.model.parameters import Parameters

Bounds = Mapping[str, tuple[float, float]]  # by place in the params struct
ANY = (-math.inf, math.inf)


class InStruct(Protocol):
    """A member of a block's params struct."""

    @property
    def path(self) -> str: ...
    @property
    def value(self) -> float: ...
    @property
    def unit(self) -> str: ...
    @property
    def title(self) -> str: ...


def variables(members: Iterable[InStruct], bounds: Bounds) -> tuple[FmuVariable, ...]:
    """Every member as a tunable parameter, named as in a parameter file where it is one of its."""
    return tuple(_variable(m, bounds.get(m.path, ANY)) for m in members)


def _variable(m: InStruct, bounds: tuple[float, float]) -> FmuVariable:
    way, _, symbol = m.path.partition("_")
    name = f"{way}.{symbol}" if way in DIRECTIONS and symbol in QUANTITIES else m.path
    plain = FmuVariable(name=name, unit=m.unit, title=m.title, member=m.path, start=m.value)
    # A value that the file has is taken, wherever it lies.
    return replace(plain, low=min(bounds[0], m.value), high=max(bounds[1], m.value))


def of_model(parameters: Parameters) -> Bounds:
    """Bounds of the paper's parameters and of those of all effects."""
    paper = {f"{way}_{symbol}": q for way in DIRECTIONS for symbol, q in QUANTITIES.items()}
    own = {
        f"{identifier(e.name)}.{identifier(q.symbol)}": q
        for e in parameters.model.effects
        for q in e.quantities
    }
    return {path: (q.low, q.high) for path, q in (paper | own).items()}

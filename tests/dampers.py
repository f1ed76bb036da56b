"""Parameters for tests of tables, with errors and with effects."""

from __future__ import annotations

from typing import Any

from rig import TRUTH

from erdctl.effects import get
from erdctl.model.composed import Model
from erdctl.model.parameters import Estimate, Parameters

RANGES = {"x": [-0.02, 0.02], "xdot": [-0.15, 0.2], "duty": [0.0, 0.4]}


def damper(*names: str, errors: float = 0.0, ranges: Any = RANGES, **given: float) -> Parameters:
    """The campaign's damper with some effects.

    errors : relative standard errors;  given : values of the effects by symbol
    """
    chosen = tuple(get(name) for name in names)
    model = Model(chosen)
    values = TRUTH | {
        e.key(q.symbol): given.get(q.symbol, q.start) for e in chosen for q in e.quantities
    }
    estimates = {
        name: Estimate(value=values[name], unit=q.unit, stderr=abs(errors * values[name]) or None)
        for name, q in model.quantities.items()
    }
    origin = {} if ranges is None else {"ranges": ranges}
    return Parameters(model=model, estimates=estimates, provenance=origin)

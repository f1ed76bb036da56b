"""Force and its derivatives by parameters, also between samples and where the force jumps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array
from erdctl.core.signals import Signals
from erdctl.estimate.finer import Finer
from erdctl.model.composed import Model
from erdctl.model.slots import Values

DIFFERENCE = 1e-6  # relative step of a one-sided difference
LEAST = 1e-3  # of a value, in its unit, where it and its start are 0
WIDE = 1e-3  # relative step to either side of a parameter that the force may jump with


def jacobian(model: Model, signals: Signals, values: Values, free: Sequence[str]) -> Array:
    """(p, n) derivative of the force by every free parameter."""
    return linearised(model, Finer.none(signals), values, free)[1]


def linearised(
    model: Model, finer: Finer, values: Values, free: Sequence[str], *, wide: bool = False
) -> tuple[Array, Array]:
    """(n,) force and its (p, n) derivative by every free parameter.

    wide : the slope of an effect's parameter over a thousandth of it to either side. Where force
        jumps from sample to sample as the parameter grows (contacts, delays), the slope at a point
        is that of one sample
    """
    # Slopes change little between a simulation in the log's steps and one between them.
    prepared = model.prepare(finer.log, values)
    # Where the force feeds back on itself no column stands alone.
    known = zip(model.linear, prepared.columns(), strict=True) if model.separable else ()
    linear = dict(known)
    force = prepared.force(values)
    rows = []
    for name in free:
        if name in linear:
            rows.append(linear[name])
            continue
        q, value = model.quantities[name], values[name]
        if wide and name.split(".")[0] not in DIRECTIONS:
            step = WIDE * max(abs(value), 0.1 * max(abs(q.start), LEAST))
            low, high = max(value - step, q.low), min(value + step, q.high)
            ends = [finer.force(model, {**values, name: v}) for v in (low, high)]
            rows.append((ends[1] - ends[0]) / (high - low))
            continue
        step = DIFFERENCE * max(abs(value), 1e-3 * max(abs(q.start), LEAST))
        step = -step if value + step > q.high else step
        shifted = model.force(finer.log, {**values, name: value + step})
        rows.append((shifted - force) / step)
    return force if finer.rows is None else finer.force(model, values), np.array(rows)

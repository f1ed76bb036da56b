"""The closed forms of the field that are most like a learned curve, and where their fit begins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.forms import FORMS, STEEPEST, Form
from erdctl.model.learned.law import Law
from erdctl.model.slots import Values


def closed_forms(law: Law, values: Values, z: Array) -> list[tuple[Law, dict[str, float]]]:
    """A law in closed forms, those like its curve first, each with values of its parameters.

    values : of the law's own parameters;  z : (n,) samples of the coordinate: the curve is weighed
        where they lie
    """
    curve, adds, samples = law.curve, law.slot.adds, z
    z = np.quantile(z, np.linspace(0.0, 1.0, thresholds.CURVE_POINTS))
    sizes = np.array([values[q.symbol] for q in curve.amplitudes(law.unit)])
    target = sizes @ curve.at(z, values)
    memory = {symbol: values[symbol] for symbol in ("tau", "zeta") if symbol in values}
    found = []
    for form, facts in ((name, f) for name, f in FORMS.items() if f.bends):
        new = replace(curve, knots=curve.range, form=form, zero_first=False)
        shape = _told(facts, facts.parameters(curve.kind.unit, *curve.range), samples)
        if shape is None:
            continue
        miss, own = _nearest(new, shape, z, target, constant=not adds)
        found.append((miss, replace(law, curve=new), {**own, **memory}))
    found.sort(key=lambda f: f[0])
    return [(new, own) for _, new, own in found[: thresholds.FORMS_FITTED]]


def _told(form: Form, shape: Sequence[Quantity], z: Array) -> list[Quantity] | None:
    """The parameters of a form within what samples (n,) tell; None where they tell none of it."""
    least, out = form.narrowest(z), []
    for q in shape:
        if q.symbol == "w" and q.low < least:
            if least >= q.high:
                return None
            q = replace(q, low=least, start=max(q.start, least))
        out.append(q)
    return out


def _nearest(
    curve: Curve, shape: Sequence[Quantity], z: Array, target: Array, *, constant: bool
) -> tuple[float, dict[str, float]]:
    """The square that a form misses of a curve (k,) at z (k,), and its values there.

    constant : whether a factor may be 1 at another place, which a size of the model makes up for
    """
    from scipy.optimize import least_squares

    def solved(point: Sequence[float]) -> tuple[Array, Array]:
        own = {q.symbol: v for q, v in zip(shape, point, strict=True)}
        rows = curve.at(z, own)
        if np.abs(rows).max() < np.exp(-STEEPEST):
            rows = np.zeros_like(rows)  # what no size makes up for
        rows = np.vstack([rows, np.ones_like(z)]) if constant else rows
        sizes = np.linalg.lstsq(rows.T, target, rcond=None)[0]
        return target - sizes @ rows, sizes.astype(np.float64)

    starts = product(*(_tried(q) for q in shape))
    best = min(starts, key=lambda point: float(np.sum(solved(point)[0] ** 2)))
    if shape:
        ends = [q.low for q in shape], [q.high for q in shape]
        scale = [abs(v) + 1e-3 * (q.high - q.low) for q, v in zip(shape, best, strict=True)]
        as_set = np.geterr()

        def missed(point: Sequence[float]) -> Array:
            with np.errstate(**as_set):
                return solved(point)[0]

        # Where no step gets any nearer, the search divides 0 by 0, and ends there.
        with np.errstate(invalid="ignore"):
            best = tuple(least_squares(missed, best, bounds=ends, x_scale=scale).x)
    left, sizes = solved(best)
    size = float(sizes[0])
    if constant:
        size /= max(1.0 + float(sizes[1]), thresholds.LEAST_FACTOR)
    return float(left @ left), {
        "a": size,
        **{q.symbol: float(v) for q, v in zip(shape, best, strict=True)},
    }


def _tried(q: Quantity) -> list[float]:
    """Values of one parameter to look at, inside its bounds."""
    part = np.linspace(0.0, 1.0, thresholds.FORM_STARTS + 2)[1:-1]
    if q.scale is Scale.LOG:
        return [float(q.low * (q.high / q.low) ** p) for p in part]
    return [float(q.low + p * (q.high - q.low)) for p in part]

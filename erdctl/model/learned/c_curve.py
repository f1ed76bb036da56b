"""Curves and surfaces of learned laws as C: a value at values of their coordinates.

The sizes at the knots are parameters, which a program may change. So what is tabulated is not the
curve but the second derivatives of the natural splines that are 1 at one knot: with a = 1 - b and
b the part of the interval of width w between two knots that lies below z,

    B_j(z) = a d_ij + b d_(i+1)j + w^2/6 ((a^3 - a) M_ij + (b^3 - b) M_(i+1)j)

Source: C. de Boor, A Practical Guide to Splines (2001), Ch. 4.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from erdctl.core.recording import Array
from erdctl.model.learned.c_coordinates import NEVER
from erdctl.model.learned.curve import GROWN, REACH, Curve
from erdctl.model.learned.forms import FORMS, STEEPEST
from erdctl.model.learned.surface import Surface

WIDTH = 88  # of the lines of a table

_FALL = f"FMIN(-AT / p->w, K({STEEPEST!r}))"
_TURN = f"K({2.0 * float(np.pi)!r})"

# Of AT, a value of the coordinate; SCALE is the largest size of it within its range.
FORMS_IN_C: Mapping[str, str] = {
    "line": "AT / SCALE",
    "power": "(AT < K(0.0) ? K(-1.0) : K(1.0)) * POW(FABS(AT / SCALE), p->n)",
    "exponential": f"EXP({_FALL})",
    "saturation": f"-EXPM1({_FALL})",
    "tanh": "TANH(AT / p->w)",
    "hinge": "FMAX(AT - p->m, K(0.0)) / SCALE",
    "threshold": "K(0.5) * (K(1.0) + TANH((AT - p->m) / p->w))",
    "bell": f"EXP(-FMIN((AT - p->m) / p->w * ((AT - p->m) / p->w), K({STEEPEST!r})))",
    "sine": f"SIN({_TURN} * (AT - p->m) / p->w)",
    "swing": f"SIN({_TURN} * (p->n * AT - p->p))",
}
assert FORMS_IN_C.keys() == FORMS.keys()


class CCurve(NamedTuple):
    """A curve in C.

    declared : tables and variables
    code : statements that set `value` from `at`, of a surface from `at` and `by`, in any range
    """

    declared: str
    code: str


def bends(knots: Sequence[float]) -> Array:
    """(k, k) second derivative at each knot of the spline that is 1 at another one.

    Check: of 0, 1, 0 at 0, 1, 2 it is -3 in the middle.
    >>> bends((0.0, 1.0, 2.0))[:, 1].round(9).tolist()
    [0.0, -3.0, 0.0]
    """
    from scipy.interpolate import CubicSpline

    at = np.array(knots)
    if len(at) == 2:
        return np.zeros((2, 2))
    out = np.asarray(CubicSpline(at, np.eye(len(at)), bc_type="natural")(at, 2))
    out[[0, -1]] = 0.0
    return out


def table(name: str, values: Sequence[float]) -> str:
    """A constant array."""
    inner = textwrap.wrap(", ".join(f"K({float(v)!r})" for v in values), WIDTH)
    listed = "\n".join(f"    {line}" for line in inner)
    return f"static const real {name}[{len(values)}] = {{\n{listed}\n}};"


def curve_in_c(curve: Curve, unit: str) -> CCurve:
    """A curve with its sizes, in a unit, from the parameters."""
    if isinstance(curve, Surface):
        return _surface(curve, unit)
    return _spline(curve, unit) if curve.form is None else _form(curve, curve.form)


def _form(curve: Curve, form: str) -> CCurve:
    low, high = curve.range
    reach, equation = REACH * (high - low), FORMS_IN_C[form]
    equation = equation.replace("SCALE", f"K({max(abs(low), abs(high))!r})")
    near, within = (
        f"clipped(at, K({a!r}), K({b!r}))" for a, b in ((low - reach, high + reach), (low, high))
    )
    code = f"at = FABS(at) < {NEVER} / K(2.0) ? {near} : {within};\nvalue = {_of('at', equation)};"
    if not FORMS[form].grows:
        return CCurve("", f"{code}\nvalue *= p->a;")
    ends = ", ".join(f"FABS({_of(f'K({z!r})', equation)})" for z in (low, high))
    return CCurve(
        "real most;",
        f"""\
{code}
most = K({GROWN!r}) * FMAX({ends});
value = p->a * clipped(value, -most, most);""",
    )


def _of(at: str, equation: str) -> str:
    return re.sub(r"\bAT\b", at, equation)


def _axis(curve: Curve, of: str) -> str:
    n = len(curve.knots)
    return "\n".join(
        (
            table(f"{of}_knots", curve.knots),
            table(f"{of}_bends", bends(curve.knots).ravel().tolist()),
            f"real {of}_rows[{n}];",
        )
    )


def _rows(curve: Curve, of: str) -> str:
    return f"splines({of}_knots, {of}_bends, {len(curve.knots)}, {of}, {of}_rows);"


def _sizes(curve: Curve, unit: str) -> str:
    """The values at the knots, from the parameters."""
    given = [f"p->{q.symbol}" for q in curve.amplitudes(unit)]
    all_ = ["K(0.0)"] * int(curve.zero_first) + given
    return f"const real sizes[{len(all_)}] = {{{', '.join(all_)}}};"


def _spline(curve: Curve, unit: str) -> CCurve:
    return CCurve(
        f"{_axis(curve, 'at')}\n{_sizes(curve, unit)}\nint i;",
        f"""\
{_rows(curve, "at")}
value = K(0.0);
for (i = 0; i < {len(curve.knots)}; ++i) value += sizes[i] * at_rows[i];""",
    )


def _surface(curve: Surface, unit: str) -> CCurve:
    n, m = len(curve.knots), len(curve.across.knots)
    return CCurve(
        f"{_axis(curve, 'at')}\n{_axis(curve.across, 'by')}\n{_sizes(curve, unit)}\nint i, j;",
        f"""\
{_rows(curve, "at")}
{_rows(curve.across, "by")}
value = K(0.0);
for (i = 0; i < {n}; ++i) {{
    for (j = 0; j < {m}; ++j) value += sizes[{m} * i + j] * at_rows[i] * by_rows[j];
}}""",
    )

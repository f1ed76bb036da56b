"""A curve over one coordinate: through values at knots, or in a closed form of the field.

Outside the range in which it was learned a curve through knots stays at its end value. A closed
form goes on, as the model's own equations do: it was taken since it predicts kinds of motion left
out of its fit. Not without end: a power of 5 would be 240 times as large at three times the range.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.learned.coordinates import KINDS, CoordinateKind, Memory, along
from erdctl.model.learned.forms import FORMS
from erdctl.model.slots import Values

MOST = {"N": 1e9, "m": 1.0, "1": 10.0}  # of an added force, a deflection, a factor
REMEMBERED = 100_000  # samples, up to which a spline is not evaluated again
MARGIN = 0.05  # of a range, that is no extrapolation yet
REACH = 2.0  # ranges, as far as which a closed form goes on beyond its own
GROWN = 1.0 + REACH  # times its size at the ends of the range at most, which a line has there
SHORTEST, LONGEST = 1e-4, 1e5  # s, of a memory
LEAST_WAY, MOST_WAY = 1e-7, 1.0  # m, of one over the travel


@dataclass(frozen=True)
class Curve:
    """f(z) = sum of amplitudes times rows(z, other parameters).

    coordinate : a name in `KINDS`
    knots : (k,) rising values of z, the first and the last the ends of the range seen
    form : of the field, a name in `FORMS`; None for a natural cubic spline through one value at
        each knot
    zero_first : whether a spline is 0 at the first knot, where another parameter of the model makes
        up for a constant
    tau : where the search of the coordinate's time constant, or travel, begins [s], [m]
    """

    coordinate: str
    knots: tuple[float, ...]
    form: str | None = None
    zero_first: bool = False
    tau: float = 1.0

    @property
    def axes(self) -> tuple[Curve, ...]:
        """The curves whose coordinates it is over: itself."""
        return (self,)

    @property
    def name(self) -> str:
        """For the name of an effect."""
        what = self.form or f"spline{len(self.knots)}"
        return f"{self.coordinate}_{what}"

    @property
    def kind(self) -> CoordinateKind:
        """What is known of the coordinate."""
        return KINDS[self.coordinate]

    def amplitudes(self, unit: str) -> list[Quantity]:
        """Those of the rows, in a unit: N, m, or 1 of a factor."""
        most = MOST[unit]
        # A factor is 1 at the first knot.
        low = self.kind.least - 1.0 if unit == "1" and self.form is None else -most
        if self.form is not None:
            titles = {"a": "size"}
        else:
            first = int(self.zero_first)
            at = self.kind.unit
            titles = {
                f"f_{k + 1}": f"at {self.knots[k]:.4g} {at}" for k in range(first, len(self.knots))
            }
        return [
            Quantity(
                symbol=symbol, unit=unit, title=title, low=low, high=most, linear=unit == "N",
                start=0.0 if self.form is None else 0.3 if unit == "N" else 0.03 * most,
            )
            for symbol, title in titles.items()
        ]  # fmt: skip

    def shape(self) -> list[Quantity]:
        """All other parameters."""
        out = []
        if self.kind.late:
            way = self.kind.by_way
            low, high = (LEAST_WAY, MOST_WAY) if way else (SHORTEST, LONGEST)
            at = min(max(self.tau, low), high)
            out.append(
                Quantity(
                    symbol="tau", unit=self.kind.forgets, low=low, high=high, start=at, off=at,
                    title="travel of the memory" if way else "time constant of the memory",
                    scale=Scale.LOG,
                )
            )  # fmt: skip
        if self.kind.rings:
            out.append(
                Quantity(
                    symbol="zeta", unit="1", title="damping ratio of what rings",
                    low=0.005, high=0.95, start=0.1, off=0.1, scale=Scale.LOG,
                )
            )  # fmt: skip
        if self.form is not None:
            out += FORMS[self.form].parameters(self.kind.unit, *self.range)
        return out

    @property
    def range(self) -> tuple[float, float]:
        """What the coordinate spanned where the curve was learned."""
        return self.knots[0], self.knots[-1]

    def beyond(self, s: Signals, p: Values) -> tuple[float, float, float]:
        """Least and largest value of the coordinate, and the part of the samples out of range."""
        z, (low, high) = along(self.coordinate, s, Memory.of(p)), self.range
        z, margin = z[np.isfinite(z)], MARGIN * (high - low)
        if z.size == 0:
            return low, high, 0.0
        out = (z < low - margin) | (z > high + margin)
        return float(z.min()), float(z.max()), float(np.mean(out))

    @property
    def ends(self) -> str:
        """What it does beyond its range, in words."""
        if self.form is None:
            return "it stays at its end value"
        return f"it goes on by its form as far as {REACH:g} times that range, tested by no data"

    @property
    def equation(self) -> str:
        """In z, the coordinate, and the parameters."""
        if self.form is None:
            return "f(z)"
        return FORMS[self.form].equation

    def rows(self, s: Signals, p: Values) -> Array:
        """(k, n) what an amplitude of 1, and 0 for the others, gives."""
        memory = Memory.of(p) if self.kind.late else None
        if self.form is None:
            known = _known if len(s) <= REMEMBERED else _through
            return known(self.coordinate, s, memory, self.knots)[int(self.zero_first) :]
        return self.at(along(self.coordinate, s, memory), p)

    def at(self, z: Array, p: Values) -> Array:
        """(k, n) the same at values of the coordinate (n,), infinite where there is none yet.

        Check: at its own knot each is 1, at the others 0, and beyond the last one it stays.
        >>> c = Curve("x", (0.0, 1.0, 2.0), zero_first=True)
        >>> c.at(np.array([0.0, 1.0, 2.0, 5.0]), {}).round(9).tolist()
        [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]]

        Check: over 0 to 2 a line is z / 2: 0.5, 1, 2 at 1, 2, 4; as far as two ranges beyond, at 6,
        it is 3; and where there is no z it has its end value of 1.
        >>> line = Curve("since_duty_step", (0.0, 2.0), "line")
        >>> line.at(np.array([1.0, 2.0, 4.0, 100.0, np.inf]), {}).tolist()
        [[0.5, 1.0, 2.0, 3.0, 1.0]]
        """
        if self.form is None:
            return _spline(z, self.knots)[int(self.zero_first) :]
        form, (low, high) = FORMS[self.form], self.range
        scale, reach = max(abs(low), abs(high)), REACH * (high - low)
        within, near = np.clip(z, low, high), np.clip(z, low - reach, high + reach)
        value = form.value(np.where(np.isinf(z), within, near), scale, p)
        if form.grows:
            most = GROWN * np.abs(form.value(np.array([low, high]), scale, p)).max()
            value = np.clip(value, -most, most)
        return value[None]


def _spline(z: Array, knots: tuple[float, ...]) -> Array:
    """(k, n) natural cubic splines through 1 at one of the knots and 0 at the others."""
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(np.array(knots), np.eye(len(knots)), bc_type="natural")
    return np.ascontiguousarray(spline(np.clip(z, knots[0], knots[-1])).T)


def _through(coordinate: str, s: Signals, memory: Memory | None, knots: tuple[float, ...]) -> Array:
    return _spline(along(coordinate, s, memory), knots)


# A search moves one parameter at a time, and most of them move no coordinate.
_known = lru_cache(maxsize=32)(_through)

"""A learned law over two coordinates: a curve over the one, for each of some values of the other.

    f(z, y) = sum of f_ij B_i(z) C_j(y)

B, C : natural cubic splines that are 1 at one of their knots and 0 at the others, so that f_ij is
the value at the knots i and j.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.learned.coordinates import Memory
from erdctl.model.learned.curve import REMEMBERED, Curve
from erdctl.model.slots import Values


@dataclass(frozen=True)
class Surface(Curve):
    """A spline over a grid of knots; across : that of the second coordinate, which has no memory.

    zero_first : whether it is 0 where both coordinates are at their first knot
    """

    across: Curve = field(kw_only=True)

    @property
    def axes(self) -> tuple[Curve, ...]:
        """The curves whose coordinates it is over."""
        return self, self.across

    @property
    def name(self) -> str:
        """For the name of an effect."""
        of, by = self.across, f"{len(self.knots)}x{len(self.across.knots)}"
        return f"{self.coordinate}_{of.coordinate}_spline{by}"

    @property
    def equation(self) -> str:
        """In z and y, the coordinates within their ranges."""
        return "f(z, y)"

    def amplitudes(self, unit: str) -> list[Quantity]:
        """Those of the rows, the second coordinate's knots running fastest."""
        first = super().amplitudes(unit)[0]
        u, v = self.kind.unit, self.across.kind.unit
        out = [
            replace(first, symbol=f"f_{i}_{j}", title=f"at {z:.4g} {u} and {y:.4g} {v}")
            for i, z in enumerate(self.knots, start=1)
            for j, y in enumerate(self.across.knots, start=1)
        ]
        return out[int(self.zero_first) :]

    def rows(self, s: Signals, p: Values) -> Array:
        """(k, n) what an amplitude of 1, and 0 for the others, gives."""
        known = _known if len(s) <= REMEMBERED else Surface._rows
        return known(self, s, Memory.of(p) if self.kind.late else None)

    def _rows(self, s: Signals, memory: Memory | None) -> Array:
        p = {} if memory is None else memory._asdict()
        return self._products(self._whole.rows(s, p), self.across.rows(s, {}))

    def at_both(self, z: Array, y: Array) -> Array:
        """(k, n) the same at values of the coordinates, (n,) each.

        Check: at the second knot of the first and the first of the second one f_2_1 counts 1, the
        others 0.
        >>> f = Surface("x", (0.0, 1.0, 2.0), zero_first=True, across=Curve("duty", (0.0, 1.0)))
        >>> f.at_both(np.array([1.0]), np.array([0.0])).round(9).ravel().tolist()
        [0.0, 1.0, 0.0, 0.0, 0.0]
        """
        return self._products(self._whole.at(z, {}), self.across.at(y, {}))

    @property
    def _whole(self) -> Curve:
        return Curve(self.coordinate, self.knots, tau=self.tau)

    def _products(self, b: Array, c: Array) -> Array:
        rows: Array = (b[:, None, :] * c[None, :, :]).reshape(-1, b.shape[1])
        return rows[int(self.zero_first) :]


# A search moves one parameter at a time, and most of them move neither coordinate.
_known = lru_cache(maxsize=8)(Surface._rows)

"""Physics that a twin brings in its own file: pure functions of a record, and where they enter.

    U    -> voltage(U)                    what the supply is told
    c    -> c viscous,  F_y -> F_y yielding
    sign(xdot) -> sign                    of the yield force
    F    -> force(F)                      what acts beside gas and fluid, or on the whole damper
    F    -> recorded(F)                   what the channel makes of it, before skew, drift and range
    xdot -> velocity(xdot)                what the velocity channel shows, at the samples of the log

All but the last see a whole record at once, on the fine grid of the simulation, its piston as the
rod and its free play move it. So they are not for what lies behind a spring, which moves by its
force.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Values = Mapping[str, float]


@dataclass(frozen=True, eq=False)
class FineGrid:
    """A record on the fine grid, (m,) each.

    t : time of the record, < 0 while it is led in [s];  x, v, a : of the piston [m], [m/s], [m/s2]
    U : duty told to the supply during the step before a node [1];  h : step [s]
    start, stop : nodes of the record itself are start..stop - 1, the rest leads in and out
    every : nodes from one sample of the log to the next
    """

    t: Array
    x: Array
    v: Array
    a: Array
    U: Array
    h: float
    start: int
    stop: int
    every: int


@dataclass(frozen=True)
class Hooks:
    """Where a twin's own functions enter, None where it has none.

    name : of the twin;  grid : (m,) nodes;  p : its parameters by symbol
    voltage : (U, grid, p) -> (m,) duty that the supply follows instead, 0..1
    viscous, yielding : (grid, p) -> (m,) factors of viscous and yield force
    sign : (grid, p) -> (m,) in -1..1 in place of sign(xdot) in the yield force
    force : (F, grid, p) -> (m,) force of the damper from that without it [N]
    recorded : (F, grid, p) -> (m,) what the force channel shows of it [N]
    velocity : (v, record, p) -> (n,) what the velocity channel shows of the rod's [m/s]; record is
        its number, so that each can have noise of its own
    """

    name: str
    voltage: Callable[[Array, FineGrid, Values], Array] | None = None
    viscous: Callable[[FineGrid, Values], Array] | None = None
    yielding: Callable[[FineGrid, Values], Array] | None = None
    sign: Callable[[FineGrid, Values], Array] | None = None
    force: Callable[[Array, FineGrid, Values], Array] | None = None
    recorded: Callable[[Array, FineGrid, Values], Array] | None = None
    velocity: Callable[[Array, int, Values], Array] | None = None

    @property
    def rigid(self) -> bool:
        """Whether it acts by the piston's motion, which must be known beforehand."""
        return any((self.viscous, self.yielding, self.sign, self.force))


@njit(cache=True)
def behind_play(x: Array, v: Array, a: Array, gap: float) -> tuple[Array, Array, Array]:
    """Motion of a piston that the rod takes along at either end of its play.

    Check: x = 0, 1, 2, 1, 0 mm, moving up from the start, gap 2 mm gives -1, 0, 1, 1, 1 mm.
    >>> x, v = np.array([0.0, 1.0, 2.0, 1.0, 0.0]), np.array([1.0, 1.0, 1.0, -1.0, -1.0])
    >>> behind_play(x, v, 0.0 * v, 2.0)[0].tolist()
    [-1.0, 0.0, 1.0, 1.0, 1.0]
    """
    z, zv, za = np.empty(len(x)), v.copy(), a.copy()
    way = 0.0
    if v[0] > 0.0:
        way = 1.0
    elif v[0] < 0.0:
        way = -1.0
    at = x[0] - 0.5 * gap * way
    for k in range(len(x)):
        before = at
        at = min(max(at, x[k] - 0.5 * gap), x[k] + 0.5 * gap)
        if gap > 0.0 and not ((at > before and v[k] > 0.0) or (at < before and v[k] < 0.0)):
            zv[k] = za[k] = 0.0
        z[k] = at
    return z, zv, za

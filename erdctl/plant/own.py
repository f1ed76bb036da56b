"""The physics of twins' own files, applied to one record."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.plant.hooks import FineGrid
from erdctl.plant.march import OwnLaws
from erdctl.plant.plant import Own

Array = npt.NDArray[np.float64]

EMPTY = np.empty(0)
NOTHING = OwnLaws(EMPTY, EMPTY, EMPTY, EMPTY)


def velocity(own: tuple[Own, ...], v: Array, record: int) -> Array:
    """(n,) velocity of the rod in one record, as its channel shows it [m/s]."""
    for hooks, values in own:
        if hooks.velocity:
            v = hooks.velocity(v, record, dict(values))
    return v


@dataclass(frozen=True, eq=False)
class Applied:
    """Some twins' own physics on one record."""

    own: tuple[Own, ...]
    grid: FineGrid

    def given(self) -> OwnLaws:
        """What the simulation is told of each node; factors of several twins multiply."""
        command, on_viscous, on_yield, sign = NOTHING
        for hooks, values in self.own:
            p = dict(values)
            if hooks.voltage:
                before = command if len(command) else self.grid.U
                command = self._checked(hooks.name, hooks.voltage(before, self.grid, p))
            if hooks.viscous:
                factor = self._checked(hooks.name, hooks.viscous(self.grid, p))
                on_viscous = on_viscous * factor if len(on_viscous) else factor
            if hooks.yielding:
                factor = self._checked(hooks.name, hooks.yielding(self.grid, p))
                on_yield = on_yield * factor if len(on_yield) else factor
            if hooks.sign:
                if len(sign):
                    raise ValueError(f"{hooks.name}: another twin stands for sign(xdot) already")
                sign = self._checked(hooks.name, hooks.sign(self.grid, p))
        return OwnLaws(command, on_viscous, on_yield, sign)

    def force(self, F: Array) -> Array:
        """(m,) force of the damper [N]."""
        for hooks, values in self.own:
            if hooks.force:
                F = self._checked(hooks.name, hooks.force(F, self.grid, dict(values)))
        return F

    def recorded(self, F: Array) -> Array:
        """(m,) force as its channel shows it [N]."""
        for hooks, values in self.own:
            if hooks.recorded:
                F = self._checked(hooks.name, hooks.recorded(F, self.grid, dict(values)))
        return F

    def _checked(self, name: str, values: Array) -> Array:
        out = np.ascontiguousarray(values, dtype=float)
        if out.shape != self.grid.t.shape or not np.isfinite(out).all():
            raise ValueError(
                f"twin {name}: its function gave {out.shape}, or what is no number; expected "
                f"{self.grid.t.shape} finite values, one for each fine node"
            )
        return out

"""A measured force in another unit, or of the other sign, than a model says that it is."""

from __future__ import annotations

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.core.recording import Array

ALIKE = 0.95  # correlation of the two from which their ratio is a number
CLOSE = 0.05
SAMPLES = 100_000
UNITS = {
    "kN": 1e-3, "lbf": 1 / 4.4482216, "kgf": 1 / 9.80665, "mN": 1e3,
}  # fmt: skip


class Both:
    """Samples of a measured force and of a modelled one, evenly out of a log of so many."""

    def __init__(self, samples: int) -> None:
        self.every = 1 + samples // SAMPLES
        self._force: list[Array] = []
        self._modelled: list[Array] = []

    def add(self, first: int, force: Array, modelled: Array) -> None:
        """The next samples (n,) [N], which begin with the log's sample `first`."""
        even = slice(-first % self.every, None, self.every)
        self._force.append(force[even].copy())
        self._modelled.append(modelled[even].copy())

    def check(self) -> list[RigFault]:
        """What they say of the channel; see `check`."""
        if not self._force:
            return []
        return check(np.concatenate(self._force), np.concatenate(self._modelled))


def check(F: Array, M: Array) -> list[RigFault]:
    """What the ratio of a measured to a modelled force (n,) [N] says of the channel.

        g = sum F M / sum M^2,   both about their means

    Nothing, unless the two go together and g is that of a unit, or -1.
    """
    F, M = F - F.mean(), M - M.mean()
    both = float(F @ M)
    size = float(np.sqrt((F @ F) * (M @ M)))
    if size == 0.0 or abs(both) < ALIKE * size:
        return []
    gain = both / float(M @ M)
    if abs(gain + 1.0) < 0.5:
        return [
            RigFault(
                "force_sign", None,
                f"the measured force is {gain:.3g} times the modelled one, so of the other sign",
                'give --map "force=-force"', blocks=True,
            )
        ]  # fmt: skip
    for unit, factor in UNITS.items():
        if abs(gain / factor - 1.0) < CLOSE:
            return [
                RigFault(
                    "force_unit", None,
                    f"the measured force is {gain:.4g} times the modelled one, as if it were in"
                    f" {unit}",
                    f'if it is, give --map "force=force[{unit}]"', blocks=True,
                )
            ]  # fmt: skip
    return []

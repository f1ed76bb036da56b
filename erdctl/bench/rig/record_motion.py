"""A record whose deflection has a gain of its own, or whose damper is mounted the other way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.linear_model import Rows, of_others
from erdctl.core.recording import Array

LEAST = 0.01  # of the record's force, a misfit below which it is as the others are
TAKEN = 0.8  # of the square of that misfit
GAIN = 0.12  # least change of a gain
SAME = 0.3  # of the change of the gain, by which the gains of terms may be off
SPRING, DAMPING, REST = [1, 2], [3, 4], [0, 5, 6, 7]
# The parameters of a damper whose ends are exchanged, by those of one whose ends are not.
TURNED, SIGN = [0, 2, 1, 4, 3, 6, 5, 7], np.array([-1.0, *[1.0] * 7])


def misread(rows: Sequence[Rows]) -> RigFault | None:
    """By what is left where the motion is multiplied by a number, or all signs are the other.

        F = g (k_i x + c_i xdot) + F_ER sign(xdot),   or   F(x, xdot) = -F(-x, -xdot)

    All but g is that of the other records. Spring and damping must have the same g, each by itself,
    and the yield force that of the others: of a damper that has changed, or of another fluid, one
    of them alone is another, and an amplifier of the force multiplies all. Of the record that the
    others know least of, and no other: what is told of one beside a worse one is that one's.
    """
    squares = [r.square_left(of_others(rows, i)) for i, r in enumerate(rows)]
    i = int(np.argmax(squares))
    r, theta, record = rows[i], of_others(rows, i), rows[i].piece.record
    A, F = r.columns[r.smooth], r.force[r.smooth]
    misfit = _rms(F - A @ theta)
    if misfit < LEAST * _rms(F):
        return None
    most = float(np.sqrt(1.0 - TAKEN)) * misfit
    if _rms(F - A @ (theta[TURNED] * SIGN)) < most:
        return RigFault(
            "record_turned", record,
            "with x, xdot and force of the other sign it is as the other records are, as of a"
            " damper that was mounted the other way round",
            "it is left out of fits; change all three signs there, and no one of them alone",
            blocks=True,
        )  # fmt: skip
    gain, left = _gain(A, F, theta)
    if left < most:
        return RigFault(
            "record_deflection", record,
            f"its deflection and velocity are {1.0 / gain:.3g} times what its spring and damping"
            " force say, while its yield force is that of the other records",
            "it is left out of fits; look at the range of the displacement transducer, and the"
            " unit", blocks=True,
        )  # fmt: skip
    return None


def _gain(A: Array, F: Array, theta: Array) -> tuple[float, float]:
    """That of both forces that go with the motion, and what it leaves [N]; infinity without one."""
    spring, damping, rest = (A[:, c] @ theta[c] for c in (SPRING, DAMPING, REST))
    terms = np.column_stack([spring + damping, rest])
    (gain, beside), *_ = np.linalg.lstsq(terms, F, rcond=None)
    own = np.linalg.lstsq(np.column_stack([spring, damping, rest]), F, rcond=None)[0]
    off = np.abs(own - (gain, gain, 1.0)).max()
    if abs(gain - 1.0) < GAIN or off > SAME * abs(gain - 1.0):
        return 1.0, np.inf
    return float(gain), _rms(F - terms @ (gain, beside))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0

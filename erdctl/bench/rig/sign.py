"""Does the damper take energy? One that gives it back has a channel with the wrong sign."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import Piece

# Part of the power's magnitude. A damper takes 0.4 to 1 of it once its spring is taken away; a
# short record of few strokes may seem to give back some.
GIVEN_BACK = -0.35
REMEDY = (
    'if the force was recorded positive in extension, give --map "force=-force"; if the motion was,'
    ' --map "x=-x" --map "xdot=-xdot"'
)


def check(found: Sequence[Piece]) -> list[RigFault]:
    """Records in which the force does work on the rig.

        w = sum (F - F_spring) xdot / sum |(F - F_spring) xdot|

    with F_spring the straight line in x that fits best; w < GIVEN_BACK is reported.
    """
    share = {}
    for r in sorted({p.record for p in found}):
        parts = [p for p in found if p.record == r]
        value = _taken(parts)
        if value is not None:
            share[r] = value
    wrong = [r for r, w in share.items() if w < GIVEN_BACK]
    if not wrong:
        return []
    if len(wrong) == len(share):
        worst = float(np.mean([share[r] for r in wrong]))
        return [RigFault("force_sign", None, _text(worst), REMEDY, blocks=True)]
    return [RigFault("force_sign", r, _text(share[r]), REMEDY, blocks=True) for r in wrong]


def _text(share: float) -> str:
    return (
        "the damper gives energy back: the mean of force times xdot is negative"
        f" ({100 * share:+.0f} % of its magnitude), so the force or the motion has the wrong sign"
    )


def _taken(parts: Sequence[Piece]) -> float | None:
    """w of a record; None where the piston hardly turns or the force hardly changes."""
    x, v, force = (np.concatenate([p.of(c) for p in parts]) for c in ("x", "xdot", "force"))
    if np.ptp(x) == 0.0 or np.ptp(force) == 0.0:
        return None
    if min(np.count_nonzero(v > 0), np.count_nonzero(v < 0)) < 0.1 * len(v):
        return None
    # With the speed beside it, so that a spring is not taken for a damper over half a cycle.
    columns = np.column_stack([np.ones_like(x), x / np.ptp(x), v / max(np.abs(v).max(), 1e-300)])
    theta = np.linalg.pinv(columns.T @ columns, hermitian=True) @ (columns.T @ force)
    power = (force - columns[:, :2] @ theta[:2]) * v
    size = float(np.abs(power).sum())
    return float(power.sum()) / size if size > 0 else None

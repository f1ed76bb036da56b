"""Is the yield force the less the more duty is logged? No field does that, an inverted PWM does."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import Piece, spread
from erdctl.core.recording import Array

SAMPLES = 20_000  # that are looked at
LEAST = 80  # of a record, away from reversals and duty steps, eight a column
CHANGES = 0.03  # of the duty within a record, below which it is held
MOST = 0.7  # of the records in which the duty changes, that must say so
FEWEST = 3  # such records, and records of levels
# Of the range of the force, that the yield force falls by in all: where it does so within several
# records, and where it only differs between them, as their gains do, or there are one or two.
WITHIN, BETWEEN = 0.03, 0.15
REMEDY = (
    "log the part of the time in which the voltage is on (1 - duty of an active-low PWM);"
    " if the field does weaken this damper, --accept duty_inverted"
)


def check(found: Sequence[Piece]) -> list[RigFault]:
    """A yield force that falls with the duty, in compression and in release.

        F = k_i x + c_i xdot + (S_i + W_i t + D_i duty) sign(xdot),   i by direction

    W is what wears off or warms while a control rises. Both D are below 0 over all records, by a
    part of the force over the range of the duty, and in most of the records in which the duty
    changes; where too few do, over records of levels with any of them left out: one that had lost
    its force is no inverted channel.
    """
    rows = _rows(found)
    if len(rows) == 0:
        return []
    duty = np.concatenate([d for d, _, _ in rows.values()])
    force = np.concatenate([f for _, _, f in rows.values()])
    if np.ptp(duty) < CHANGES:
        return []
    changing = [r for r in rows.values() if np.ptp(r[0]) > CHANGES]
    several = len(changing) >= FEWEST
    within = several or len(changing) == len(rows)
    falls = -(WITHIN if several else BETWEEN) * spread(force) / float(np.ptp(duty))
    slopes = _slopes(list(rows.values()))
    if not (slopes < falls).all():
        return []
    if within:
        said = [bool((_slopes([r]) < 0.0).all()) for r in changing]
        agreed = bool(np.mean(said) >= MOST)
    else:
        levels = [[r for k, r in rows.items() if k != out] for out in rows]
        agreed = len(rows) > FEWEST and all((_slopes(rest) < falls).all() for rest in levels)
    if not agreed:
        return []
    drop = -float(slopes.mean() * np.ptp(duty))
    return [
        RigFault(
            "duty_inverted",
            None,
            f"the yield force is the less the more duty is logged: it falls by {drop:.3g} N from"
            f" {100 * duty.min():.3g} to {100 * duty.max():.3g} % duty, so the duty is inverted",
            REMEDY,
            blocks=True,
        )
    ]


def _rows(found: Sequence[Piece]) -> dict[int, tuple[Array, Array, Array]]:
    """Of each record with enough samples the duty (n,), columns (10, n) and the force (n,)."""
    every = 1 + sum(len(p) for p in found) // SAMPLES
    parts: dict[int, list[tuple[Array, Array, Array]]] = {}
    for p in found:
        use = ~p.near
        use[np.arange(len(p)) % every != 0] = False
        x, v, duty = p.x[use], p.xdot[use], p.of("duty")[use]
        up, t = v > 0.0, p.t[use] - p.t[0]
        either = np.array([up, ~up], dtype=np.float64)
        sign = either * np.where(up, 1.0, -1.0)
        columns = np.vstack([either * x, either * v, sign, sign * t, sign * duty])
        parts.setdefault(p.record, []).append((duty, columns, p.force[use]))
    joined = {
        r: (
            np.concatenate([d for d, _, _ in ps]),
            np.concatenate([c for _, c, _ in ps], axis=1),
            np.concatenate([f for _, _, f in ps]),
        )
        for r, ps in parts.items()
    }
    return {r: rows for r, rows in joined.items() if len(rows[0]) >= LEAST}


def _slopes(rows: Sequence[tuple[Array, Array, Array]]) -> Array:
    """(2,) change of the yield force with the duty, in compression and in release [N]."""
    columns = np.concatenate([c for _, c, _ in rows], axis=1)
    force = np.concatenate([f for _, _, f in rows])
    scale = np.sqrt(np.einsum("ij,ij->i", columns, columns))
    scale = np.where(scale > 0.0, scale, 1.0)
    unit = columns / scale[:, None]
    theta = np.linalg.pinv(unit @ unit.T, rcond=1e-9, hermitian=True) @ (unit @ force)
    return np.asarray((theta / scale)[-2:])

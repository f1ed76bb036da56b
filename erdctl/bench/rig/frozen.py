"""A channel that stands still while the other one moves."""

from __future__ import annotations

from collections.abc import Sequence
from math import log

import numpy as np

from erdctl.bench.rig.fault import RigFault, marked
from erdctl.bench.rig.pieces import Piece, runs_of_equals, spread, widened
from erdctl.core.quantiles import percentiles

LEAST = 12  # samples
UNLIKELY = log(1e-9)  # logarithm of the chance that as many equal samples follow one another
LONGER = 8.0  # times the runs of equal values that the channel has otherwise
MOVED = 0.05  # of the stroke, or of the force's range, that the other channel goes meanwhile


def check(found: Sequence[Piece], channel: str, clipped: Sequence[RigFault] = ()) -> list[RigFault]:
    """Stretches in which force, or x, does not change at all while the damper works.

    clipped : stays at a limit, which are reported already
    """
    known = marked(found[0].recording, clipped)
    out = []
    for p in found:
        values = p.of(channel)
        first, length = runs_of_equals(values)
        long = length >= LEAST
        if not long.any():
            continue
        order = np.sort(length)
        equal = float((length - 1).sum() - (length[long] - 1).sum()) / len(values)
        chance = np.log(max(equal, 1.0 / len(values)))
        usual = float(order[~(np.sort(length) >= LEAST)].max(initial=1))
        if len(order) > 10:
            usual = max(usual, percentiles(length.astype(np.float64), 90.0)[0])
        for a, n in zip(first[long].tolist(), length[long].tolist(), strict=True):
            if known[p.first + a] or n * chance > UNLIKELY or n < LONGER * usual:
                continue
            if not _works(p, channel, a, a + n):
                continue
            flags = np.zeros(len(p), dtype=np.bool_)
            flags[a : a + n] = True
            reach = 2 if channel == "force" else max(2, round(0.02 / p.step))
            out.append(
                RigFault(
                    f"{channel}_frozen",
                    p.record,
                    f"{channel} stands still from t = {p.t[a]:.6g} to {p.t[a + n - 1]:.6g} s"
                    f" ({n} samples) while the damper works",
                    "these samples are left out of fits; look at the cable and the recorder",
                    samples=np.flatnonzero(widened(flags, reach)) + p.first,
                )
            )
    return out


def _works(piece: Piece, channel: str, a: int, b: int) -> bool:
    """Whether the other channel shows that the damper moved, and the force had to change."""
    if channel == "force":
        # Over a reversal, or over a good part of the stroke, no damper's force is one number.
        x, v = piece.x[a:b], piece.xdot[a:b]
        return float(np.ptp(x)) > MOVED * piece.stroke and bool(
            ((v > 0).any() and (v < 0).any()) or np.ptp(x) > 0.2 * piece.stroke
        )
    if piece.recording.xdot_note == "measured":
        return piece.travelled(a, b) > MOVED * piece.stroke
    force = piece.recording.force
    if force is None or np.ptp(piece.of("duty")[a:b]) > 0:
        return False
    changed = spread(piece.force[a:b]) > 4.0 * MOVED * spread(piece.force)
    return changed and piece.goes_on(a, b)

"""Samples that the recorder lost: gaps of the time, and jumps of x where the time has none."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.gaps import GAP, gaps_of
from erdctl.bench.rig.fault import RigFault, marked
from erdctl.bench.rig.pieces import Piece, resolution, widened
from erdctl.core.messages import counted, duration
from erdctl.core.quantiles import median

SIGMAS = 10.0
STEPS = 0.7  # of what the piston moves in a step at its effective speed
RARE = 0.005


def gaps(found: Sequence[Piece]) -> list[RigFault]:
    """Records whose time has gaps."""
    out = []
    for p in found:
        steps = np.diff(p.t)
        at, lost = gaps_of(p.t, steps, p.step)
        if not len(at) or len(at) > 0.02 * len(p):
            continue
        longest = int(at[steps[at].argmax()])
        out.append(
            RigFault(
                "samples_missing",
                p.record,
                f"{counted(lost.sum(), 'sample')} missing in {counted(len(at), 'gap')} of the"
                " time, the longest of"
                f" {duration(steps[longest], 4)} at t = {p.t[longest]:.6g} s",
                "the time is right, so fits go on; record at a rate that the recorder can keep",
            )
        )
    return out


def jumps(found: Sequence[Piece], clipped: Sequence[RigFault] = ()) -> list[RigFault]:
    """Places where x jumps by more than the speed allows, and stays; not where it is clipped."""
    known = marked(found[0].recording, clipped)
    out = []
    for p in found:
        dt = np.diff(p.t)
        beyond = p.beyond
        scale = 1.4826 * median(np.abs(beyond))
        least = np.maximum(SIGMAS * scale, STEPS * np.maximum(p.speed * p.step, p.moved))
        far = np.abs(beyond) > np.maximum(least, SIGMAS * p.unresolved)
        far &= dt < GAP * p.step
        if not far.any():
            continue
        at = np.flatnonzero(far & (np.abs(beyond) > 3.0 * resolution(p.x)))
        at = at[~known[p.first + at]]
        # A spike goes back at once.
        at = at[[not _returns(beyond, int(i)) for i in at]] if len(at) <= RARE * len(p) else at[:0]
        if not len(at):
            continue
        flags = np.zeros(len(p), dtype=np.bool_)
        flags[at] = flags[at + 1] = True
        worst = int(at[np.abs(beyond[at]).argmax()])
        out.append(
            RigFault(
                "x_jumps",
                p.record,
                f"x jumps in {counted(len(at), 'place')}, by"
                f" {1e3 * beyond[worst]:+.3g} mm at t = {p.t[worst]:.6g} s, where it moves by"
                f" {1e3 * np.abs(p.xdot[worst]) * p.step:.3g} mm in a step: samples were lost and"
                " the time was written as if not, or two runs were joined",
                "the samples around are left out of fits; take the time from the recorder, and give"
                " joined runs a column 'record'",
                samples=np.flatnonzero(widened(flags, max(3, round(0.015 / p.step)))) + p.first,
            )
        )
    return out


def _returns(beyond: np.ndarray, i: int) -> bool:
    around = beyond[max(i - 4, 0) : i + 5]
    return float(np.abs(around.sum())) < 0.5 * float(np.abs(beyond[i]))

"""A channel that stops at a limit: many samples at exactly its highest or lowest value."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import Piece, resolution, runs_of_equals, widened

RUN = 3  # samples that a visit lasts
SAMPLES = 12  # at the limit, in all visits
VISITS = 2
# A channel that is only coarse has about as many samples in its three next steps as in the last:
# near its top a sine spends a time that grows with the root of the distance from it.
CROWDED = 4.0
STEPS, SIGMAS = 3.0, 4.0  # of the recorder, and of noise, that a rod moves beyond the limit of x
UNITS = {"force": (1.0, "N"), "x": (1e3, "mm")}


def check(found: Sequence[Piece], channel: str) -> list[RigFault]:
    """Samples of a channel at its limit, over all records alike: an amplifier has one range."""
    values = np.concatenate([p.of(channel) for p in found])
    if np.ptp(values) == 0.0:
        return []
    step = max(resolution(values), 1e-9 * float(np.ptp(values)))
    out = []
    for side, limit in ((1.0, float(values.max())), (-1.0, float(values.min()))):
        below = (limit - values) * side
        at = below <= 0.5 * step
        first, length = _visits(found, channel, limit, 0.5 * step)
        near = np.count_nonzero(below <= 3.5 * step) - np.count_nonzero(at)
        kept = length >= RUN
        first, length = first[kept], length[kept]
        total = int(length.sum())
        if total < SAMPLES or len(first) < VISITS or total < CROWDED * near:
            continue
        samples = np.concatenate([np.arange(a, a + n) for a, n in zip(first, length, strict=True)])
        factor, unit = UNITS[channel]
        name = "highest" if side > 0 else "lowest"
        t = found[0].recording.t
        out.append(
            RigFault(
                f"{channel}_clipped",
                None,
                f"{channel} is clipped: {total} samples in {len(first)} stretches are exactly at"
                f" its {name} value, {factor * limit:.5g} {unit}, first at t = {t[first[0]]:.6g} s"
                f" of record '{_record(found, int(first[0]))}'",
                "these samples are left out of fits; widen the range of the amplifier or recorder",
                samples=_with_next(found, samples),
            )
        )
    return out


def _visits(
    found: Sequence[Piece], channel: str, limit: float, within: float
) -> tuple[np.ndarray, np.ndarray]:
    """First sample of the recording and length of every stay at the limit while the rod moves."""
    firsts, lengths = [], []
    for p in found:
        at = np.abs(p.of(channel) - limit) <= within
        if not at.any():
            continue
        first, length = runs_of_equals(np.where(at, 1.0, np.arange(len(p)) + 2.0))
        last = first + length - 1
        # At rest a channel may well stay where it is.
        moved = np.abs(p.x[last] - p.x[first]) + np.abs(p.xdot[first]) * p.step
        kept = moved > 1e-6 * p.stroke
        if channel == "x":
            turns = [_turns(p, a, a + n, 2.0 * within) for a, n in zip(first, length, strict=True)]
            kept = np.array(turns, dtype=np.bool_)
        firsts.append(first[kept] + p.first)
        lengths.append(length[kept])
    if not firsts:
        return np.empty(0, dtype=np.intp), np.empty(0, dtype=np.intp)
    return np.concatenate(firsts), np.concatenate(lengths)


def _turns(p: Piece, a: int, b: int, step: float) -> bool:
    """Whether the rod went on and came back while x stayed at its limit: it may also have rested.

    step : of the recorder [m]
    """
    if b - a < RUN:
        return False
    if p.recording.xdot_note == "measured":
        walk = SIGMAS * p.noise("xdot")[0] * p.step * (b - a) ** 0.5
        # A rest may begin and end between two samples.
        change = np.abs(np.diff(p.xdot[a:b]))
        edges = 0.5 * p.step * float(change[0] + change[-1])
        return bool(p.travelled(a, b) > max(STEPS * step, walk + edges))
    if p.recording.force is None:
        return False  # nothing tells a limit from a rest that a drive asks for
    return p.goes_on(a, b)


def _with_next(found: Sequence[Piece], samples: np.ndarray) -> np.ndarray:
    """Samples and their neighbours, since an anti-alias filter rounds the corner."""
    out = []
    for p in found:
        inside = samples[(samples >= p.first) & (samples < p.end)] - p.first
        flags = np.zeros(len(p), dtype=np.bool_)
        flags[inside] = True
        out.append(np.flatnonzero(widened(flags, 2)) + p.first)
    return np.concatenate(out)


def _record(found: Sequence[Piece], sample: int) -> str:
    return next(p.name for p in found if p.first <= sample < p.end)

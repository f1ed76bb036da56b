"""Single samples that stand out of both their sides, and bursts of noise."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from erdctl.bench.rig.fault import RigFault, marked
from erdctl.bench.rig.motion_corners import beyond_corners
from erdctl.bench.rig.pieces import NEAR, Piece, largest_near, resolution, spread, widened
from erdctl.core.messages import counted
from erdctl.core.quantiles import median, medians, percentiles
from erdctl.core.recording import DERIVED, Array, Index, Recording

HALF = 8  # samples on either side that a spike is held against
WIDE = 2  # of those, the nearest, which it may take up itself
AROUND = np.array([k for k in range(-HALF, HALF + 1) if abs(k) > WIDE])
SIGMAS = 8.0
OVER = 3.0  # times what its surroundings vary by: noise with a memory has peaks, too
RANGE = 0.04  # of the channel's range
JUMPS = 3.0  # times what 98 % of a force span, beyond which no turn makes it jump there and back
RANGE_X = 0.004  # the same of x, of which smaller ones harm
COUNTS = 2.5  # steps of the recorder, of which one may flicker
IN_STEPS = 1.5  # of what x rises in its steepest step there; a derived velocity smears a motion
# Samples of all spikes, and the part of the stroke that most are within.
RECURRING, ONE_PLACE, MOSTLY = 20, 0.1, 0.95
RARE = 0.01  # of the samples, at most
APART = 2.5  # times the next smaller one that is left
UNITS = {"force": (1.0, "N"), "x": (1e3, "mm")}

WINDOW = 48  # samples over which a burst is looked for
LOUDER = 4.0  # times the noise of the record
WHITE = 1.2  # see `white_noise`
BURST_PART = 0.2  # of a record, at most
BURST_CLIPPED = 0.05  # of a record at a limit, from which it is not looked at
BURST_WINDOWS = 3  # on end; a knock of the damper itself dies away before
FEWEST = 8  # windows of a record, and each way
ONE_WAY = 0.9  # of a window, from which it belongs to strokes of that direction
MOSTLY_CHATTER = 90.0  # per cent of the windows of that direction
NOISIER = 2.0  # times the noise of the other way, usually, from which a damper chatters one way
BURSTS_RECURRING = 2  # at one place of the motion, from which they are its own
PER_STROKE = 0.4  # bursts for each reversal, from which they belong to the motion


def check(found: Sequence[Piece], channel: str, clipped: Sequence[RigFault] = ()) -> list[RigFault]:
    """Spikes of force or x, record by record; not where the channel is clipped.

    Spikes of the force that come back at one place of the motion are a bore's or a joint's, and no
    cable's.
    """
    out = _spikes(found, channel, clipped)
    if channel != "force" or not out:
        return out
    at = np.concatenate([f.samples for f in out if f.samples is not None])
    return [] if _one_place(found[0].recording, at) else out


def _one_place(recording: Recording, at: Index) -> bool:
    """Whether what happened at some samples (k,) happened at one deflection, mostly one way.

    Either way, it may be as wide as ONE_PLACE of the stroke, and one way twice as wide.
    """
    if len(at) < RECURRING:
        return False
    low, high = percentiles(recording.x[at], 10.0, 90.0)
    up = float(np.mean(recording.xdot[at] > 0))
    one_way = max(up, 1.0 - up) > MOSTLY
    return high - low < (2.0 if one_way else 1.0) * ONE_PLACE * spread(recording.x)


def _spikes(found: Sequence[Piece], channel: str, clipped: Sequence[RigFault]) -> list[RigFault]:
    known = marked(found[0].recording, clipped)
    out = []
    for p in found:
        values = p.of(channel)
        width = spread(values)
        if width == 0.0:
            continue
        if channel == "x":
            # Without the motion, which may be as short as a spike.
            values = np.concatenate([[0.0], np.cumsum(p.beyond)])
        at, height = _standing_out(values, smooth=channel == "x")
        at, height = at[(free := ~known[p.first + at])], height[free]
        if not len(at):
            continue
        noise = p.noise(channel)[0]
        if channel == "x" and p.recording.xdot_note.startswith(DERIVED):
            variance = noise**2 + resolution(p.x) ** 2 / 12.0
            height = np.minimum(height, beyond_corners(p.t, p.x, at, AROUND, variance))
        if channel == "force":
            # Where the piston turns, or touches rest, a sound force jumps there and back, but by no
            # more than it spans.
            low, high = percentiles(values, 1.0, 99.0)
            away = ~(p.turning(WIDE + 1) | p.stepped(2 * NEAR))[at]
            away |= height > JUMPS * (high - low)
            at, height = at[away], height[away]
        lowest = (RANGE if channel == "force" else RANGE_X) * width
        least = np.full(len(at), max(lowest, COUNTS * resolution(p.of(channel))))
        if channel == "x":
            least = np.maximum(least, SIGMAS * p.unresolved[at])
            # What a trapezoid lacks of a speed that changes within a step or two, as of triangles.
            change = largest_near(p.xdot, WIDE) + largest_near(-p.xdot, WIDE)
            least = np.maximum(least, p.step * change[at] / 8.0)
            in_a_step = largest_near(np.abs(p.beyond), WIDE)[at]
            least = np.where(height > IN_STEPS * in_a_step, np.inf, least)
        apart = _apart(height, round(RARE * len(p)))
        kept = (height > SIGMAS * noise) & (height > least) & (height >= apart)
        at, height = at[kept], height[kept]
        if not len(at):
            continue
        flags = np.zeros(len(p), dtype=np.bool_)
        flags[at] = True
        reach = WIDE if channel == "force" else max(WIDE, round(0.015 / p.step))
        factor, unit = UNITS[channel]
        worst = int(height.argmax())
        count = 1 + int(np.count_nonzero(np.diff(at) > WIDE))
        spikes = counted(count, "spike")
        out.append(
            RigFault(
                f"{channel}_spikes",
                p.record,
                f"{spikes} of {channel}, the largest of {factor * height[worst]:.4g} {unit} at"
                f" t = {p.t[at[worst]]:.6g} s",
                "these samples are left out of fits; look at the cable, its shield and its plugs",
                samples=np.flatnonzero(widened(flags, reach)) + p.first,
            )
        )
    return out


class _Noise(NamedTuple):
    """Windows (k,) of a piece: medians of the third and second differences of its force [N], and
    the part of each in which the rod goes up [1].
    """

    of: Piece
    third: Array
    second: Array
    up: Array

    @classmethod
    def along(cls, p: Piece) -> _Noise:
        """Those of a piece."""
        cut = (len(p) // WINDOW - 1) * WINDOW
        d2 = np.diff(p.force, 2)
        third, second = (
            medians(np.abs(d[:cut]).reshape(-1, WINDOW)) for d in (np.diff(d2), d2)
        )  # fmt: skip
        return cls(p, third, second, (p.xdot[:cut] > 0.0).reshape(-1, WINDOW).mean(axis=1))


def _chatter(found: Sequence[_Noise]) -> tuple[bool, float]:
    """Whether a damper chatters as it slides up, or down, and how loud mostly, over the noise of
    its record; 1 where neither way is noisier, as what a rig picks up knows nothing of that.
    """
    own = [(w.up, w.third / median(w.third)) for w in found if median(w.third) > 0.0]
    if not own:
        return True, 1.0
    up, third = (np.concatenate(values) for values in zip(*own, strict=True))
    rising, falling = third[up > ONE_WAY], third[up < 1.0 - ONE_WAY]
    if min(len(rising), len(falling)) < FEWEST:
        return True, 1.0
    usual = median(rising), median(falling)
    if max(usual) <= NOISIER * min(usual):
        return True, 1.0
    is_up = usual[0] > usual[1]
    return is_up, float(percentiles(rising if is_up else falling, MOSTLY_CHATTER)[0])


def bursts(found: Sequence[Piece], clipped: Sequence[RigFault] = ()) -> list[RigFault]:
    """Stretches in which the force is several times noisier than its record, now and then.

    Not those that a damper makes at one place; where it chatters as it slides one way, they are
    louder than that.
    """
    known = marked(found[0].recording, clipped)
    # At a limit there is no noise that others could be held against.
    windows = [
        _Noise.along(p) for p in found
        if len(p) // WINDOW >= FEWEST and known[p.first : p.end].mean() <= BURST_CLIPPED
    ]  # fmt: skip
    is_up, chatter = _chatter(windows)
    out = []
    for p, third, second, up in windows:
        usual = median(third)
        sliding = (up if is_up else 1.0 - up) > 1.0 - ONE_WAY
        least = LOUDER * max(usual, 1e-300) * np.where(sliding, max(chatter, 1.0), 1.0)
        loud = (third > least) & (third > WHITE * second) & (usual > 0)
        if not loud.any() or loud.mean() > BURST_PART:
            continue
        edge = np.diff(loud.astype(np.int8), prepend=0, append=0)
        first, end = np.flatnonzero(edge == 1), np.flatnonzero(edge == -1)
        first, end = first[(stays := end - first >= BURST_WINDOWS)], end[stays]
        if not len(first):
            continue
        turns = np.count_nonzero(np.diff(p.xdot > 0))
        if len(first) > max(3.0, PER_STROKE * turns):
            continue
        inside = np.concatenate([
            np.arange(a * WINDOW, b * WINDOW) for a, b in zip(first, end, strict=True)
        ])  # fmt: skip
        if len(first) > BURSTS_RECURRING and _one_place(p.recording, p.first + inside):
            continue
        flags = np.zeros(len(p), dtype=np.bool_)
        for a, b in zip(first.tolist(), end.tolist(), strict=True):
            flags[max(a - 1, 0) * WINDOW : (b + 1) * WINDOW] = True
        a = int(first[(end - first).argmax()]) * WINDOW
        b = min(int(end[(end - first).argmax()]) * WINDOW, len(p) - 1)
        out.append(
            RigFault(
                "force_burst",
                p.record,
                f"{counted(len(first), 'burst')} of noise in the force, up to"
                f" {float(third[loud].max()) / usual:.2g} times the record's, the longest from"
                f" t = {p.t[a]:.6g} to {p.t[b]:.6g} s",
                "these samples are left out of fits; look for what was switched on then",
                samples=np.flatnonzero(flags) + p.first,
            )
        )
    return out


def _apart(height: Array, most: int) -> float:
    """Height from which some stand apart from all others, at most so many of them.

    A damper's own chatter has all sizes up to its largest; what comes from a cable has not.
    """
    ordered = np.sort(np.append(height, 0.0))[::-1]
    ordered = ordered[: most + 2]
    smaller = np.maximum(ordered[1:], 1e-300)
    gap = np.flatnonzero(ordered[:-1] > APART * smaller)
    return float(ordered[gap[-1]]) if len(gap) else np.inf


def _standing_out(values: Array, *, smooth: bool) -> tuple[Index, Array]:
    """Samples (k,) of (n,) beyond everything on either side of them, and (k,) by how much.

    A step or an edge lies between its two sides; only what returns stands out.
    smooth : held against the straight line through its surroundings, which a motion follows
    """
    n = len(values)
    if n < 2 * HALF + 1:
        return np.empty(0, dtype=np.intp), np.empty(0)
    d2 = np.abs(np.diff(values, 2))
    scale = median(d2)
    centre = np.flatnonzero(d2 > 5.0 * scale) + 1
    centre = centre[(centre >= HALF) & (centre < n - HALF)]
    around, own = values[centre[:, None] + AROUND], values[centre]
    if smooth and len(centre):
        half = len(AROUND) // 2
        left, right = medians(around[:, :half]), medians(around[:, half:])
        middle = median(AROUND[half:])
        around = around - np.outer((right - left) / (2.0 * middle), AROUND)
    # But for the highest and the lowest, which may be the next spike.
    around = np.partition(around, (1, around.shape[1] - 2), axis=1)
    low, high = around[:, 1], around[:, -2]
    height = np.maximum(own - high, low - own)
    kept = height > OVER * (high - low)
    return centre[kept], height[kept]

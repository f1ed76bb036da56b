"""The curves that shock dynos show: peak force, averaged force, gas force and seal drag."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.ndimage import uniform_filter1d

from erdctl.bench.excitation import null_control
from erdctl.bench.strokes import steady, stretches, strokes
from erdctl.core.blocks import SETTLE
from erdctl.core.cache import parts
from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.score.nrmse import Codes, duty_levels

NEAR_PEAK = 0.97  # of a stroke's highest speed: the samples that make its force at the peak
SPEEDS = 41  # bins of velocity
STROKES = 30  # bins of deflection
FEWEST = 5  # samples that make a mean
TRAVEL = 0.1  # of the stroke: what is passed slowly in one go, at least
SMOOTHED = 0.1  # s over which a noisy speed is averaged
SLOW = 5e-3  # m/s, up to which a damper without field counts as hardly damping


@dataclass(frozen=True, eq=False)
class PeakForces:
    """Force at the highest speed of each stroke.

    velocity, force : (k,) [m/s], [N], with sign;  code : (k,) its PWM level;  levels : (l,) [1]
    steady : (k,) part of a motion that repeats, as a dyno's does
    """

    velocity: Array
    force: Array
    code: Codes
    levels: Array
    steady: npt.NDArray[np.bool_]

    def line(self, level: int, width: float = 0.05) -> tuple[Array, Array]:
        """Mean velocity and force of the steady strokes of one level in bins of velocity.

        width : of a bin, as part of the highest speed of all strokes
        Where no stroke of the level is steady, of all its strokes.
        """
        at = self.code == level
        at = at & self.steady if (at & self.steady).any() else at
        v, force = self.velocity[at], self.force[at]
        if not len(v):
            return v, force
        bin_ = np.rint(v / (width * np.abs(self.velocity).max())).astype(np.intp)
        _, which, count = np.unique(bin_, return_inverse=True, return_counts=True)
        return np.bincount(which, v) / count, np.bincount(which, force) / count


def peak_force(recording: Recording, force: Array) -> PeakForces:
    """Force at the peak velocity of every complete stroke under a duty that has settled.

    force : (n,) [N];  the mean over the samples within 3 % of the stroke's highest speed, which
    noise does not raise, as it does a maximum
    Check: F = 100 xdot on a sine of 0.1 m/s gives +-9.9 N at +-0.1 m/s: the phases at which
    cos > 0.97 reach 0.2456 each way, and the mean of cos over them is sin(0.2456) / 0.2456 = 0.990.
    >>> xdot = 0.1 * np.cos(2.0 * np.pi * np.arange(0.0, 1.5, 1e-3))
    >>> found = peak_force(recording(xdot, step=1e-3), 100.0 * xdot)
    >>> found.velocity.round(3).tolist(), found.force.round(1).tolist()
    ([-0.1, 0.1], [-9.9, 9.9])
    """
    found = strokes(recording)
    since = Signals.of(recording).since_duty_step
    held = found.highest(recording.duty) == found.lowest(recording.duty)
    held &= since[found.first] > SETTLE
    codes, levels = duty_levels(recording.duty)
    peak = np.where(found.compression, found.highest(recording.xdot), -found.lowest(recording.xdot))
    length = found.end - found.first
    which = np.repeat(np.arange(len(found)), length)
    rows = np.arange(length.sum()) - np.repeat(np.cumsum(length) - length, length)
    rows += found.first[which]
    near = np.abs(recording.xdot[rows]) >= NEAR_PEAK * peak[which]
    count = np.bincount(which[near], minlength=len(found))
    mean = np.bincount(which[near], force[rows[near]], minlength=len(found)) / np.maximum(count, 1)
    velocity = np.where(found.compression, peak, -peak)
    code = codes[found.first[held]]
    return PeakForces(velocity[held], mean[held], code, levels, steady(recording, found)[held])


@dataclass(frozen=True, eq=False)
class Averaged:
    """Force averaged over the samples of one velocity, per PWM level.

    velocity : (b,) middle of the bins [m/s];  levels : (l,) [1]
    force, spread : (l, b) mean and standard deviation [N], NaN where there are too few samples
    """

    velocity: Array
    levels: Array
    force: Array
    spread: Array


def averaged(recording: Recording, force: Array, bins: int = SPEEDS) -> Averaged:
    """The averaged force-velocity curve: opening and closing branch of the loops as one.

    Over the samples whose duty has settled; of a level that never does, over all.

    force : (n,) [N]
    Check: F = 100 xdot gives 100 times the middle of each bin where samples fill it evenly: +-2.5
    and +-7.5 N in four bins up to +-0.1 m/s.
    >>> xdot = np.linspace(-0.1, 0.1, 4001)
    >>> averaged(recording(xdot), 100.0 * xdot, bins=4).force.round(2).tolist()
    [[-7.5, -2.5, 2.5, 7.5]]
    """
    codes, levels = duty_levels(recording.duty)
    use = Signals.of(recording).since_duty_step > SETTLE
    never = np.bincount(codes[use], minlength=len(levels)) == 0
    use |= never[codes]
    top = float(np.abs(recording.xdot).max())
    edges = np.linspace(-top, top, bins + 1)
    sums = np.zeros((3, len(levels) * bins))
    scale = bins * (1.0 - 1e-9) / (2.0 * top) if top > 0.0 else 0.0
    for part in parts(len(recording)):
        at = ((recording.xdot[part] + top) * scale).astype(np.intp)
        at += codes[part].astype(np.intp) * bins
        weight = use[part].astype(np.float64)
        for row, power in zip(sums, (weight, weight * force[part], weight * force[part] ** 2),
                              strict=True):  # fmt: skip
            row += np.bincount(at, power, len(row))
    count, total, square = sums.reshape(3, len(levels), bins)
    n = np.where(count >= FEWEST, count, np.nan)
    mean = total / n
    spread = np.sqrt(np.maximum(square / n - mean**2, 0.0))
    return Averaged(0.5 * (edges[1:] + edges[:-1]), levels, mean, spread)


@dataclass(frozen=True, eq=False)
class SlowTest:
    """What is left when nothing flows: (b,) by deflection.

    x : middle of the bins [m];  compression, release : mean force either way [N]
    gas : half their sum;  drag : half their difference [N]
    speed : highest that counted as slow [m/s];  samples : how many did
    """

    x: Array
    compression: Array
    release: Array
    speed: float
    samples: int

    @property
    def gas(self) -> Array:
        """(b,) gas force [N]: what does not depend on the way the piston moves."""
        return 0.5 * (self.compression + self.release)

    @property
    def drag(self) -> Array:
        """(b,) seal drag [N]: what changes sign with the way the piston moves."""
        return 0.5 * (self.compression - self.release)


def slow_test(
    recording: Recording, force: Array, speed: float = SLOW, bins: int = STROKES
) -> SlowTest:
    """Gas force and seal drag from strokes without field that hardly move.

    The reversals of a fast motion are no slow strokes, though the speed passes through zero there:
    fluid and friction are not at rest then.

    force : (n,) [N];  speed : [m/s] up to which samples count; c_vis times it stays in the drag
    Raises InputProblem if no deflection was passed slowly both ways.
    Check: F = 200 x + 3 sign(xdot) at 1 mm/s gives gas 200 x and drag 3 N; over -10 to 10 mm in two
    bins +-1 N of gas.
    >>> from erdctl.bench.drive import drives
    >>> r = drives(["triangle:speed=0.001,amp=0.01,duration=40"])
    >>> found = slow_test(r, 200.0 * r.x + 3.0 * np.sign(r.xdot), bins=2)
    >>> found.gas.round(2).tolist(), found.drag.round(2).tolist()
    ([-1.0, 1.0], [3.0, 3.0])
    """
    v = recording.xdot
    still = null_control(Signals.of(recording))
    slow = _slowly(recording, speed, still)
    at = np.flatnonzero((np.abs(v) <= speed) & (v != 0.0) & slow)
    if len(at):
        x = recording.x[at]
        edges = np.linspace(x.min(), x.max(), bins + 1)
        bin_ = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, bins - 1)
        ways = []
        for way in (v[at] > 0, v[at] < 0):
            count = np.bincount(bin_[way], minlength=bins)
            n = np.where(count >= FEWEST, count, np.nan)
            ways.append(np.bincount(bin_[way], force[at][way], bins) / n)
        both = np.isfinite(ways[0] + ways[1])
        if np.count_nonzero(both) >= 2:
            middle = 0.5 * (edges[1:] + edges[:-1])
            return SlowTest(middle[both], ways[0][both], ways[1][both], speed, len(at))
    raise InputProblem(
        "no slow strokes: no deflection is passed both ways without field and at no more than"
        f" {speed * 1e3:g} mm/s, for {100 * TRAVEL:g} % of the stroke at a time (reversals of a"
        " fast motion are none);"
        " record a slow test, e.g. --drive triangle:speed=0.002,amp=0.01,duration=20"
    )


def _slowly(
    recording: Recording, speed: float, still: npt.NDArray[np.bool_]
) -> npt.NDArray[np.bool_]:
    """(n,) where the piston goes on slowly for a good part of the stroke, without field."""
    slow = np.zeros(len(recording), dtype=bool)
    if not still.any():
        return slow
    steps = recording.step[recording.step > 0.0]
    window = 1 if not len(steps) else int(SMOOTHED / float(np.median(steps))) | 1
    # Of the size of the speed, so that what swings to and fro does not look slow.
    mean = uniform_filter1d(np.abs(recording.xdot), window, mode="nearest")
    least = TRAVEL * float(np.ptp(recording.x[still]))
    for a, b in zip(*stretches((mean <= speed) & still, recording.starts), strict=True):
        slow[a:b] = np.ptp(recording.x[a:b]) >= least
    return slow

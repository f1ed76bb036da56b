"""The test that would tell look-alikes apart: the drive on which their predictions differ most."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from erdctl.bench.drive import drives
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.model.divergence import diverged


@dataclass(frozen=True)
class DiscriminatingDrive:
    """A drive, as `simulate --drive` takes it, and by how much two hypotheses differ on it.

    difference : root mean square [N];  against : the effect that it tells the finding from
    """

    drive: str
    difference: float
    against: str

    def advice(self, what: str) -> str:
        """What to record, in words; what : is to be told from what."""
        return (
            f"; to tell {what}, record --drive {self.drive}, where they differ by"
            f" {self.difference:.3g} N rms"
        )


def discriminating_drive(
    problem: Problem, best: Hypothesis, look_alikes: Sequence[tuple[str, Hypothesis]]
) -> DiscriminatingDrive | None:
    """The drive within the recorded stroke and speed that tells a hypothesis from a look-alike.

    None without a look-alike, and where one of both diverges on every drive, or they differ on none
    by more than a simulation rounds.
    """
    if not look_alikes:
        return None
    name, look_alike = look_alikes[0]
    rounding = thresholds.ROUNDING * float(np.ptp(problem.block.force))
    found = []
    for spec in _specs(problem):
        drive = drives([spec])
        signals = Signals.of(drive)
        a, b = (t.model.force(signals, t.values) for t in (best, look_alike))
        pair = ((a, best), (b, look_alike))
        if any(diverged(force, t.model, t.values, drive) for force, t in pair):
            continue  # such a drive would be no advice
        settled = signals.t > thresholds.DRIVE_SETTLES * thresholds.DRIVE_SECONDS
        found.append((float(np.sqrt(np.mean((a - b)[settled] ** 2))), spec))
    difference, spec = max(found, default=(0.0, ""))
    if difference <= rounding:
        return None
    return DiscriminatingDrive(spec, difference, name)


def _specs(problem: Problem) -> list[str]:
    r = problem.recording
    stroke, speed = float(np.ptp(r.x)) / 2, float(np.abs(r.xdot).max())
    top = float(r.duty.max())
    duties = (
        ["0"] if top == 0 else ["0", f"{top / 2:.2g}", f"{top:.2g}", f"{top / 2:.2g}|{top:.2g}"]
    )
    out = []
    for frequency in thresholds.DRIVE_FREQUENCIES:
        amplitude = min(stroke, speed / (2 * pi * frequency))
        for part in thresholds.DRIVE_STROKES:
            for duty in duties:
                out.append(
                    f"sine:freq={frequency:g},amp={part * amplitude:.3g},duty={duty},"
                    f"duration={thresholds.DRIVE_SECONDS:g},fs={thresholds.DRIVE_RATE:g}"
                )
    return out

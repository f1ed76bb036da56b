"""Records that somebody smoothed, each over the same part of its cycle, before they were logged.

The damper and the smoothing are the few lines below and share no code with erdctl's model: the
equations of the paper at 20 kHz, averaged by a convolution, motion and force alike.
"""

from __future__ import annotations

import numpy as np
import pytest
from rig import noisy

from erdctl.core.recording import Array, Recording, concatenate
from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.effects import catalogue
from erdctl.score.nrmse import nrmse

FINE, EVERY = 20_000, 40  # Hz of the force; one sample in so many is logged
K, C, S, BETA, F_C = 200.0, 70.0, 22.0, 0.6, 2.5  # N/m, N s/m, N, 1, N
PART = 0.13  # of a cycle
NOISE = 0.2  # N


def averaged(y: Array, samples: int) -> Array:
    return np.convolve(y, np.ones(samples) / samples, mode="same")


def recording(frequency: float, amplitude: float, duty: float) -> Recording:
    """Six cycles of a sine, whose ends the average has not reached."""
    n = round(8 / frequency * FINE)
    w, t = 2 * np.pi * frequency, np.arange(n) / FINE
    x, xdot = amplitude * np.sin(w * t + 1.0), amplitude * w * np.cos(w * t + 1.0)
    force = K * x + C * xdot + (S * duty**BETA + F_C) * np.sign(xdot)
    window = round(PART * FINE / frequency)
    rows = slice(n // 8, n - n // 8, EVERY)
    x, xdot, force = (averaged(y, window)[rows] for y in (x, xdot, force))
    return Recording(
        t=t[rows] - t[rows][0], x=x, xdot=xdot, duty=np.full(len(x), duty), force=force,
        starts=np.array([0, len(x)], dtype=np.intp), names=(f"{frequency} Hz, {duty}",),
    )  # fmt: skip


@pytest.mark.long
def test_the_smoothing_is_found_beside_a_damper() -> None:
    log = concatenate(
        [recording(f, a, duty) for f, a in ((0.5, 0.02), (1.2, 0.012), (3.0, 0.006))
         for duty in (0.0, 0.2, 0.5)]
    )  # fmt: skip
    found = diagnose(noisy(log, seed=7, rms=NOISE), catalogue(), limits=False)
    for f in found.findings:
        print(f.effect.name, f.equivalent, f.gain, f.before, f.after)
    assert found.verdict is Verdict.EXPLAINED
    assert found.findings[0].effect.name == "force_smoothing"
    assert {f.effect.name for f in found.findings} <= {"force_smoothing", "coulomb_friction"}
    best = found.selection.best
    assert best.values["force_smoothing.w"] == pytest.approx(PART, rel=0.02)

    fresh = recording(2.0, 0.005, 0.35)
    assert fresh.force is not None
    before, after = (
        nrmse(fresh.force, t.model.force(Signals.of(fresh), t.values)).nrmse
        for t in (found.selection.base, best)
    )
    print(before, after)
    assert before > 0.07
    assert after < 0.01

"""A force channel behind a low-pass filter."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from by_hand import signals
from rig import campaign, every, noisy
from scipy.signal import lfilter

from erdctl.core.recording import Array, Recording
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.effects import get
from erdctl.effects.force_lowpass import force_lowpass

FINE, EVERY = 2000.0, 20  # samples of the force before the filter [Hz], and one kept of so many
RIVALS = (
    "coulomb_friction", "force_lowpass", "power_law_yield", "preyield_viscosity",
    "signed_yield_lag", "stribeck_friction", "time_skew",
)  # fmt: skip


def filtered(*poles: float) -> Recording:
    """A campaign at 100 Hz whose force passed filters of the first order before it was sampled."""
    fine = campaign(FINE, 8.0)
    force = fine.force.copy() if fine.force is not None else np.zeros(0)
    for pole in poles:
        kept = np.exp(-1.0 / (FINE * pole))
        for part in fine.slices:
            force[part] = lfilter(
                [1.0 - kept], [1.0, -kept], force[part], zi=[kept * force[part][0]]
            )[0]
    return every(replace(fine, force=force), EVERY)


def named(*poles: float) -> Diagnosis:
    seen = noisy(filtered(*poles), 5, rms=0.2)
    return diagnose(seen, [get(n) for n in RIVALS], limits=False, learning=False)


def step_by_step(column: Array, xdot: Array, tau: float, step: float, fine: int) -> Array:
    """The same by small steps of an implicit midpoint rule, with the jump where xdot passes 0."""
    out = [column[0]]
    for (f0, f1), (v0, v1) in zip(pairwise(column), pairwise(xdot), strict=True):
        y, h = out[-1], step / fine
        for k in range(fine):
            part = (k + 0.5) / fine
            turned = v0 + part * (v1 - v0) > 0.0
            F = f0 + part * (f1 - f0) if v0 * v1 > 0.0 else (f1 if turned == (v1 > 0.0) else f0)
            y += h / tau * (F - y) / (1.0 + 0.5 * h / tau)
        out.append(y)
    return np.array(out)


@pytest.mark.parametrize("tau", [0.002, 0.02, 0.3])
def test_against_small_steps(tau: float) -> None:
    t = np.arange(60) * 0.01
    v = np.cos(2 * np.pi * 2.3 * t)
    column = 3.0 * np.sign(v) + np.sin(2 * np.pi * 2.3 * t)
    found = force_lowpass(column, signals(v, step=0.01), {"tau": tau})
    assert found == pytest.approx(step_by_step(column, v, tau, 0.01, 400), abs=0.03)


def test_of_no_time_it_is_none_and_records_begin_anew() -> None:
    s = signals(np.ones(6), starts=[0, 3, 6])
    column = np.array([1.0, 1.0, 1.0, 5.0, 5.0, 5.0])
    assert force_lowpass(column, s, {"tau": 0.0}) is column
    assert force_lowpass(column, s, {"tau": 1e-5}) == pytest.approx(column)
    assert force_lowpass(column, s, {"tau": 0.4}) == pytest.approx(column)


@pytest.mark.parametrize("tau", [0.006, pytest.param(0.02, marks=pytest.mark.long)])
def test_it_has_a_name(tau: float) -> None:
    """Behind 15 ms a lag of the signed yield force, a delay, a power of the speed and a Stribeck
    friction were named, behind 5 ms two laws of the fluid learned; none of it is there."""
    found = named(tau)
    (finding,) = found.findings
    assert finding.effect.name == "force_lowpass"
    assert finding.equivalent == ()
    assert found.verdict.value == "explained"
    assert found.fit.values["force_lowpass.tau"] == pytest.approx(tau, rel=0.03)


@pytest.mark.long
def test_a_second_pole_is_a_delay_beside_it() -> None:
    """As of an amplifier and a filter against aliasing: what a pole well above does."""
    found = named(0.015, 0.003)
    names = {f.effect.name for f in found.findings}
    assert "force_lowpass" in names
    assert names <= {"force_lowpass", "time_skew"}
    delay = found.fit.values["force_lowpass.tau"] + found.fit.values.get("time_skew.tau", 0.0)
    assert delay == pytest.approx(0.018, rel=0.05)

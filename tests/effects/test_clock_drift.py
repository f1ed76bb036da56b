"""Force and motion on two clocks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, every, noisy

from erdctl.core.recording import Recording, running_time
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.effects import get

RIVALS = (
    "clock_drift", "coulomb_friction", "force_lowpass", "preyield_viscosity", "signed_yield_lag",
    "time_skew",
)  # fmt: skip


def recorded(rate: float, late: float = 0.0, *, runs_on: bool = False) -> Recording:
    """A campaign at 100 Hz whose force was sampled when another clock said so."""
    fine = campaign(2000.0, 8.0)
    assert fine.force is not None
    t = running_time(fine.t, fine.starts) if runs_on else fine.t
    force = fine.force.copy()
    for part in fine.slices:
        force[part] = np.interp(t[part] - late - rate * t[part], t[part], fine.force[part])
    return noisy(every(replace(fine, t=t, force=force), 20), 5, rms=0.2)


def named(r: Recording) -> tuple[Diagnosis, set[str]]:
    found = diagnose(r, [get(n) for n in RIVALS], limits=False, learning=False)
    return found, {f.effect.name for f in found.findings}


@pytest.mark.parametrize("rate", [2e-3, pytest.param(-5e-3, marks=pytest.mark.long)])
def test_a_clock_that_gains_or_loses_has_a_name(rate: float) -> None:
    """Two laws of the fluid over the time in the record were learned where it was 2e-3."""
    found, names = named(recorded(rate))
    assert names == {"clock_drift"}
    assert found.fit.values["clock_drift.r"] == pytest.approx(rate, abs=2e-4)
    assert found.fit.values["clock_drift.tau"] == pytest.approx(0.0, abs=1e-3)


def test_over_records_whose_time_goes_on() -> None:
    r = recorded(3e-4, runs_on=True)
    problem = prepare(r)
    base, drift = (
        fit_hypothesis(problem, [get(n) for n in of], [start])
        for of, start in (((), {}), (("clock_drift",), {"clock_drift.r": 4e-4}))
    )
    assert drift.values["clock_drift.r"] == pytest.approx(3e-4, abs=3e-5)
    assert drift.rms < 0.9 * base.rms


@pytest.mark.long
def test_a_delay_that_stays_is_none() -> None:
    found, names = named(recorded(0.0, 0.012))
    assert names == {"time_skew"}
    assert found.fit.values["time_skew.tau"] == pytest.approx(0.012, abs=1e-3)

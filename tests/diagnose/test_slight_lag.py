"""The lag of Eq. 12 in logs without steps of the duty."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trajectories
from rig import noisy, recording

from erdctl.core.recording import Recording, concatenate
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.slight_lag import freed
from erdctl.effects import get

LAGS = {"compression.T_d", "release.T_d"}


def steady() -> Recording:
    """Table 2, whose yield forces differ with the direction, at two steady duties."""
    t = np.arange(1500) / 200.0
    out = []
    for frequency, amplitude in ((0.8, 0.015), (2.1, 0.008)):
        tones = trajectories.sine(frequency, amplitude, 0.3)
        for duty in (0.2, 0.45):
            held, name = np.full(len(t), duty), f"{frequency}-{duty}"
            out.append(recording(t, tones.x(t), tones.velocity(t), held, name, tones.velocity_at))
    return concatenate(out)


@pytest.mark.long
def test_held_at_0_it_would_be_named_otherwise() -> None:
    log = noisy(steady(), seed=3, rms=0.1)
    problem = prepare(log)
    assert problem.held.keys() >= LAGS
    assert not LAGS & freed(problem).held.keys()
    names = ("position_dependent_damping", "signed_yield_lag", "coulomb_friction")
    found = diagnose(log, [get(n) for n in names], limits=False)
    assert found.findings == ()
    assert found.verdict is Verdict.ADEQUATE


def test_it_takes_the_place_of_nothing_else() -> None:
    """Where the rest is more than noise the lag would run to whatever that asks for."""
    log = noisy(steady(), seed=3, rms=0.1)
    assert log.force is not None
    problem = prepare(replace(log, force=log.force + 3e4 * log.x * np.abs(log.x)))
    assert freed(problem).held.keys() >= LAGS


@pytest.mark.long
def test_beside_an_effect_it_is_no_second_one() -> None:
    """Held at 0, the lag had the name of a second effect wherever a first one was hidden."""
    log = noisy(steady(), seed=3, rms=0.1)
    assert log.force is not None
    log = replace(log, force=log.force + 60.0 * log.xdot * np.abs(log.xdot))
    names = ("position_dependent_damping", "signed_yield_lag", "quadratic_damping", "cavitation")
    found = diagnose(log, [get(n) for n in names], limits=False)
    assert [f.effect.name for f in found.findings] == ["quadratic_damping"]
    assert found.verdict is Verdict.EXPLAINED
    T_c, T_r = (found.fit.values[n] for n in sorted(LAGS))
    c_2 = found.fit.values["quadratic_damping.c_2"]
    assert abs(c_2 - 60.0) < 5.0
    assert 0.02 < T_c < 0.06
    assert 0.02 < T_r < 0.06

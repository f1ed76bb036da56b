"""A yield force that follows the duty within a sample, or at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.recording import Array, Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.slight_lag import freed
from erdctl.effects import get

LAGS = ("compression.T_d", "release.T_d")
FORCES = ("force_smoothing", "input_delay", "signed_yield_lag", "supply_slew", "coulomb_friction")


def without_lag(late: int) -> Recording:
    """A campaign with steps of the duty, that the force follows so many samples late."""
    log = campaign()
    duty = log.duty.copy()
    for part in log.slices:
        first = duty[part][:late].copy()
        duty[part] = np.concatenate((first, duty[part][: len(duty[part]) - late]))
    force: Array = 400.0 * log.x + 60.0 * log.xdot + 14.0 * np.sqrt(duty) * np.sign(log.xdot)
    force += 1.5 * np.sign(log.xdot)
    return noisy(replace(log, force=force), seed=5, rms=0.2)


@pytest.mark.few(1)
@pytest.mark.parametrize("late", [0, 1])
def test_is_no_effect(late: int) -> None:
    """The limit of a short lag is late by a sample; no lag at all is a model of its own."""
    log = without_lag(late)
    assert not set(LAGS) & freed(prepare(log)).held.keys()
    found = diagnose(log, [get(n) for n in FORCES], limits=False)
    assert [f.effect.name for f in found.findings] == ["coulomb_friction"]
    lags = [found.fit.values[n] for n in LAGS]
    assert all(lag == 0.0 for lag in lags) if late == 0 else all(0.0 < lag < 2e-3 for lag in lags)
    assert abs(found.fit.rms - 0.2) < 0.01

"""What remembers the duty for seconds is no noise, however many levels the duty has."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign
from scipy.signal import lfilter

from erdctl.diagnose.problem import prepare
from erdctl.diagnose.residual.predictability import lack_of_fit_test

RATE, TAU = 200.0, 1.3  # Hz, s


@pytest.mark.parametrize("remembers", [True, False])
def test_a_memory_of_seconds_is_predicted(remembers: bool) -> None:
    rng = np.random.default_rng(12)
    log = campaign(RATE, 8.0)
    part = 1.0 - np.exp(-1.0 / (RATE * TAU))
    duty, late = np.empty((2, len(log)))
    for s in log.slices:
        holds = rng.uniform(0.1, 0.9, s.stop - s.start)
        duty[s] = holds[np.cumsum(rng.random(s.stop - s.start) < 2.5 / RATE)]
        late[s] = lfilter([part], [1.0, part - 1.0], duty[s] - duty[s][0]) + duty[s][0]
    problem = prepare(replace(log, duty=duty))
    white = rng.normal(0.0, 0.3, len(log))
    misfit = remembers * 6.0 * (late - late.mean()) * np.sign(log.xdot)
    found = lack_of_fit_test(problem, white + misfit)
    assert found.significant == remembers
    size = float(np.sqrt(np.mean(misfit**2)))
    assert found.misfit_rms == pytest.approx(size, rel=0.25, abs=0.1)

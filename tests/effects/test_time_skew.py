"""Force channel against the clock of the motion."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, force, signals, sine

from erdctl.effects import get
from erdctl.effects.time_skew import of_the_motion


@pytest.mark.parametrize(("tau", "expected"), [(5e-3, [0, 2, 6, 8]), (-5e-3, [2, 6, 8, 8])])
def test_check_value(tau: float, expected: list[float]) -> None:
    column = np.array([0.0, 4.0, 8.0, 8.0])
    s = signals(np.zeros(4))
    assert act("time_skew", column, s, {"tau": tau}) == pytest.approx(expected)


def test_records_keep_their_ends() -> None:
    column = np.array([0.0, 4.0, 8.0, 1.0, 5.0, 9.0])
    s = signals(np.zeros(6), t=np.array([0, 0.01, 0.02, 7, 7.01, 7.02]), starts=[0, 3, 6])
    found = act("time_skew", column, s, {"tau": 0.01})
    assert found == pytest.approx([0, 0, 4, 1, 1, 5])


def test_whole_samples_shift_the_force() -> None:
    s = sine(1.0, 0.01, 2.0, 500.0, duty=0.2)
    plain, late = (force("time_skew", s, {"tau": tau}) for tau in (0.0, 0.006))
    assert late[3:] == pytest.approx(plain[:-3], abs=1e-6)


def test_a_force_that_is_early_is_a_motion_that_is_late() -> None:
    """Of a deflection behind a filter a dead time of the fluid was said, and no more."""
    assert of_the_motion({"tau": 0.008}, 0.002) == ""
    assert "the motion was recorded late" in of_the_motion({"tau": -0.008}, 0.002)
    assert get("time_skew").caveat is of_the_motion

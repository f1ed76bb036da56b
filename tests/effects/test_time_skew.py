"""Force channel against the clock of the motion."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, force, signals, sine


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

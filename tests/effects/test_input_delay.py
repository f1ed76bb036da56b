"""Dead time of the control."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, force, signals


def test_check_value() -> None:
    s = signals(np.ones(4))
    field = act("input_delay", np.array([0.0, 1.0, 1.0, 1.0]), s, {"tau": 4e-3}, "release")
    assert field[:3] == pytest.approx([0.0, 0.6, 1.0])


def test_uneven_sampling_and_records() -> None:
    """A step at 0.03 s arrives at 0.05 s, amid a step of 40 ms; the next record keeps its own."""
    t = np.array([0.0, 0.01, 0.03, 0.07, 0.08, 5.0, 5.01])
    s = signals(np.ones(7), t=t, starts=[0, 5, 7])
    field = act("input_delay", np.array([2, 2, 6, 6, 6, 1, 1.0]), s, {"tau": 0.02}, "release")
    assert field == pytest.approx([2, 2, 4, 6, 6, 1, 1])


def test_force_is_that_of_the_earlier_duty() -> None:
    duty = np.where(np.arange(300) < 50, 0.1, 0.3)
    plain = force("input_delay", signals(np.full(300, 0.1), duty=duty, step=1e-3), {"tau": 0.0})
    late = force("input_delay", signals(np.full(300, 0.1), duty=duty, step=1e-3), {"tau": 0.02})
    assert late[20:] == pytest.approx(plain[:-20], abs=1e-9)
    assert late[:20] == pytest.approx(np.full(20, plain[0]), abs=1e-9)

"""Another time constant while the field decays."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, force, signals


def test_check_value() -> None:
    """86 ms after a step from 0.3 to 0 the yield force has fallen to exp(-1)."""
    duty = np.where(np.arange(201) < 100, 0.3, 0.0)
    s = signals(np.full(201, 0.1), duty=duty, step=0.001)
    found = force("rise_decay_asymmetry", s, {"r": 2.0}, k_nom=0.0, c_vis=0.0, T_d=0.043)
    assert found[186] / found[100] == pytest.approx(np.exp(-1))


def test_follows_the_last_step_in_each_record() -> None:
    duty = [0.3, 0.1, 0.1, 0.2, 0.2, 0.1, 0.1, 0.1]
    factor = act("rise_decay_asymmetry", signals(np.ones(8), duty=duty, starts=[0, 6, 8]), {"r": 3})
    assert factor == pytest.approx([1, 3, 3, 1, 1, 3, 1, 1])

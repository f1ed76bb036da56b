"""Another time constant while the field decays."""

from __future__ import annotations

import numpy as np
import pytest
from made import force, signals

from erdctl.effects import get
from erdctl.model.composed import Model


def test_check_value() -> None:
    """86 ms after a step from 0.3 to 0 the yield force has fallen to exp(-1)."""
    duty = np.where(np.arange(201) < 100, 0.3, 0.0)
    s = signals(np.full(201, 0.1), duty=duty, step=0.001)
    found = force("rise_decay_asymmetry", s, {"r": 2.0}, k_nom=0.0, c_vis=0.0, T_d=0.043)
    assert found[186] / found[100] == pytest.approx(np.exp(-1))


def test_falls_at_a_reversal_too() -> None:
    """Release has the smaller yield force: after the turn it is left at the slower rate."""
    xdot = np.where(np.arange(201) <= 100, 0.1, -0.1)
    s = signals(xdot, duty=np.full(201, 1.0), step=0.001)
    model = Model((get("rise_decay_asymmetry"),))
    values = dict.fromkeys(model.quantities, 0.0) | {
        "compression.sigma": 10.0, "release.sigma": 4.0, "compression.beta": 1.0,
        "release.beta": 1.0, "compression.T_d": 0.02, "release.T_d": 0.02,
        "rise_decay_asymmetry.r": 3.0,
    }  # fmt: skip
    found = -model.force(s, values)[161] - 4.0
    assert found == pytest.approx(6.0 * np.exp(-60.5 / 60.0))


def test_rise_is_left_alone() -> None:
    duty = np.where(np.arange(101) < 50, 0.1, 0.4)
    s = signals(np.full(101, 0.1), duty=duty, step=0.001)
    with_it = force("rise_decay_asymmetry", s, {"r": 5.0})
    assert with_it == pytest.approx(force("rise_decay_asymmetry", s, {"r": 1.0}))

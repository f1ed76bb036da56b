"""Guo's loop."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    s = signals([0.0, -0.010], x=[0.005, 0.005])
    law = act("yield_hysteresis", s, {"v_y": 0.01, "kappa": 2.0})
    assert law == pytest.approx([0.76159416, 0.0])


def test_is_guo_s_form() -> None:
    """tanh(k_1 x + c_1 xdot) with c_1 = 50 s/m and k_1 = 40 /m."""
    x, xdot = np.array([0.01, -0.02]), np.array([0.03, 0.02])
    law = act("yield_hysteresis", signals(xdot, x=x), {"v_y": 1 / 50, "kappa": 40 / 50})
    assert law == pytest.approx(np.tanh(40 * x + 50 * xdot))


def test_without_smoothing_it_is_a_shifted_sign() -> None:
    s = signals([0.01, -0.01], x=[-0.02, 0.001])
    assert act("yield_hysteresis", s, {"v_y": 0.0, "kappa": 1.0}) == pytest.approx([-1, -1])

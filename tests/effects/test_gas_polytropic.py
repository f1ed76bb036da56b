"""Eq. 3 in place of Eq. 14."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, force, signals


def test_check_value() -> None:
    s = signals(np.ones(3), x=[0.05, -0.1, 0.0])
    assert act("gas_polytropic", s, {"a": 10.0, "gamma": 1.0}) == pytest.approx([0.1, -0.05, 0.0])


def test_is_eq_3() -> None:
    """P_0 A_s (V_0 / (V_0 - A_s x))^gamma with k_nom = P_0 A_s gamma A_s / V_0."""
    P_0, A_s, V_0, gamma = 2e5, 1e-4, 2e-5, 1.4
    x = np.linspace(-0.03, 0.03, 7)
    s = signals(np.zeros(7), x=x)
    found = force(
        "gas_polytropic", s, {"a": A_s / V_0, "gamma": gamma, "F_0": P_0 * A_s},
        k_nom=P_0 * A_s * gamma * A_s / V_0,
    )  # fmt: skip
    assert found == pytest.approx(P_0 * A_s * (V_0 / (V_0 - A_s * x)) ** gamma)


def test_goes_over_into_the_spring() -> None:
    s = signals(np.ones(3), x=[0.05, -0.1, 0.01])
    assert act("gas_polytropic", s, {"a": 1e-9, "gamma": 1.4}) == pytest.approx(s.x, rel=1e-8)


def test_beyond_the_gas_the_tangent_goes_on() -> None:
    x = np.array([0.09499, 0.09500, 0.09501, 1.0])
    law = act("gas_polytropic", signals(np.ones(4), x=x), {"a": 10.0, "gamma": 1.4})
    slope = np.diff(law) / np.diff(x)
    assert slope == pytest.approx(0.05**-2.4, rel=0.01)

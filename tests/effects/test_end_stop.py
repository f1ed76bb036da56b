"""Contact beyond the stroke limit."""

from __future__ import annotations

import numpy as np
import pytest
from made import signals, unit_forces

from erdctl.effects import get
from erdctl.effects.end_stop import softer_than_the_gas

STOP = get("end_stop")
SPRING = {"x_stop": 0.02, "x_r": 0.02, "theta": 0.0, "e": 1e-3}


def test_check_value() -> None:
    s = signals(np.zeros(3), x=[0.019, 0.021, -0.022])
    columns = unit_forces("end_stop", s, SPRING)
    assert np.array([1000.0, 2000.0]) @ columns == pytest.approx([0, 1, -4])


def test_each_end_has_a_place_of_its_own() -> None:
    s = signals(np.zeros(4), x=[0.012, 0.006, 0.002, -0.001])
    columns = unit_forces("end_stop", s, SPRING | {"x_stop": 0.010, "x_r": -0.003})
    assert columns[0] == pytest.approx([0.002, 0, 0, 0])
    assert columns[1] == pytest.approx([0, 0, -0.001, -0.004])


def test_damping_far_deeper_than_the_contact_is_that_of_hunt_and_crossley() -> None:
    v, d, loss = np.array([0.2, -0.1, -1.0]), 1e-3, 3.0  # k d (1 + loss v), and no pull
    s = signals(v, x=np.full(3, 0.02 + d))
    deep = SPRING | {"theta": loss * 0.5, "e": 0.5}
    found = unit_forces("end_stop", s, deep)[0]
    assert found == pytest.approx(d * np.maximum(1 + loss * v, 0.0), rel=2e-3)


def test_damping_from_the_first_touch_is_a_dashpot_beside_the_spring() -> None:
    v, d, theta = np.array([0.2, -0.01, -1.0]), 1e-3, 0.01
    s = signals(v, x=np.full(3, 0.02 + d))
    found = unit_forces("end_stop", s, SPRING | {"theta": theta, "e": 1e-6})[0]
    assert found == pytest.approx(np.maximum(d + theta * v, 0.0))
    mirrored = signals(-v, x=np.full(3, -0.02 - d))
    other = unit_forces("end_stop", mirrored, SPRING | {"theta": theta, "e": 1e-6})[1]
    assert other == pytest.approx(-found)


def test_a_stop_that_is_softer_than_the_gas_is_said_to_be_none() -> None:
    """Of a deflection channel that is bent by a tenth 38 N/m of "stiff contact" were named."""
    values = {"compression.k_nom": 170.0, "release.k_nom": 120.0, "end_stop.k_c": 0.0}
    soft, stiff = (STOP.among(values | {"end_stop.k_r": k}) for k in (38.0, 800.0))
    assert "rather than a stop" in softer_than_the_gas(soft, 0.002)
    assert softer_than_the_gas(stiff, 0.002) == ""
    assert STOP.caveat is softer_than_the_gas

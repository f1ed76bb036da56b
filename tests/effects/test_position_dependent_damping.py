"""Damping along the stroke."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    s = signals(np.ones(4), x=[0.02, -0.02, 0.0, -0.2])
    found = act(
        "position_dependent_damping", s, {"b_1": 10.0, "b_2": 100.0, "e_1": 0.0, "e_2": 0.0}
    )
    assert found["viscous"] == pytest.approx([1.24, 0.84, 1.0, 3.0])
    found = act("position_dependent_damping", s, {"b_1": 0.0, "b_2": 0.0, "e_1": 10.0, "e_2": 0.0})
    assert found["yield"][3] == 0.0  # 1 - 2 would push
    assert "gas" not in found

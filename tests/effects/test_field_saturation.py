"""Yield stress that levels off."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    p = {"a_c": 2.0, "a_r": 0.0}
    field = act("field_saturation", np.array([0.5, 1.0]), signals(np.ones(2)), p, "compression")
    assert field == pytest.approx([0.38079708, 0.48201379])
    other = act("field_saturation", np.array([0.5, 1.0]), signals(np.ones(2)), p, "release")
    assert other == pytest.approx([0.5, 1.0])


def test_weak_saturation_is_the_third_order_term() -> None:
    field = act(
        "field_saturation", np.array([0.5]), signals(np.ones(1)), {"a_c": 1e-2}, "compression"
    )
    assert field == pytest.approx(0.5 - 1e-4 * 0.5**3 / 3, rel=1e-9)

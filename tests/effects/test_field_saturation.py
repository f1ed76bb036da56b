"""Yield stress that levels off."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    field = act("field_saturation", np.array([0.5, 1.0]), signals(np.ones(2)), {"a": 2.0})
    assert field == pytest.approx([0.38079708, 0.48201379])


def test_weak_saturation_is_the_third_order_term() -> None:
    field = act("field_saturation", np.array([0.5]), signals(np.ones(1)), {"a": 1e-2})
    assert field == pytest.approx(0.5 - 1e-4 * 0.5**3 / 3, rel=1e-9)

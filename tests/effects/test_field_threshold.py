"""No yield stress below a critical duty."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    s = signals(np.ones(3), duty=[0.03, 0.05, 0.30])
    assert act("field_threshold", s, {"v_c": 0.05}) ** 0.5 == pytest.approx([0, 0, 0.5])

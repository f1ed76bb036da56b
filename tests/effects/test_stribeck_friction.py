"""Friction that falls with speed."""

from __future__ import annotations

import numpy as np
import pytest
from made import signals, unit_forces


def test_check_value() -> None:
    columns = unit_forces("stribeck_friction", signals([0.01, -1.0]), {"v_s": 0.01})
    assert np.array([2.0, 1.0]) @ columns == pytest.approx([2.36787944, -2.0])

"""Contact beyond the stroke limit."""

from __future__ import annotations

import numpy as np
import pytest
from made import signals, unit_forces


def test_check_value() -> None:
    s = signals(np.zeros(3), x=[0.019, 0.021, -0.022])
    columns = unit_forces("end_stop", s, {"x_stop": 0.02})
    assert np.array([1000.0, 2000.0]) @ columns == pytest.approx([0, 1, -4])

"""Drift of the force channel."""

from __future__ import annotations

import numpy as np
import pytest
from made import signals, unit_forces


def test_check_value() -> None:
    s = signals(np.ones(4), t=np.array([5.0, 25.0, 100.0, 120.0]), starts=[0, 2, 4])
    columns = unit_forces("force_drift", s, {})
    assert np.array([-0.1, 0.01]) @ columns == pytest.approx([0, 2, 0, 2])

"""Static gas force."""

from __future__ import annotations

import numpy as np
import pytest
from made import signals, unit_forces

from erdctl.effects import get


def test_check_value() -> None:
    columns = unit_forces("gas_preload", signals(np.ones(3), x=[0, 0.01, -0.01]), {})
    assert 500e3 * 50e-6 * columns[0] == pytest.approx([25, 25, 25])


def test_says_what_it_cannot_be_told_from() -> None:
    assert get("gas_preload").equivalents == ("force_offset",)

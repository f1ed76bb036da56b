"""Constant seal friction."""

from __future__ import annotations

import pytest
from made import signals, unit_forces


def test_check_value() -> None:
    columns = unit_forces("coulomb_friction", signals([0.1, 0.0, -0.2]), {})
    assert 3.0 * columns[0] == pytest.approx([3, 0, -3])

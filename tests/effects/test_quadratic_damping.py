"""Turbulent loss."""

from __future__ import annotations

import pytest
from made import signals, unit_forces


def test_check_value() -> None:
    columns = unit_forces("quadratic_damping", signals([0.1, -0.3]), {})
    assert 200.0 * columns[0] == pytest.approx([2, -18])

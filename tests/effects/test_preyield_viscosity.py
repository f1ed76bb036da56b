"""Bi-viscous law."""

from __future__ import annotations

import pytest
from made import act, signals


def test_check_value() -> None:
    s = signals([0.005, -0.020, 0.0])
    assert act("preyield_viscosity", s, {"v_y": 0.01}) == pytest.approx(
        [0.46211716, -0.96402758, 0]
    )


def test_goes_over_into_the_sign() -> None:
    s = signals([0.005, -0.020, 0.0])
    assert act("preyield_viscosity", s, {"v_y": 1e-6}) == pytest.approx([1, -1, 0])

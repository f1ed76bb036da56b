"""Power law of the viscous force."""

from __future__ import annotations

import pytest
from made import act, signals


def test_check_value() -> None:
    assert act("shear_thinning", signals([0.1, -0.4, 0.0]), {"n": 0.5}) == pytest.approx(
        [0.1, -0.2, 0.0]
    )

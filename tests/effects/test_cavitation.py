"""Release force lost after a reversal."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    """Up at 1 mm/ms, then down: 1 mm and 3 mm after the reversal."""
    up_down = np.where(np.arange(20) < 10, 1.0, -1.0)
    s = signals(up_down, step=1e-3)
    found = act("cavitation", s, {"x_v": 2e-3, "lambda": 0.8})
    since = s.path_since_reversal
    assert since[10:14] == pytest.approx([0.25e-3, 1.25e-3, 2.25e-3, 3.25e-3])
    assert found["viscous"][:10] == pytest.approx(np.ones(10))
    assert found["viscous"][[10, 11, 13]] == pytest.approx([0.2, 0.2, 1.0])
    assert found["viscous"][12] == pytest.approx(1 - 0.8 * 0.25)  # within the travel of one sample
    assert found["yield"] is found["viscous"]
    assert "gas" not in found


def test_a_record_that_begins_in_release_has_no_void() -> None:
    s = signals([-1.0] * 5 + [1.0] * 5 + [-1.0] * 5, step=1e-3, starts=[0, 5, 15])
    found = act("cavitation", s, {"x_v": 2e-3, "lambda": 1.0})["yield"]
    assert found[:10] == pytest.approx(np.ones(10))
    assert found[10:12] == pytest.approx([0.0, 0.0])


def test_a_short_void_is_none() -> None:
    s = signals([1.0, 1.0, -1.0, -1.0], step=1e-3)
    assert act("cavitation", s, {"x_v": 1e-6, "lambda": 1.0})["yield"] == pytest.approx(np.ones(4))

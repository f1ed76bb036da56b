"""Release force lost after a reversal."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    """Up at 1 mm/ms, then down: 1 mm and 3 mm after the reversal."""
    up_down = np.where(np.arange(20) < 10, 1.0, -1.0)
    s = signals(up_down, step=1e-3)
    found = act("cavitation", s, {"x_v": 2e-3, "lambda": 0.8, "g": 100.0, "e": 0.0})
    since = s.path_since_reversal
    assert since[10:14] == pytest.approx([0.25e-3, 1.25e-3, 2.25e-3, 3.25e-3])
    assert found["viscous"][:10] == pytest.approx(np.ones(10))
    assert found["viscous"][[10, 11, 13]] == pytest.approx([0.2, 0.2, 1.0])
    assert found["viscous"][12] == pytest.approx(1 - 0.8 * 0.25)  # within the travel of one sample
    assert found["yield"] is found["viscous"]
    assert "gas" not in found


def test_a_record_that_begins_in_release_has_no_void() -> None:
    s = signals([-1.0] * 5 + [1.0] * 5 + [-1.0] * 5, step=1e-3, starts=[0, 5, 15])
    found = act("cavitation", s, {"x_v": 2e-3, "lambda": 1.0, "g": 100.0, "e": 0.0})["yield"]
    assert found[:10] == pytest.approx(np.ones(10))
    assert found[10:12] == pytest.approx([0.0, 0.0])


def test_a_short_void_is_none() -> None:
    s = signals([1.0, 1.0, -1.0, -1.0], step=1e-3)
    assert act("cavitation", s, {"x_v": 1e-6, "lambda": 1.0, "g": 100.0, "e": 0.0})[
        "yield"
    ] == pytest.approx(np.ones(4))


def test_a_short_compression_leaves_a_small_void() -> None:
    """Check value: 2 mm of compression leave 1 mm, of which 0.5 mm and nothing are left."""
    s = signals([1.0] * 20 + [-1.0] * 20, step=1e-4)
    found = act("cavitation", s, {"x_v": 2e-3, "lambda": 0.8, "g": 0.5, "e": 0.0})["yield"]
    since = s.path_since_reversal
    half, over = (int(np.argmin(np.abs(since - d))) for d in (0.5e-3, 1.5e-3))
    assert found[[half, over]] == pytest.approx([0.2, 1.0])


def test_what_one_release_leaves_the_next_takes_up() -> None:
    strokes = ((1.0, 30), (-1.0, 10), (1.0, 2), (-1.0, 20))  # +-0.1 mm a sample
    s = signals([v for v, n in strokes for _ in range(n)], step=1e-4)
    found = act("cavitation", s, {"x_v": 2e-3, "lambda": 1.0, "g": 1.0, "e": 0.0})["yield"]
    lost = int(np.count_nonzero(found[42:] < 0.5))
    assert lost == pytest.approx(12, abs=1)  # 2 mm, less 1 mm, and 0.2 mm more


def test_the_force_returns_over_a_part_of_the_void() -> None:
    s = signals([1.0] * 40 + [-1.0] * 40, step=1e-4)
    p = {"x_v": 2e-3, "lambda": 1.0, "g": 100.0, "e": 0.5}
    found = act("cavitation", s, p)["yield"][40:]
    expected = np.clip((s.path_since_reversal[40:] - 1e-3) / 1e-3, 0.0, 1.0)
    assert found == pytest.approx(expected, abs=0.06)

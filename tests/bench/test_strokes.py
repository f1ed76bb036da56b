"""Strokes and cycles against motions whose reversals are known."""

from __future__ import annotations

import numpy as np

from erdctl.bench.strokes import cycles, steady, stretches, strokes, varied
from erdctl.core.recording import Recording

W = 2 * np.pi


def moving(x: np.ndarray, xdot: np.ndarray, rate: float, *ends: int) -> Recording:
    bounds = np.array([0, *(ends or (len(x),))], dtype=np.intp)
    return Recording(
        t=np.arange(len(x)) / rate, x=x, xdot=xdot, duty=np.zeros(len(x)), starts=bounds,
        names=tuple(f"r{i}" for i in range(len(bounds) - 1)),
    )  # fmt: skip


def sine(seconds: float, rate: float = 100.0) -> Recording:
    t = np.arange(int(seconds * rate)) / rate
    return moving(np.sin(W * t), W * np.cos(W * t), rate)


def test_five_strokes_in_three_seconds() -> None:
    found = strokes(sine(3.0))
    assert len(found) == 5  # reversals at 0.25, 0.75, ... 2.75 s
    assert found.compression.tolist() == [False, True, False, True, False]
    # Beyond 5 % of the highest speed: asin(0.05) / (2 pi) = 8 ms after the reversal.
    assert found.first.tolist() == [26, 76, 126, 176, 226]
    assert found.end.tolist() == [75, 125, 175, 225, 275]
    assert found.close.tolist() == [76, 126, 176, 226, 276]


def test_noise_at_a_reversal_makes_no_stroke() -> None:
    clean = sine(3.0, 10_000.0)
    rng = np.random.default_rng(3)
    rough = moving(clean.x, clean.xdot + 0.06 * rng.standard_normal(30_000), 10_000.0)
    assert len(np.flatnonzero(np.diff(np.sign(rough.xdot)))) > 20
    assert len(strokes(rough)) == 5


def test_records_are_apart() -> None:
    one = sine(3.0)
    two = moving(np.tile(one.x, 2), np.tile(one.xdot, 2), 100.0, 300, 600)
    found = strokes(two)
    assert len(found) == 10
    assert found.record.tolist() == [0] * 5 + [1] * 5
    first, end = cycles(two)
    assert len(first) == 8
    assert not np.any((first < 300) & (end > 300))


def test_a_steady_cycle_closes_and_a_wandering_one_does_not() -> None:
    still = sine(3.0)
    first, end = cycles(still)
    assert len(first) == 4
    assert np.abs(still.x[end - 1] - still.x[first]).max() < 1e-6
    t = still.t
    drift = moving(np.sin(W * t) + t, W * np.cos(W * t) + 1.0, 100.0)
    assert not steady(drift, strokes(drift)).any()
    assert len(cycles(drift)[0]) > 0  # there is nothing better
    both = moving(
        np.concatenate([still.x, drift.x]), np.concatenate([still.xdot, drift.xdot]), 100.0,
        300, 600,
    )  # fmt: skip
    assert (cycles(both)[0] < 300).all()


def test_standing_still_has_no_strokes() -> None:
    rest = moving(np.zeros(50), np.zeros(50), 100.0)
    assert len(strokes(rest)) == 0
    assert len(cycles(rest)[0]) == 0
    assert strokes(rest).highest(rest.x).size == 0


def test_varied_check_value() -> None:
    assert varied(np.array([[1.0], [1.01], [3.0], [2.0]]), 3).tolist() == [2, 0, 3]
    assert varied(np.empty((0, 2)), 3).size == 0


def test_stretches_end_with_their_record() -> None:
    flags = np.array([0, 1, 1, 0, 1], dtype=bool)
    first, end = stretches(flags, np.array([0, 5]))
    assert [first.tolist(), end.tolist()] == [[1, 4], [3, 5]]
    first, end = stretches(flags, np.array([0, 2, 5]))
    assert [first.tolist(), end.tolist()] == [[1, 2, 4], [2, 3, 5]]

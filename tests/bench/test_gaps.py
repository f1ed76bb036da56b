"""Samples that a recorder lost are counted, whether its clock jitters or not; a jitter is none."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from erdctl.bench.gaps import BESIDE, Gaps, gaps_of


def found(t: np.ndarray) -> Gaps:
    steps = np.diff(t)
    return gaps_of(t, steps, float(np.median(steps)))


def jittering(amplitude: float, seed: int, count: int = 3000) -> np.ndarray:
    random = np.random.default_rng(seed)
    return 5e-3 * (np.arange(count) + random.uniform(-amplitude, amplitude, count))


@settings(deadline=None, max_examples=60)
@given(amplitude=st.floats(0.0, 0.45), seed=st.integers(0, 10_000))
def test_a_clock_that_jitters_loses_nothing(amplitude: float, seed: int) -> None:
    """At 0.3 of a step one in fifty steps is over 1.5: 14 to 41 samples of each record were said
    to be missing."""
    assert len(found(jittering(amplitude, seed)).at) == 0


@settings(deadline=None, max_examples=60)
@given(
    amplitude=st.floats(0.0, 0.4),
    seed=st.integers(0, 10_000),
    runs=st.dictionaries(st.integers(1, 40), st.integers(2, 30), min_size=1, max_size=5),
)
def test_what_is_lost_beside_it_is_counted(
    amplitude: float, seed: int, runs: dict[int, int]
) -> None:
    """Runs of lost samples, far enough apart for the samples between them to say so."""
    lost = [start * 4 * BESIDE + k for start, n in runs.items() for k in range(n)]
    t = np.delete(jittering(amplitude, seed), lost)
    gaps = found(t)
    assert gaps.lost.sum() == len(lost)
    assert len(runs) <= len(gaps.at) <= len(lost)


def test_a_rate_that_changes_is_a_gap_at_every_step() -> None:
    steps = np.repeat([5e-3, 1e-2], [2000, 500])
    gaps = found(np.append(0.0, np.cumsum(steps)))
    assert len(gaps.at) == 500
    assert set(gaps.lost.tolist()) == {1}


def test_a_record_of_two_or_three_samples() -> None:
    assert len(found(np.array([0.0, 0.1])).at) == 0
    assert found(np.array([0.0, 0.1, 0.2, 0.6])).lost.tolist() == [3]

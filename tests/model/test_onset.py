"""How far a change has set in: against the mean of the ramp, worked out by fine sums."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.model.onset import onset_weight


def by_sums(t: float, t_0: float, t_r: float, step: float) -> float:
    """Mean of the ramp over a step about t, of 20,000 midpoints."""
    u = t + step * ((np.arange(20_000) + 0.5) / 20_000 - 0.5) - t_0
    ramp = np.minimum(u, t_r) / t_r if t_r > 0 else (u >= 0).astype(float)
    return float(np.mean(np.clip(ramp, 0.0, 1.0)))


@given(st.floats(-3.0, 3.0), st.floats(0.0, 3.0), st.floats(0.01, 1.0))
def test_it_is_the_mean_over_the_step(t: float, t_r: float, step: float) -> None:
    found = onset_weight(np.array([t]), 0.0, t_r, step)
    assert found == pytest.approx([by_sums(t, 0.0, t_r, step)], abs=1e-4)


def test_a_step_lies_between_two_samples() -> None:
    """Any onset between two samples is one of them or the other; half way it is a clean step."""
    t = np.arange(6.0)
    assert onset_weight(t, 2.5, 0.0, 1.0).tolist() == [0, 0, 0, 1, 1, 1]
    assert onset_weight(t, 3.0, 0.0, 1.0).tolist() == [0, 0, 0, 0.5, 1, 1]
    assert onset_weight(t, 2.5, 1e-9, 1.0) == pytest.approx([0, 0, 0, 1, 1, 1], abs=1e-8)


@pytest.mark.parametrize("t_0", [-1e6, 1e6])
@pytest.mark.parametrize("t_r", [0.0, 1e-9, 1.0, 1e6])
@pytest.mark.parametrize("step", [0.0, 0.01])
def test_finite_within_all_bounds(t_0: float, t_r: float, step: float) -> None:
    w = onset_weight(np.linspace(0.0, 60.0, 50), t_0, t_r, step)
    assert np.isfinite(w).all()
    assert ((w >= 0.0) & (w <= 1.0)).all()
    if t_0 > 0:
        assert (w == 0.0).all()


def test_each_sample_has_a_step_of_its_own() -> None:
    """Records of several rates in one log; the first sample of a record has no step before it."""
    t, step = np.array([0.1, 0.1, 0.1]), np.array([1.0, 0.1, 0.0])
    assert onset_weight(t, 0.0, 0.0, step) == pytest.approx([0.6, 1.0, 1.0])
    assert onset_weight(t, 0.0, 0.2, step) == pytest.approx([0.5, 0.5, 0.5])

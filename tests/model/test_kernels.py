"""The shared recurrence against a plain loop and against a library."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import lfilter

from erdctl.core.recording import Array
from erdctl.model.kernels import first_order, follow


def plain(exponent: Array, source: Array, initial: Array, starts: Array) -> Array:
    out = np.empty_like(source)
    for r in range(len(initial)):
        a, b = int(starts[r]), int(starts[r + 1])
        out[a] = initial[r]
        for i in range(a, b - 1):
            out[i + 1] = np.exp(-exponent[i]) * out[i] + source[i]
    return out


def test_check_value() -> None:
    starts, zero = np.array([0, 4]), np.zeros(1)
    expected = [0.0, 1.0, 1.5, 1.75]
    assert first_order(np.log(2), np.ones(4), zero, starts) == pytest.approx(expected)
    assert first_order(np.full(4, np.log(2)), np.ones(4), zero, starts) == pytest.approx(expected)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4), st.floats(1e-6, 1e3))
def test_varying_equals_plain_loop(seed: int, records: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    lengths = rng.integers(1, 300, records)
    starts = np.concatenate([[0], np.cumsum(lengths)])
    exponent = rng.gamma(0.3, scale, starts[-1])
    source, initial = rng.normal(size=starts[-1]), rng.normal(size=records)
    found = first_order(exponent, source, initial, starts)
    assert found == pytest.approx(plain(exponent, source, initial, starts), rel=1e-9, abs=1e-9)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(1e-9, 800.0), st.integers(1, 20_000))
def test_uniform_equals_lfilter(seed: int, exponent: float, n: int) -> None:
    source = np.random.default_rng(seed).normal(size=n)
    found = first_order(exponent, source, np.zeros(1), np.array([0, n]))
    expected = lfilter([0.0, 1.0], [1.0, -np.exp(-exponent)], source)
    assert np.abs(found - expected).max() <= 1e-9 * np.abs(expected).max(initial=1.0)


def test_what_follows_a_target_that_jumps_within_a_step() -> None:
    """The docstring's: -1 for one time constant, then 1 for one."""
    part = np.array([1.0])
    target, turns, starts = np.array([-1.0, 1.0, 1.0]), np.array([0]), np.array([0, 3])
    y = follow(target, 2.0, turns, part, part, target[:1], starts)
    assert y[1] == pytest.approx(1.0 - 2.0 * np.exp(-1.0), abs=1e-12)
    assert y[2] == pytest.approx(1.0 - (1.0 - y[1]) * np.exp(-2.0), abs=1e-12)

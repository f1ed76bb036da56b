"""xdot from x: accuracy, noise, the claimed bandwidth, ends of records, uneven times."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import savgol_filter

from erdctl.bench.differentiation import _at_actual_times, bandwidth, derive_xdot
from erdctl.core.errors import ExitCode, InputProblem
from erdctl.core.recording import Array, Index


def one(n: int) -> Index:
    return np.array([0, n], dtype=np.intp)


def uneven(n: int, step: float, jitter: float, seed: int = 0) -> Array:
    rng = np.random.default_rng(seed)
    return np.cumsum(step * (1.0 + jitter * rng.uniform(-1.0, 1.0, n)))


def rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_sine_against_its_derivative() -> None:
    t = np.arange(5000) * 1e-3
    w = 2.0 * np.pi * 1.5
    xdot, note = derive_xdot(t, 0.02 * np.sin(w * t), one(t.size))
    error = np.abs(xdot / (0.02 * w) - np.cos(w * t))
    # theta^2 / 6 sum k^4 / sum k^2 = 9.7e-4 of the amplitude would be a quadratic's own loss
    assert error[10:-10].max() < 1e-6
    assert error.max() < 1e-3
    assert "Savitzky-Golay" in note
    assert "quartic, 21 samples = 20 ms" in note


@pytest.mark.parametrize("step", [1e-4, 1e-3, 5e-3])
@pytest.mark.parametrize("spacing", ["even", "uneven"])
def test_quadratics_are_exact_to_the_ends(step: float, spacing: str) -> None:
    n = 1000
    t = np.arange(n) * step if spacing == "even" else uneven(n, step, 0.3)
    xdot, note = derive_xdot(t, 0.3 - 0.2 * t + 0.7 * t**2, one(n))
    assert np.allclose(xdot, -0.2 + 1.4 * t, rtol=1e-7, atol=1e-9)
    assert ("uneven" in note) == (spacing == "uneven")


@pytest.mark.parametrize("noise", [0.0, 1e-2])
@pytest.mark.parametrize("rate", [200.0, 1000.0, 10000.0])
def test_the_claimed_bandwidth_is_where_a_sine_has_lost_3_db(rate: float, noise: float) -> None:
    t = np.arange(int(4 * rate)) / rate
    noise = np.random.default_rng(3).normal(scale=noise, size=t.size)
    _, note = derive_xdot(t, np.sin(40.0 * t) + noise, one(t.size))
    said = re.search(r"\((\w+), (\d+) samples .* -3 dB at ([\d.]+) Hz", note)
    assert said
    w = 2.0 * np.pi * float(said[3])
    width, degree = int(said[2]), {"quadratic": 2, "quartic": 4}[said[1]]
    xdot = savgol_filter(np.sin(w * t) / w, width, degree, deriv=1, delta=1.0 / rate)
    inner = slice(t.size // 10, -t.size // 10)
    gain = rms(xdot[inner]) / rms(np.cos(w * t)[inner])
    assert gain == pytest.approx(np.sqrt(0.5), rel=0.01)


def test_bandwidth_of_a_long_window() -> None:
    assert bandwidth(20001, 1e-6) == pytest.approx(1.81482298 / (2.0 * np.pi * 0.01), rel=1e-4)


def test_noise_gain() -> None:
    # variance of sum k x_k / (h sum k^2) for white x: sigma^2 / (h^2 sum k^2), k = -66..66
    rng = np.random.default_rng(1)
    t = np.arange(200_000) * 1e-3
    x = 1.0 * t + rng.normal(scale=1e-6, size=t.size)  # a rod at rest would have no speed at all
    xdot, note = derive_xdot(t, x, one(t.size))
    assert "quadratic, 133 samples = 132 ms" in note
    squares = 2.0 * np.sum(np.arange(1.0, 67.0) ** 2)
    assert rms(xdot - 1.0) == pytest.approx(1e-6 / 1e-3 / np.sqrt(squares), rel=0.02)


def worth(t: Array, x: Array, xdot: Array) -> float:
    """Error of the velocity over that of the filter of 20 ms, the ends left out."""
    width = max(2 * round(0.010 / (t[1] - t[0])) + 1, 5)
    inner = slice(t.size // 10, -t.size // 10)
    found, narrow = derive_xdot(t, x, one(t.size))[0], savgol_filter(x, width, 2, 1, t[1] - t[0])
    return rms((found - xdot)[inner]) / rms((narrow - xdot)[inner])


def test_no_window_leaves_more_than_that_of_20_ms() -> None:
    """Of motions up to 15 Hz, sampled at 100 Hz to 2 kHz, with noise and digits up to 1 % of them;
    as read by that filter, 12 Hz at 200 Hz lost 8 % of the speed, and noise stayed in others."""
    random, found = np.random.default_rng(11), []
    for _ in range(200):
        rate, amplitude = float(random.choice([100.0, 200.0, 500.0, 1000.0, 2000.0])), 0.01
        t = np.arange(int(6.0 * rate)) / rate
        w = 2.0 * np.pi * np.exp(random.uniform(np.log(0.3), np.log(15.0), 3))
        phase, part = random.uniform(0.0, 6.0, 3), random.dirichlet(np.ones(3)) * amplitude
        x = np.sum(part[:, None] * np.sin(w[:, None] * t + phase[:, None]), axis=0)
        xdot = np.sum((part * w)[:, None] * np.cos(w[:, None] * t + phase[:, None]), axis=0)
        x += 10.0 ** random.uniform(-8.0, -4.0) * random.standard_normal(t.size)
        digit = 10.0 ** random.uniform(-8.0, -4.3)
        found.append(worth(t, np.round(x / digit) * digit, xdot))
    print(np.quantile(found, [0.0, 0.25, 0.5, 0.75, 0.95, 1.0]).round(3))
    assert max(found) < 1.2
    assert np.median(found) < 0.3


def test_a_triangle_is_no_worse_for_it() -> None:
    t = np.arange(8000) * 1e-3
    phase = 2.0 * np.pi * t
    x, xdot = 0.01 * 2.0 / np.pi * np.arcsin(np.sin(phase)), 0.04 * np.sign(np.cos(phase))
    for noise in (0.0, 1e-7, 1e-6, 1e-5):
        noisy = x + noise * np.random.default_rng(4).standard_normal(t.size)
        assert worth(t, noisy, xdot) < 1.1


def test_both_methods_are_one_on_even_times() -> None:
    rng = np.random.default_rng(2)
    t = np.arange(3000) * 1e-3
    x = rng.normal(size=t.size)
    even, actual = savgol_filter(x, 21, 2, 1, 1e-3), _at_actual_times(t, x, 21)
    assert np.allclose(even, actual, rtol=1e-9, atol=1e-9 * rms(even))


def test_uneven_times_do_not_add_error() -> None:
    t = uneven(20_000, 1e-3, 0.4)
    w = 2.0 * np.pi * 2.0
    xdot, _ = derive_xdot(t, np.sin(w * t), one(t.size))
    assert np.abs(xdot / w - np.cos(w * t))[10:-10].max() < 3e-3  # 1.7e-3 on even times


def test_times_rounded_when_they_were_logged_count_as_even() -> None:
    t = np.round(np.arange(4000) / 3000.0, 7)
    xdot, note = derive_xdot(t, 2.0 * t, one(t.size))
    assert "Savitzky-Golay" in note
    # The median step is off by 1e-4 of itself, the mean is not.
    assert np.mean(xdot) == pytest.approx(2.0, rel=1e-7)


def test_records_do_not_see_each_other() -> None:
    t = np.arange(500) * 1e-3
    first, second = np.sin(20.0 * t), 5.0 + np.cos(20.0 * t)
    together, _ = derive_xdot(
        np.concatenate([t, t]), np.concatenate([first, second]), np.array([0, 500, 1000])
    )
    alone = [derive_xdot(t, x, one(500))[0] for x in (first, second)]
    assert np.array_equal(together, np.concatenate(alone))


@pytest.mark.parametrize(("n", "width"), [(5, 5), (6, 5), (12, 11), (21, 21)])
def test_short_records_shrink_the_window(n: int, width: int) -> None:
    t = np.arange(n) * 1e-3
    xdot, note = derive_xdot(t, 3.0 * t, one(n))
    assert f"{width} samples" in note
    assert np.allclose(xdot, 3.0)


@pytest.mark.parametrize("n", [2, 3, 4])
def test_shortest_records(n: int) -> None:
    t = np.arange(n) * 1e-3
    xdot, note = derive_xdot(t, 3.0 * t, one(n))
    assert np.allclose(xdot, 3.0)
    assert "fewer than 5 samples" in note


def test_notes_of_records_sampled_differently() -> None:
    steps = [1e-3, 2e-3, 4e-3, 1e-4, 2e-4]
    t = np.concatenate([np.arange(300) * s for s in steps])
    starts = np.arange(0, 1501, 300)
    _, note = derive_xdot(t, t, starts)
    assert note.count("-3 dB") == 3
    assert note.endswith("and 2 other windows")


@pytest.mark.parametrize("first", [0, 400])
def test_pauses_are_refused_at_their_row(first: int) -> None:
    t = np.arange(800) * 1e-3
    t[first + 123 :] += 0.05
    with pytest.raises(InputProblem) as caught:
        derive_xdot(t, t, np.array([0, 400, 800]), file="a.csv", row_of=lambda i: i + 2)
    text = str(caught.value)
    assert text.startswith(f"a.csv: row {first + 123 + 2}, column 't': t pauses for 0.051 s")
    assert "step is 0.001 s" in text
    assert caught.value.exit_code == ExitCode.BAD_INPUT


def test_a_single_sample_is_refused() -> None:
    t = np.array([0.0, 1.0, 2.0, 0.0])
    with pytest.raises(InputProblem, match="row 4: a record of one sample"):
        derive_xdot(t, t, np.array([0, 3, 4]))


@given(
    n=st.integers(2, 60),
    jitter=st.floats(0.0, 0.9),
    step=st.floats(1e-5, 1.0),
    slope=st.floats(-10.0, 10.0),
    offset=st.floats(-1.0, 1.0),
)
@settings(deadline=None)
def test_lines_on_any_times(
    n: int, jitter: float, step: float, slope: float, offset: float
) -> None:
    t = uneven(n, step, jitter)
    x = offset + slope * t
    xdot, _ = derive_xdot(t, x, one(n))
    rounding = 1e-12 * (1.0 + np.abs(x).max()) / np.diff(t).min()
    assert np.abs(xdot - slope).max() <= rounding + 2e-3 * abs(slope)


@pytest.mark.parametrize(("rate", "digit"), [(300.0, 1e-3), (512.0, 1e-3), (2048.0, 1e-4)])
def test_times_rounded_to_a_last_digit_are_those_of_an_even_clock(
    rate: float, digit: float
) -> None:
    """Steps of 3 and 4 ms for 300 Hz: at the times as written the speed was 1 to 3 % off."""
    true = np.arange(int(6.0 * rate)) / rate
    xdot, note = derive_xdot(np.round(true / digit) * digit, np.sin(19.0 * true), one(true.size))
    assert "Savitzky-Golay" in note
    error = (xdot / 19.0 - np.cos(19.0 * true))[20:-20]
    assert np.abs(error).max() < 1e-3


def test_a_clock_that_jitters_is_not_even() -> None:
    t = uneven(2000, 5e-3, 0.1)
    for digit in (1e-9, 1e-4, 1e-5):
        _, note = derive_xdot(np.round(t / digit) * digit, np.sin(t), one(t.size))
        assert "uneven" in note


def test_a_lost_sample_is_no_rounding() -> None:
    t = np.delete(np.arange(1000) * 5e-3, 500)
    xdot, note = derive_xdot(t, 3.0 * t, one(t.size))
    assert "uneven" in note
    assert np.allclose(xdot, 3.0)


@pytest.mark.parametrize("spacing", ["even", "uneven"])
def test_a_rod_at_rest_has_no_direction(spacing: str) -> None:
    """Slopes of 1e-16 m/s, of either sign, were a direction of motion, and the yield force of it:
    a third of a log of ramps with dwells was off by that (NRMSE 0.118 for its noise of 0.015)."""
    t = np.arange(3000) * 1e-3
    if spacing == "uneven":
        t = t + 2e-4 * np.random.default_rng(3).random(3000)
    x = 0.123456 + np.interp(t, [0.0, 1.0, 2.0, 3.0], [0.007, 0.007, -0.003, -0.003])
    xdot, _ = derive_xdot(t, x, np.array([0, 3000]))
    rests = (t < 0.9) | (t > 2.1)
    assert not xdot[rests].any()
    assert np.all(xdot[(t > 1.1) & (t < 1.9)] < -0.009)


def test_a_window_of_seconds_is_said_in_s() -> None:
    """Of a log of one sample a second it was "5 samples = 4e+03 ms"."""
    t: Array = np.arange(50.0)
    _, note = derive_xdot(t, 0.01 * np.sin(0.1 * t), np.array([0, 50]))
    assert "5 samples = 4 s;" in note

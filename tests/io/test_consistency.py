"""x against xdot: wrong units and signs are found, and nothing else is ever accused."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.io.checks import Place
from erdctl.io.consistency import check_consistency

OWN = {"t": "t", "x": "x", "xdot": "xdot"}
PLACE = Place("log.csv", lambda sample: sample + 2)


def check(t: Array, x: Array, xdot: Array, starts: list[int] | None = None) -> None:
    offsets = np.array([0, t.size] if starts is None else starts)
    check_consistency(t, x, xdot, offsets, PLACE, sources=OWN)


def motion(n: int = 5000, rate: float = 1000.0) -> tuple[Array, Array, Array]:
    t = np.arange(n) / rate
    x = 0.02 * np.sin(9.0 * t) + 0.001 * np.sin(70.0 * t)
    return t, x, 0.18 * np.cos(9.0 * t) + 0.07 * np.cos(70.0 * t)


@pytest.mark.parametrize(
    ("t", "x", "xdot", "words"),
    [
        (1, 1, 1e3, 'xdot seems to be in mm/s: --map "xdot=xdot[mm/s]"'),
        (1, 1, 1e2, 'xdot seems to be in cm/s: --map "xdot=xdot[cm/s]"'),
        (1, 1, 39.37, 'xdot seems to be in inches per second: --map "xdot=xdot[in/s]"'),
        (1, 1e3, 1, 'x seems to be in millimetres: --map "x=x[mm]"'),
        (1, 1e2, 1, "x seems to be in centimetres"),
        (1, 39.37, 1, 'x seems to be in inches: --map "x=x[in]"'),
        (1e3, 1, 1, 't seems to be in milliseconds: --map "t=t[ms]"'),
        (1 / 60, 1, 1, 't seems to be in minutes: --map "t=t[min]"'),
        (1, 7, 1, "one of t, x and xdot is in another unit"),
        (1, 1, -1, 'change the sign of one, e.g. --map "xdot=-xdot"'),
        (1, -1e-3, 1, "change the sign of one"),
    ],
)
def test_wrong_units_and_signs(t: float, x: float, xdot: float, words: str) -> None:
    a, b, c = motion()
    with pytest.raises(InputProblem) as caught:
        check(a * t, b * x, c * xdot)
    assert str(caught.value).startswith("log.csv: row 2, column 'xdot': dx/dt is ")
    assert words in str(caught.value)


@pytest.mark.parametrize("factor", [0.25, 0.5, 1.0, 2.0, 4.0])
def test_gain_errors_are_no_matter_of_units(factor: float) -> None:
    t, x, xdot = motion()
    check(t, x, factor * xdot)


def test_the_record_at_fault_is_named_by_its_row() -> None:
    t, x, xdot = motion()
    xdot[3000:] *= 1e3
    with pytest.raises(InputProblem, match=r"row 3002, column 'xdot'.*mm/s"):
        check(t, x, xdot, [0, 1000, 3000, 5000])


@pytest.mark.parametrize("quantum", [1e-6, 1e-5, 1e-4])
@pytest.mark.parametrize("rate", [1000.0, 10_000.0])
def test_quantised_deflection_in_wrong_units_is_found(quantum: float, rate: float) -> None:
    t, x, xdot = motion(int(5 * rate), rate)
    x = np.round(x / quantum) * quantum
    check(t, x, xdot)
    with pytest.raises(InputProblem, match="mm/s"):
        check(t, x, 1e3 * xdot)


def test_long_records_are_sampled() -> None:
    t, x, xdot = motion(1_000_000)
    check(t, x, xdot)
    with pytest.raises(InputProblem, match="millimetres"):
        check(t, 1e3 * x, xdot)


def test_the_words_use_the_logs_own_names() -> None:
    t, x, xdot = motion()
    with pytest.raises(InputProblem, match=r"column 'v'.*--map \"xdot=v\[mm/s\]\""):
        check_consistency(
            t, x, 1e3 * xdot, np.array([0, t.size]), PLACE, sources=OWN | {"xdot": "v"}
        )


# --- what must never be accused


@given(
    seed=st.integers(0, 2**32 - 1),
    kind=st.sampled_from(["still", "drift", "sine", "slow sine", "steps", "walk"]),
    x_noise=st.floats(0.0, 1e-3),
    v_noise=st.floats(0.0, 10.0),
    v_offset=st.floats(-1.0, 1.0),
    quantum=st.sampled_from([0.0, 1e-6, 1e-5, 1e-4, 1e-3]),
    smoothing=st.sampled_from([1, 5, 21, 101]),
    gain=st.floats(0.4, 2.5),
    rate=st.sampled_from([50.0, 1000.0, 20_000.0]),
    n=st.integers(2, 3000),
)
@settings(max_examples=400, deadline=None)
def test_noise_offsets_filters_and_quantisation_are_never_accused(
    seed: int,
    kind: str,
    x_noise: float,
    v_noise: float,
    v_offset: float,
    quantum: float,
    smoothing: int,
    gain: float,
    rate: float,
    n: int,
) -> None:
    rng = np.random.default_rng(seed)
    t = np.cumsum(rng.uniform(0.5, 1.5, n)) / rate
    x = {
        "still": np.zeros(n),
        "drift": 1e-6 * t,
        "sine": 0.01 * np.sin(20.0 * t),
        "slow sine": 0.01 * np.sin(0.5 * t),
        "steps": 0.01 * np.sign(np.sin(6.0 * t)),
        "walk": np.cumsum(rng.normal(size=n)) * 1e-5,
    }[kind]
    xdot = gain * np.gradient(x, t) + v_offset + v_noise * rng.normal(size=n)
    # Up to 50 ms; a longer mean loses most of the faster sine, which is a fault of the log.
    width = min(smoothing, int(0.05 * rate), n // 4)
    if width > 1:
        xdot = np.convolve(xdot, np.ones(width) / width, mode="same")
    x = x + x_noise * rng.normal(size=n)
    if quantum:
        x = np.round(x / quantum) * quantum
    check(t, x, xdot)


@given(seed=st.integers(0, 2**32 - 1), window=st.sampled_from([3, 5, 21, 101]))
@settings(max_examples=100, deadline=None)
def test_velocity_differentiated_from_pure_noise_is_never_accused(seed: int, window: int) -> None:
    from scipy.signal import savgol_filter

    x = np.random.default_rng(seed).normal(size=2000) * 1e-6
    t = np.arange(2000) * 1e-3
    check(t, x, savgol_filter(x, window, 1, deriv=1, delta=1e-3))
    check(t, x, np.gradient(x, t))


def test_one_glitch_in_x_and_xdot_is_not_accused() -> None:
    t = np.arange(5000) * 1e-3
    glitch = (np.arange(5000) == 2500) * 1.0
    check(t, np.cumsum(glitch) * 1e-3, 0.01 * (glitch + np.roll(glitch, 1)))


@pytest.mark.parametrize("speed", [0.0, 1e-6])
def test_a_constant_velocity_offset_over_a_creep_is_not_accused(speed: float) -> None:
    t = np.arange(5000) * 1e-3
    check(t, speed * t, np.full_like(t, 0.02))

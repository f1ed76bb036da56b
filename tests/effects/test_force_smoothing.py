"""Moving average of the force over a part of the motion's cycle."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from made import act, force, signals, sine
from places import SHARED
from rig import real
from scipy.signal import lfilter

from erdctl.core.blocks import Block, whole
from erdctl.diagnose.bounds import Bounds
from erdctl.diagnose.executor import Executor
from erdctl.effects import get
from erdctl.io.logs import read_logs

SMOOTHING = get("force_smoothing")


def test_check_value() -> None:
    # From t = 0 to 4 s; rms(x) = rms(xdot) = 1, so that T = 2 pi s and W = 2 s.
    x = np.array([1.0, -1.0, 1.0, -1.0, 0.0]) * np.sqrt(5 / 4)
    s = signals(np.ones(5), x=x, step=1.0)
    column = np.array([0.0, 4.0, 8.0, 0.0, 0.0])
    found = act("force_smoothing", column, s, {"w": 1 / np.pi})
    assert found == pytest.approx([0, 4, 5, 2, 0])


@pytest.mark.parametrize("rate", [401.0, 91.0])
@pytest.mark.parametrize(("frequency", "amplitude"), [(0.5, 0.02), (3.0, 0.004)])
def test_a_jump_becomes_a_ramp_of_the_same_phase(
    frequency: float, amplitude: float, rate: float
) -> None:
    """A square wave through a window of w cycles: 2 (phase of the turn) / w within the ramp."""
    s = sine(frequency, amplitude, 4.0 / frequency, rate * frequency)
    w = 0.2
    found = act("force_smoothing", np.sign(s.xdot), s, {"w": w})
    cycles = s.t * frequency  # x is largest a quarter of a cycle after the beginning
    after = (cycles - 0.25 + 0.25) % 0.5 - 0.25  # cycles since the nearest reversal
    ends = np.round((cycles - 0.25) * 2) % 2 == 0  # of compression, else of release
    ramp = np.clip(after / (w / 2), -1.0, 1.0)
    expected = np.where(ends, -ramp, ramp)
    inner = (cycles > w) & (cycles < 4.0 - w - 1 / rate)
    assert found[inner] == pytest.approx(expected[inner], abs=1e-3)


def test_straight_lines_stay() -> None:
    s = sine(1.0, 0.01, 3.0, 200.0)
    line = 5.0 - 3.0 * s.t
    assert act("force_smoothing", line, s, {"w": 0.15}) == pytest.approx(line)


def test_a_narrow_window_changes_little() -> None:
    s = sine(1.0, 0.01, 3.0, 210.0, duty=0.2)  # no sample at a turn
    plain, narrow = (force("force_smoothing", s, {"w": w}) for w in (0.0, 1e-6))
    assert narrow == pytest.approx(plain, abs=1e-3)


@settings(max_examples=60, deadline=None)
@given(
    w=st.floats(0.02, 0.45),
    frequencies=st.lists(st.floats(0.2, 4.0), min_size=1, max_size=3),
    jump=st.floats(0.0, 1.0),
    knee=st.floats(1e-4, 0.3),
    noise=st.sampled_from(["none", "white", "slow", "heavy"]),
    size=st.floats(0.001, 0.1),
    seed=st.integers(0, 2**16),
)
@example(
    w=0.25, frequencies=[2.0, 0.5, 0.5], jump=0.0, knee=0.25, noise="heavy", size=0.0625, seed=52
)  # an outlier in nearly every half cycle
def test_a_window_is_never_ruled_out_by_what_it_made(
    w: float, frequencies: list[float], jump: float, knee: float, noise: str, size: float, seed: int
) -> None:
    """Whatever the law, also one that jumps within the cycle, and whatever noise comes behind."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 12.0 / min(frequencies), 1.0 / (120.0 * max(frequencies)))[:20_000]
    phases = rng.uniform(0.0, 2 * np.pi, len(frequencies))
    x = sum(np.sin(2 * np.pi * f * t + p) / f for f, p in zip(frequencies, phases, strict=True))
    xdot = np.gradient(x, t)
    s = signals(xdot, x=x, step=t[1] - t[0])
    law = np.tanh(xdot / (knee * np.abs(xdot).max())) + 0.3 * xdot / np.abs(xdot).max()
    law = law + jump * np.sign(x - rng.uniform(-0.5, 0.5) * np.abs(x).max())
    e = rng.standard_t(2.5, len(t)) if noise == "heavy" else rng.standard_normal(len(t))
    e = lfilter([1.0], [1.0, -0.95], e) * np.sqrt(1 - 0.95**2) if noise == "slow" else e
    recorded = act("force_smoothing", law, s, {"w": w})
    recorded = recorded + (0.0 if noise == "none" else size * np.std(recorded)) * e
    allowed = SMOOTHING.allowed(s, recorded)
    assert allowed.get("force_smoothing.w", 1.0) >= 0.99 * w


def test_a_force_that_jumps_where_the_motion_turns_was_not_averaged() -> None:
    """As backlash and a stuck valve do; what is seen is at most the time of a sample."""
    s = sine(0.5, 0.02, 20.0, 200.0)
    jumping = 10.0 * np.sign(s.xdot) + 0.05 * np.random.default_rng(1).standard_normal(len(s))
    (most,) = SMOOTHING.allowed(s, jumping).values()
    assert most == pytest.approx(1.25 / (200.0 * 2.0), rel=0.05)


def test_an_average_over_less_than_two_samples_is_none() -> None:
    """In a car at 200 to 500 Hz (`tests/quarter_car.py`) windows of 1.3 to 2.3 samples were named:
    what they took was of the noise of the velocity, where the force is steep."""
    s = sine(2.0, 0.02, 20.0, 200.0)
    (least,) = SMOOTHING.resolved(s, s.x).values()
    assert least == pytest.approx(2.0 / 100.0, rel=0.01)  # of 100 samples in a cycle
    tried = Executor((), bounds=Bounds.of([SMOOTHING], Block(s, s.x, np.ones(len(s)))))
    possible = [tried.possible({"force_smoothing.w": w}) for w in (0.018, 0.022)]
    assert possible == [False, True]
    assert tried.possible({})
    assert SMOOTHING.resolved(signals(np.zeros(50)), np.zeros(50)) == {}


@pytest.mark.filterwarnings("error")
def test_a_record_of_one_sample_says_nothing_of_the_narrowest_window() -> None:
    s = sine(2.0, 0.02, 20.0, 200.0)
    n = len(s)
    one = signals(np.append(s.xdot, 0.1), x=np.append(s.x, 0.01), step=0.005, starts=[0, n, n + 1])
    (least,) = SMOOTHING.resolved(one, one.x).values()
    assert least == pytest.approx(2.0 / 100.0, rel=0.01)


def test_a_log_without_turns_rules_nothing_out() -> None:
    assert SMOOTHING.allowed(signals(np.ones(50)), np.arange(50.0)) == {}


@pytest.mark.real_data
def test_what_the_rig_smoothed_it_may_have_smoothed_and_what_it_did_not_not() -> None:
    """The rig's own script averages over 0.10 of a cycle, and `mr_raw` is before that."""
    allowed: dict[str, dict[str, float]] = {}
    for name in ("mr_sine", "mr_raw"):
        path = str(real(f"{name}.parquet", SHARED))
        block = whole(read_logs([path], need_force=True, report=lambda line: None).recording)
        allowed |= {name: SMOOTHING.allowed(block.signals, block.force)}
    assert 0.1 < allowed["mr_sine"]["force_smoothing.w"] < 0.2
    assert allowed["mr_raw"]["force_smoothing.w"] < 0.03


def test_rest_is_left_alone() -> None:
    s = signals(np.zeros(4))
    column = np.array([0.0, 4.0, 8.0, 8.0])
    assert act("force_smoothing", column, s, {"w": 0.3}) == pytest.approx(column)

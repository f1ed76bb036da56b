"""Play: by hand, against a fine sampling of the play operator, and its limits."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from made import PLAIN, act, force, signals, sine

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.model.composed import Model
from erdctl.model.recurrences import play


def test_check_value() -> None:
    """1 m/s up for 2 s, then down; g = 2 m, on the flank at first: x_p rises with x, then stays."""
    s = signals([1, 1, 1, -1, -1, -1], x=[0, 1, 2, 2, 1, 0], step=1.0)
    piston = act("backlash", s, {"g": 2.0})
    assert piston.x - piston.x[0] == pytest.approx([0, 1, 2, 2.25, 2.25, 2])
    assert piston.xdot == pytest.approx([1, 1, 1, 0, 0, -1])
    assert piston.sign == pytest.approx([1, 1, 1, 0, 0, -1])


def test_recurrence_check_value() -> None:
    s = signals([1, 1, -1, -1, -1, -1], step=1.0)
    lost, engaged = play(s.xdot, s.step, s.starts, s.compressing, s.rests, 2.2)
    assert lost == pytest.approx([1.1, 1.1, 0.85, -0.15, -1.1, -1.1])
    assert engaged == pytest.approx([1, 1, 0, 0, 0.75, 1])


def test_docstring_check_value() -> None:
    """x = 0, 1, 2, 1, 0 mm from the lower flank: the piston gives 0, 1, 2, 2, 2 mm."""
    t = np.linspace(0, 4, 4001)
    x = 1e-3 * np.where(t < 2, t, 4 - t)
    s = signals(np.where(t < 2, 1e-3, -1e-3), x=x, t=t)
    piston = act("backlash", s, {"g": 2e-3})
    assert 1e3 * (piston.x - piston.x[0])[::1000] == pytest.approx([0, 1, 2, 2, 2], abs=2e-3)


def test_begins_on_the_flank_of_its_first_motion() -> None:
    v = [0, -1, -1, 1, -1, 1, 1, 1]
    s = signals(v, x=np.cumsum(v) * 0.01, starts=[0, 5, 8])
    lost, _ = play(s.xdot, s.step, s.starts, s.compressing, s.rests, 0.1)
    assert lost[[0, 1, 5]] == pytest.approx([-0.05, -0.05, 0.05])


def test_begins_in_the_middle_from_rest() -> None:
    """A bench that starts up: nothing pushes the joint to either side."""
    t = np.arange(4000) * 1e-3
    ramp = np.clip((t - 0.2) / 0.5, 0.0, 1.0)
    for way in (1.0, -1.0):
        xdot = way * 0.1 * ramp * np.cos(6.0 * (t - 0.2))
        s = signals(xdot, x=np.cumsum(xdot) * 1e-3, t=t)
        assert s.rests.tolist() == [True]
        lost, engaged = play(s.xdot, s.step, s.starts, s.compressing, s.rests, 2e-3)
        assert lost[0] == 0.0
        assert engaged[0] == 0.0
        travelled = np.abs(s.x - s.x[0])
        assert engaged[(travelled < 0.9e-3) & (t < 0.4)].max() == 0.0
        assert engaged[(travelled > 1.2e-3) & (t < 0.4)].min() == 1.0


@pytest.mark.parametrize("phase", [0.0, 0.3, np.pi / 2, 2.0])
def test_a_motion_that_goes_on_does_not_begin_at_rest(phase: float) -> None:
    t = np.arange(4000) * 1e-3
    x, xdot = 0.01 * np.sin(6.0 * t + phase), 0.06 * np.cos(6.0 * t + phase)
    assert signals(xdot, x=x, t=t).rests.tolist() == [False]
    slow_first = 0.01 * np.sin(0.3 * t + 3.0 * t**2), 0.01 * np.cos(0.3 * t + 3.0 * t**2)
    xdot = slow_first[1] * (0.3 + 6.0 * t)
    assert signals(xdot, x=slow_first[0], t=t).rests.tolist() == [False]


@given(
    xdot=arrays(
        float, st.integers(4, 40), elements=st.floats(-1.0, 1.0).map(lambda v: round(v, 3))
    ),
    gap=st.floats(1e-3, 3.0),
)
def test_without_a_blur_a_sample_is_engaged_or_not(xdot: Array, gap: float) -> None:
    s = signals(xdot, step=1.0)
    blurred = play(s.xdot, s.step, s.starts, s.compressing, s.rests, gap)
    lost, engaged = play(s.xdot, s.step, s.starts, s.compressing, s.rests, gap, 0.0)
    assert np.array_equal(lost, blurred[0])
    part = (engaged > 0.0) & (engaged < 1.0)
    assert not part[(np.abs(blurred[1] - 0.5) > 1e-9)].any()
    whole = (blurred[1] == 0.0) | (blurred[1] == 1.0)
    assert np.array_equal(engaged[whole], blurred[1][whole])


@pytest.mark.parametrize("gap", [2e-5, 1e-4, 1e-3])
def test_force_equals_a_fine_sampling(gap: float) -> None:
    """Play operator sample by sample at 100 times the rate; they differ where contact closes."""
    fine = sine(1.3, 0.01, 6.0, 50_000.0, duty=0.3)
    y = np.empty(len(fine))
    y[0] = fine.x[0] - gap / 2
    for i, x in enumerate(fine.x.tolist()[1:], start=1):
        y[i] = min(max(y[i - 1], x - gap / 2), x + gap / 2)
    moved = np.diff(y, prepend=y[0])
    moved[0] = 1.0
    piston = fine.with_motion(y, np.where(moved * fine.xdot > 0, fine.xdot, 0.0))
    truth = Model().force(piston, PLAIN)[::100]
    found = force("backlash", sine(1.3, 0.01, 6.0, 500.0, duty=0.3), {"g": gap})
    wrong = np.abs(found - truth) > 0.05
    assert wrong.sum() <= 16  # reversals
    assert np.abs(found - truth).max() < 0.55 * np.ptp(truth) / 2 + 0.05


def test_noise_on_x_does_not_open_the_joint() -> None:
    s = sine(0.5, 0.01, 4.0, 1000.0)
    rough = s.x + 1e-4 * np.random.default_rng(1).standard_normal(len(s))
    still = act("backlash", s, {"g": 1e-4}).xdot
    assert np.array_equal(act("backlash", s.with_motion(rough, s.xdot), {"g": 1e-4}).xdot, still)


def test_force_goes_over_into_that_without_play() -> None:
    s = sine(1.3, 0.01, 4.0, 500.0, duty=0.3)
    off = force("backlash", s, {"g": 0.0})
    near = force("backlash", s, {"g": 1e-9})
    moving = np.abs(s.xdot) > 1e-6  # one sample falls on a turn: there no sign is right
    assert near[moving] == pytest.approx(off[moving], abs=1e-3 * np.ptp(off))


def test_a_piston_in_play_keeps_its_direction() -> None:
    s: Signals = act("backlash", signals([1, 1, -1, -1, -1, -1], step=1.0), {"g": 2.2})
    assert s.per_direction(10.0, 20.0) == pytest.approx([10, 10, 10, 10, 17.5, 20])
    assert get("backlash").equivalents == ()

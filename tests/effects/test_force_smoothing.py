"""Moving average of the force over a part of the motion's cycle."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, force, signals, sine


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


def test_rest_is_left_alone() -> None:
    s = signals(np.zeros(4))
    column = np.array([0.0, 4.0, 8.0, 8.0])
    assert act("force_smoothing", column, s, {"w": 0.3}) == pytest.approx(column)

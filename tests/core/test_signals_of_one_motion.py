"""What is derived from a motion is computed once for all controls of it, and never for another."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from rig import campaign

from erdctl.core.signals import Signals

DERIVED = [n for n, v in vars(Signals).items() if isinstance(v, cached_property)]


def test_another_control_has_the_same_motion() -> None:
    s = Signals.of(campaign(200.0, 2.0))
    other = s.with_duty(0.5 * s.duty).with_duty(0.25 * s.duty)
    assert other.motion is s
    assert other.path is s.path
    alone = Signals(s.t, s.x, s.xdot, 0.25 * s.duty, s.step, s.starts)
    for name in DERIVED:
        one, two = getattr(other, name), getattr(alone, name)
        parts = zip(one, two, strict=True) if isinstance(one, tuple) else [(one, two)]
        assert all(np.array_equal(a, b) for a, b in parts), name


def test_another_motion_is_another() -> None:
    s = Signals.of(campaign(200.0, 2.0))
    slow = s.with_duty(0.5 * s.duty).with_motion(0.5 * s.x, 0.5 * s.xdot)
    assert slow.motion is slow
    assert np.allclose(slow.path[0], 0.5 * s.path[0])
    assert np.array_equal(slow.since_duty_step, s.since_duty_step)

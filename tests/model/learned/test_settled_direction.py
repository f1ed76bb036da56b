"""What time and travel leave of the direction before a turn, against a fine solution."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.learned.coordinates import Memory, along

RATE, FINE = 500, 40  # Hz; steps of the fine solution in one


def turning(t: Array) -> tuple[Array, Array]:
    """Two tones: strokes of all sizes."""
    parts = ((0.006, 5.0, 0.3), (0.003, 17.0, 1.1))
    x = sum(a * np.sin(w * t + p) for a, w, p in parts)
    xdot = sum(a * w * np.cos(w * t + p) for a, w, p in parts)
    return np.asarray(x), np.asarray(xdot)


@pytest.mark.parametrize(("kind", "tau"), [("unsettled_time", 0.02), ("unsettled_way", 0.002)])
def test_it_follows_the_direction(kind: str, tau: float) -> None:
    t = np.arange(3 * RATE) / RATE
    x, xdot = turning(t)
    step = np.append(np.diff(t), 0.0)
    s = Signals(t=t, x=x, xdot=xdot, duty=0.0 * t, step=step, starts=np.array([0, len(t)]))
    found = along(kind, s, Memory(tau))

    fine = np.arange(len(t) * FINE) / (RATE * FINE)
    at, speed = turning(fine)
    way = np.sign(speed)
    gone = np.abs(np.diff(at)) if kind == "unsettled_way" else np.diff(fine)
    y, course = way[0], [way[0]]
    for i, part in enumerate(gone):
        y += (way[i + 1] - y) * -np.expm1(-part / tau)
        course.append(y)
    expected = 0.5 * (1.0 - way[::FINE] * np.array(course)[::FINE])
    assert expected.min() < 0.02
    assert expected.max() > 0.95
    assert np.sqrt(np.mean((found - expected) ** 2)) < 0.02

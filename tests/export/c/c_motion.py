"""Motions on which C is compared with Python."""

from __future__ import annotations

from functools import cache

import numpy as np
from places import FIXTURES

from erdctl.core.signals import Signals
from erdctl.io.logs import read_logs


@cache
def random_motion(seed: int = 3, n: int = 4000, step: float = 0.002) -> Signals:
    """A rough motion of two records with stops, steps and ramps of the duty, and uneven steps."""
    rng = np.random.default_rng(seed)
    t = np.cumsum(step * rng.uniform(0.6, 1.4, n))
    x, xdot = np.zeros(n), np.zeros(n)
    for w in rng.uniform(3.0, 40.0, 5):
        a, phase = 0.02 / w**0.7, rng.uniform(0.0, 6.3)
        x += a * np.sin(w * t + phase)
        xdot += a * w * np.cos(w * t + phase)
    held = rng.integers(100, n - 100, 4)
    for h in held:
        x[h : h + 40], xdot[h : h + 40] = x[h], 0.0
    duty = np.repeat(rng.choice([0.0, 0.1, 0.3, 0.45, 0.8, 1.0], n // 80 + 1), 80)[:n]
    swept = slice(n // 3, n // 2)
    duty[swept] = 0.4 + 0.4 * np.sin(5.0 * t[swept])
    starts = np.array([0, n // 2 + 7, n])
    dt = np.append(np.diff(t), 0.0)
    dt[starts[1:] - 1] = 0.0
    return Signals(t=t, x=x, xdot=xdot, duty=duty, step=dt, starts=starts)


@cache
def bench(name: str = "healthy_campaign") -> Signals:
    """A bundled log."""
    log = read_logs([str(FIXTURES / f"{name}.parquet")], need_force=True, report=lambda text: None)
    return Signals.of(log.recording)


def record(s: Signals, a: int, b: int) -> Signals:
    """The signals of samples a to b as one record."""
    step = s.step[a:b].copy()
    step[-1:] = 0.0
    return Signals(
        t=s.t[a:b], x=s.x[a:b], xdot=s.xdot[a:b], duty=s.duty[a:b], step=step,
        starts=np.array([0, b - a]),
    )  # fmt: skip

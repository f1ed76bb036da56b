"""Recordings for tests, made by the fixtures' independent solution of the equations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import oracle
import pytest
import trajectories
from scipy.signal import lfilter

from erdctl.core.recording import Array, Recording, concatenate

TRUTH = {
    f"{name}.{symbol}": getattr(branch, symbol)
    for name, branch in (
        ("compression", oracle.TABLE_2.compression),
        ("release", oracle.TABLE_2.release),
    )
    for symbol in ("k_nom", "c_vis", "T_d", "sigma", "beta")
}


def recording(
    t: Array,
    x: Array,
    xdot: Array,
    duty: Array,
    name: str = "r",
    velocity: Callable[[float], float] | None = None,
) -> Recording:
    """One record with the exact force of Table 2; `velocity` is xdot at any time, where known."""
    response = oracle.respond(t, x, xdot, duty, velocity=velocity)
    force = response.gas + response.viscous + response.yield_
    return Recording(
        t=t, x=x, xdot=xdot, duty=duty, force=force,
        starts=np.array([0, len(t)], dtype=np.intp), names=(name,),
    )  # fmt: skip


@cache
def campaign(rate: float = 200.0, duration: float = 12.0) -> Recording:
    """Null control, held levels and control steps, without noise."""
    random = np.random.default_rng(20)
    t = np.arange(int(duration * rate)) / rate
    out = []
    for i, (frequency, amplitude) in enumerate(((0.7, 0.02), (1.9, 0.01), (3.1, 0.006))):
        tones = trajectories.sine(frequency, amplitude, 0.3 * i)
        x, xdot = tones.x(t), tones.velocity(t)
        for level in (0.0, 0.1 + 0.1 * i):
            duty, name = np.full(len(t), level), f"{frequency}Hz-{level:.1f}"
            out.append(recording(t, x, xdot, duty, name, tones.velocity_at))
        tones = trajectories.mixed(random, 0.02, 0.15, duration)
        duty = trajectories.random_hold(random, t, (0.0, 0.1, 0.2, 0.3, 0.45))
        x, xdot = tones.x(t), tones.velocity(t)
        out.append(recording(t, x, xdot, duty, f"steps-{i}", tones.velocity_at))
    return concatenate(out)


def noisy(clean: Recording, seed: int, rms: float = 0.3, correlation: float = 0.0) -> Recording:
    """The recording with force noise; `correlation` is that of neighbouring samples."""
    white = np.random.default_rng(seed).standard_normal(len(clean))
    gain = np.sqrt(1.0 - correlation**2)
    noise = lfilter([gain], [1.0, -correlation], white) if correlation else white
    assert clean.force is not None
    return replace(clean, force=clean.force + rms * noise)


def every(r: Recording, count: int) -> Recording:
    """One sample of so many: a control that changes between two is seen at the second."""
    rows = np.concatenate([np.arange(part.start, part.stop, count) for part in r.slices])
    return r.take(rows, np.searchsorted(rows, r.starts), r.names)


def real(name: str, shared: Path) -> Path:
    """A real recording, or a skip that says what is missing."""
    path = shared / name
    if not path.exists():
        pytest.skip(f"the real recording {name} is not at hand (expected in ../shared/data)")
    return path


def gas_that_warms(r: Recording, stiffness: float, tau: float) -> Recording:
    """F + k (x - y), dy/dt = (x - y) / tau, y = x as a record begins: a gas that takes its time."""
    assert r.force is not None
    force = r.force.copy()
    for part in r.slices:
        x = r.x[part] - r.x[part][0]
        a = np.exp(-(r.t[1] - r.t[0]) / tau)
        mean = np.append(0.0, 0.5 * (x[1:] + x[:-1]))
        force[part] += stiffness * (x - lfilter([1.0 - a], [1.0, -a], mean))
    return replace(r, force=force)

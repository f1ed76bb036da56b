"""Signals that tests of single effects make by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.model.composed import Model

# A damper with equal parameters in both directions, so that a test's own equations stay short.
PLAIN = {
    f"{way}.{symbol}": value
    for way in ("compression", "release")
    for symbol, value in {
        "k_nom": 200.0, "c_vis": 70.0, "T_d": 0.04, "sigma": 20.0, "beta": 0.5,
    }.items()
}  # fmt: skip


def signals(
    xdot: Sequence[float] | Array,
    *,
    x: Sequence[float] | Array | None = None,
    duty: Sequence[float] | Array | float = 0.0,
    step: float = 0.01,
    t: Array | None = None,
    starts: Sequence[int] | None = None,
) -> Signals:
    """Signals from a velocity; x is 0 and the sampling even unless given."""
    v = np.asarray(xdot, dtype=float)
    n = len(v)
    bounds = [0, n] if starts is None else list(starts)
    recording = Recording(
        t=np.arange(n) * step if t is None else t,
        x=np.zeros(n) if x is None else np.asarray(x, dtype=float),
        xdot=v,
        duty=np.broadcast_to(np.asarray(duty, dtype=float), v.shape).copy(),
        starts=np.array(bounds, dtype=np.intp),
        names=tuple(str(i) for i in range(len(bounds) - 1)),
    )
    return Signals.of(recording)


def sine(
    frequency: float, amplitude: float, duration: float, rate: float, duty: float = 0.0
) -> Signals:
    """x = amplitude sin(2 pi f t) at constant duty."""
    t = np.arange(round(duration * rate)) / rate
    w = 2 * np.pi * frequency
    x, xdot = amplitude * np.sin(w * t), amplitude * w * np.cos(w * t)
    return signals(xdot, x=x, t=t, duty=duty)


def act(name: str, *arguments: Any) -> Any:
    """What the function of one effect returns."""
    return get(name).act(*arguments)


def unit_forces(name: str, s: Signals, p: Mapping[str, float]) -> Array:
    """The columns of one effect."""
    columns = get(name).columns
    assert columns is not None
    return columns(s, p)


def force(name: str, s: Signals, p: Mapping[str, float], **changed: float) -> Array:
    """Force of the damper of PLAIN with one effect; `changed` holds in both directions."""
    values = dict(PLAIN)
    for symbol, value in changed.items():
        values |= {f"compression.{symbol}": value, f"release.{symbol}": value}
    effect = get(name)
    model = Model((effect,))
    return model.force(s, values | {effect.key(symbol): value for symbol, value in p.items()})

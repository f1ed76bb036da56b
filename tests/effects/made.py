"""Signals that tests of single effects make by hand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from by_hand import signals

from erdctl.core.recording import Array
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
    slot: Any = get(name).slot
    return slot(*arguments)


def unit_forces(name: str, s: Signals, p: Mapping[str, float]) -> Array:
    """The columns of one effect."""
    return get(name).added(s, p)


def force(name: str, s: Signals, p: Mapping[str, float], **changed: float) -> Array:
    """Force of the damper of PLAIN with one effect; `changed` holds in both directions."""
    values = dict(PLAIN)
    for symbol, value in changed.items():
        values |= {f"compression.{symbol}": value, f"release.{symbol}": value}
    effect = get(name)
    model = Model((effect,))
    return model.force(s, values | {effect.key(symbol): value for symbol, value in p.items()})

"""The force behind a spring has no jump in the spring's own values: a fit would not get past it."""

from __future__ import annotations

import numpy as np
import pytest
from by_hand import signals
from made import PLAIN

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.model.composed import Model

SOFTEST = {"mount_compliance": ("s_m", 3e-4), "fluid_compressibility": ("s_f", 5e-4)}
JUMP = 1e-3  # of the range: a slope of this in a ten-billionth of the value is no slope


def motion(rng: np.random.Generator, rate: float) -> Signals:
    """Three sines, which stop and turn a piston behind a soft spring in every way."""
    t = np.arange(300) / rate
    f, a, phase = rng.uniform(0.5, 6.0, 3), rng.uniform(0.02, 0.3, 3), rng.uniform(0.0, 6.28, 3)
    xdot = (a[:, None] * np.cos(2 * np.pi * f[:, None] * t + phase[:, None])).sum(axis=0)
    x = np.concatenate([[0.0], np.cumsum(0.5 * (xdot[1:] + xdot[:-1]) / rate)])
    return signals(xdot, x=x, t=t, duty=rng.choice([0.0, 0.05, 0.3, 1.0]))


@pytest.mark.parametrize("seed", range(24))
@pytest.mark.parametrize("name", SOFTEST)
def test_no_jump(name: str, seed: int) -> None:
    """Of equal directions: one that the yield force takes from a sample on is a jump of its own."""
    rng = np.random.default_rng(seed)
    s = motion(rng, rng.choice([50.0, 200.0, 1000.0]))
    symbol, softest = SOFTEST[name]
    model, value = Model((get(name),)), softest * rng.uniform(0.02, 1.0)

    def force(part: float) -> Array:
        return model.force(s, PLAIN | {f"{name}.{symbol}": value * part})

    low, high, size, range_ = 0.9, 1.0, 0.0, float(np.ptp(force(1.0)))
    for _ in range(8):  # into the interval with the largest change, a sixteenth each time
        at = np.linspace(low, high, 17)
        changes = np.abs(np.diff([force(p) for p in at], axis=0)).max(axis=1)
        k = int(changes.argmax())
        low, high, size = at[k], at[k + 1], changes[k]
    assert size < JUMP * range_

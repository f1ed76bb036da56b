"""Effects that feed the force back, driven hard: the force stays what the physics can give."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rig import TRUTH

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.signals import Signals
from erdctl.effects import catalogue
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.slots import FeedbackSlot, SeriesSlot

COUPLED = [e for e in catalogue() if isinstance(e.slot, SeriesSlot | FeedbackSlot)]
SPRINGS = [e for e in COUPLED if isinstance(e.slot, SeriesSlot)]
FEEDBACKS = [e for e in COUPLED if isinstance(e.slot, FeedbackSlot)]
CHOICES = [(e,) for e in COUPLED] + list(product(SPRINGS, FEEDBACKS))


def hard(seed: int, rate: float) -> Signals:
    """Two records of shocks to 2 m/s, stops, and a duty that jumps over its whole range.

    Uneven steps, one record that begins in full motion, one at rest.
    """
    rng, n = np.random.default_rng(seed), 400
    step = rng.uniform(0.2, 1.8, 2 * n) / rate
    step[[n - 1, 2 * n - 1]] = 0.0
    held = np.repeat(rng.choice([-2.0, -0.5, 0.0, 1e-4, 0.5, 2.0], 2 * n // 8), 8)
    xdot = held + 0.05 * rng.standard_normal(2 * n) * (held != 0.0)
    xdot[n] = 0.0
    t, x = np.zeros(2 * n), np.zeros(2 * n)
    for a in (0, n):
        t[a + 1 : a + n] = np.cumsum(step[a : a + n - 1])
        mean = 0.5 * (xdot[a : a + n - 1] + xdot[a + 1 : a + n])
        x[a + 1 : a + n] = np.cumsum(mean * step[a : a + n - 1])
    duty = np.repeat(rng.choice([0.0, 0.05, 0.45, 1.0], 2 * n // 5), 5)
    return Signals(t, x, xdot, duty, step, np.array([0, n, 2 * n]))


def between(q: Quantity, part: float) -> float:
    """A value within the bounds, over decades where the scale is one of decades."""
    if q.scale is Scale.LOG:
        return float(np.clip(q.low * (q.high / q.low) ** part, q.low, q.high))
    return q.low + part * (q.high - q.low)


parts = st.sampled_from([0.0, 1.0]) | st.floats(0.0, 1.0)


@pytest.mark.untraced
@pytest.mark.parametrize("chosen", CHOICES, ids=lambda c: "+".join(e.name for e in c))
@settings(deadline=None, max_examples=60)
@given(
    part=st.lists(parts, min_size=6, max_size=6), seed=st.integers(0, 50),
    rate=st.sampled_from([20.0, 200.0, 5000.0]), T_d=st.sampled_from([0.0, 1e-4, 0.043, 5.0]),
    size=st.sampled_from([1e-3, 1.0, 1e4]),
)  # fmt: skip
def test_bounded_by_what_the_damper_can_give(
    chosen: tuple[Effect, ...], part: list[float], seed: int, rate: float, T_d: float, size: float
) -> None:
    """Gas, viscous and yield force at their largest, at once: no spring and no heat adds to it.

    A spring pushes no harder than the damper behind it does at the rod's fastest: beyond that the
    piston would outrun the rod, and the spring relax.
    """
    s = hard(seed, rate)
    values = {k: v * size if k.split(".")[1] in ("k_nom", "c_vis", "sigma") else v
              for k, v in TRUTH.items()}  # fmt: skip
    values |= {"compression.T_d": T_d, "release.T_d": T_d}
    free = [(e, q) for e in chosen for q in e.quantities]
    values |= {e.key(q.symbol): between(q, p) for (e, q), p in zip(free, part, strict=False)}
    force = Model(chosen).force(s, values)
    assert np.isfinite(force).all()

    def largest(symbol: str) -> float:
        return max(abs(values[f"{d}.{symbol}"]) for d in ("compression", "release"))

    # Half of a play may lie between rod and piston, and a thick film keeps it there.
    play = sum(v for k, v in values.items() if k.endswith("backlash.g"))
    bound = (
        largest("k_nom") * (np.abs(s.x).max() + play / 2) + largest("c_vis") * np.abs(s.xdot).max()
        + largest("sigma")
    )  # fmt: skip
    assert np.abs(force).max() <= 1.001 * bound

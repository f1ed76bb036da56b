"""Parameters that the data tell only together, also where one of them lies at its bound."""

from __future__ import annotations

import numpy as np
import oracle
import pytest
import trajectories

from erdctl.core.blocks import whole
from erdctl.core.recording import Recording, concatenate
from erdctl.effects import get
from erdctl.estimate.last_step import assess
from erdctl.estimate.least_squares import fit
from erdctl.model.composed import Model

FRICTION = "coulomb_friction.F_c"
YIELD = {f"{d}.{s}" for d in ("compression", "release") for s in ("sigma", "beta")}
MODEL = Model((get("coulomb_friction"),))


def bench(levels: tuple[float, ...], friction: float, seed: int) -> Recording:
    """Sines while the duty goes from level to level, with a dry friction."""
    rate, random = 200.0, np.random.default_rng(seed)
    t = np.arange(int(12 * rate)) / rate
    records = []
    for i, frequency in enumerate((0.7, 1.7, 2.9)):
        motion = trajectories.sine(frequency, 0.02 / frequency, 0.3)
        x, xdot = motion.x(t), motion.velocity(t)
        duty = np.array(levels)[(t // 0.83).astype(int) % len(levels)]
        exact = oracle.respond(t, x, xdot, duty, velocity=motion.velocity_at).force
        force = exact + friction * np.sign(xdot) + 0.3 * random.standard_normal(len(t))
        starts = np.array([0, len(t)], dtype=np.intp)
        names = (f"{i}",)
        records.append(
            Recording(t=t, x=x, xdot=xdot, duty=duty, force=force, starts=starts, names=names)
        )
    return concatenate(records)


@pytest.mark.parametrize("bounded", [False, True])
def test_a_friction_and_two_levels_of_duty_are_told_together(bounded: bool) -> None:
    """Four forces, five numbers: beta is told by none of them, wherever the friction stands."""
    block = whole(bench((0.12, 0.4), 2.0, 1))
    start = {n: q.start for n, q in MODEL.quantities.items()} | {FRICTION: 0.0 if bounded else 1.0}
    best = fit(MODEL, block, start=start, fixed=[FRICTION]).values
    ends = [FRICTION] if bounded else []
    found = assess(MODEL, [block], best, bounded=ends)
    assert len(found.flat) == 1
    assert set(found.flat[0]) == YIELD | {FRICTION}


@pytest.mark.parametrize("bounded", [False, True])
def test_three_levels_tell_them_apart(bounded: bool) -> None:
    block = whole(bench((0.05, 0.12, 0.4), 0.0, 1))
    start = {n: q.start for n, q in MODEL.quantities.items()} | {FRICTION: 0.0}
    best = fit(MODEL, block, start=start, fixed=[FRICTION]).values
    found = assess(MODEL, [block], best, bounded=[FRICTION] if bounded else [])
    assert found.flat == ()

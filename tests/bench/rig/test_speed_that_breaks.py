"""Triangles, ramps with dwells and steps of the speed, whose speed breaks within a sample."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from erdctl.bench.rig import look
from erdctl.core.recording import Array, Recording

N, FINE = 3000, 40  # samples; parts of a step in which the motion is made

SHAPES: dict[str, Callable[[Array], Array]] = {  # speed over the phase of a cycle, mean 0
    "triangle": lambda p: np.where(p < 0.5, 1.0, -1.0),
    "ramps with dwells": lambda p: np.select([p < 0.3, p < 0.5, p < 0.8], [1.0, 0.0, -1.0], 0.0),
    "out fast and back slowly": lambda p: np.where(p < 0.2, 1.0, -0.25),
    "two speeds each way": lambda p: np.select([p < 0.2, p < 0.5, p < 0.7], [1.0, 0.3, -1.0], -0.3),
}


def broken(shape: Callable[[Array], Array], seed: int) -> Recording:
    """20 to 200 samples a cycle; turns take up to five samples, or none."""
    random = np.random.default_rng(seed)
    h = 10 ** random.uniform(-3, -2)
    period, stroke = random.uniform(20, 200) * h, random.uniform(1e-3, 2e-2)
    rounded = max(1, int(random.uniform(0, random.integers(1, 6)) * FINE))
    fine = np.arange((N + 20) * FINE) * h / FINE
    speed = 2.0 * stroke / period * shape((fine / period + random.random()) % 1.0)
    total = np.concatenate([[0.0], np.cumsum(speed)])
    smooth = (total[rounded:] - total[:-rounded]) / rounded
    xdot, x = smooth[: N * FINE : FINE], np.cumsum(smooth)[: N * FINE : FINE] * h / FINE
    counts = stroke * 10 ** random.uniform(-4.5, -3)
    top = float(np.abs(xdot).max())
    force = 1e3 * xdot + 50.0 * np.sign(xdot) + random.standard_normal(N)
    return Recording(
        t=np.arange(N) * h, x=np.round(x / counts) * counts,
        xdot=xdot + 1e-4 * top * random.standard_normal(N), duty=np.zeros(N), force=force,
        starts=np.array([0, N]), names=("a",),
    )  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_is_no_fault_of_the_rig(shape: Callable[[Array], Array]) -> None:
    """Of 300 such triangles 66 had "samples lost", "spikes of x" or "a zero of xdot": x goes
    between two samples where their speeds do not say."""
    accused = {seed: look(broken(shape, seed)).lines() for seed in range(60)}
    assert {seed: lines for seed, lines in accused.items() if lines} == {}


def test_a_spike_and_a_loss_are_still_seen() -> None:
    r = broken(SHAPES["triangle"], 3)
    x = r.x.copy()
    x[700] += 0.02 * np.ptp(x)
    x[1500:] += 0.1 * np.ptp(r.x)
    codes = {f.code for f in look(Recording(**{**vars(r), "x": x})).faults}
    assert codes == {"x_spikes", "x_jumps"}

"""Triangles, ramps with dwells and steps of the speed, whose speed breaks within a sample."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from erdctl.bench.differentiation import derive_xdot
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


def without_xdot(shape: Callable[[Array], Array], seed: int) -> Recording:
    """The same with noise in x, and a velocity that is derived from it."""
    r = broken(shape, seed)
    random = np.random.default_rng(seed)
    x = r.x + np.ptp(r.x) * 10 ** random.uniform(-4.5, -2.7) * random.standard_normal(N)
    xdot, note = derive_xdot(r.t, x, r.starts)
    return replace(r, x=x, xdot=xdot, xdot_note=note)


def spikes(r: Recording) -> set[int]:
    """Samples that are left out for spikes of x."""
    at = [f.samples for f in look(r).faults if f.code == "x_spikes" and f.samples is not None]
    return {k for samples in at for k in samples.tolist()}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_a_corner_is_no_spike_where_the_velocity_is_derived(
    shape: Callable[[Array], Array],
) -> None:
    """Of 600 such logs 32 had "spikes of x, look at the cable", which were their corners."""
    accused = {seed: spikes(without_xdot(shape, seed)) for seed in range(60)}
    assert {seed: at for seed, at in accused.items() if at} == {}


def test_a_spike_beside_corners_is_one_where_the_velocity_is_derived() -> None:
    """At a corner, beside it, between two: none of 2 % was seen, nor three of those of 5 %."""
    t: Array = np.asarray(np.arange(1000) * 5e-3, dtype=np.float64)
    x = 0.014 * np.abs((t / 0.4) % 2.0 - 1.0)  # 80 samples from corner to corner
    x += 1e-5 * np.random.default_rng(1).standard_normal(len(t))
    places = ((240, 0.05), (241, 0.05), (243, 0.05), (243, 0.02), (403, 0.02), (522, 0.02))
    for at, by in places:
        for way in (-1.0, 1.0):
            spoilt = x.copy()
            spoilt[at] += way * by * 0.014
            xdot, note = derive_xdot(t, spoilt, np.array([0, len(t)]))
            r = Recording(
                t=t, x=spoilt, xdot=xdot, duty=np.zeros(len(t)), starts=np.array([0, len(t)]),
                names=("a",), xdot_note=note,
            )  # fmt: skip
            found = spikes(r)
            assert at in found, (at, way)
            assert found <= set(range(at - 5, at + 6)), (at, way)

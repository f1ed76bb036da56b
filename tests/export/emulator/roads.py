"""Rough random roads, as a damper feels them, and faults that come and go."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from by_hand import recording

from erdctl.core.recording import Recording
from erdctl.model.faults import FaultKind, effectiveness, parse_fault


def road(seed: int, *, step: float, duration: float = 15.0, switched: bool = False) -> Recording:
    """A body at 1.5 Hz and a wheel at 11 Hz on a random road, 0.15 m/s rms.

    switched : the healthy duty leaps at random, else it is 0.3
    """
    rng = np.random.default_rng(seed)
    t = np.arange(round(duration / step)) * step
    f = np.geomspace(0.7, 15.0, 60)
    body, wheel = 1.0 / (1.0 + ((f - 1.5) / 0.6) ** 2), 0.8 / (1.0 + ((f - 11.0) / 2.5) ** 2)
    a = (body + wheel + 0.1) * rng.rayleigh(1.0, len(f))
    w, phase = 2.0 * np.pi * f, t[:, None] * 2.0 * np.pi * f + rng.uniform(0.0, 2.0 * np.pi, len(f))
    scale = 0.15 / np.std(np.cos(phase) @ a)
    levels = rng.choice([0.05, 0.1, 0.2, 0.3, 0.4], len(t) // 300 + 1)
    duty = np.repeat(levels, 300)[: len(t)] if switched else np.full(len(t), 0.3)
    return recording(scale * np.cos(phase) @ a, x=scale * np.sin(phase) @ (a / w), duty=duty, t=t)


def factors_over(r: Recording, faults: Sequence[str]) -> dict[str, Any]:
    """(n,) factor of each fault, by its short name."""
    found = {k: np.ones(len(r.t)) for k in FaultKind}
    for fault in map(parse_fault, faults):
        found[fault.kind] *= effectiveness(fault, r.t, r.xdot, r.starts)
    return {k.short: f for k, f in found.items()}

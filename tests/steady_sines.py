"""A damper under sines, each with one duty, by hand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product

import numpy as np
from by_hand import recording

from erdctl.core.recording import Array, Recording

SAMPLES = 800  # of a record, at 200 Hz


def steady_sines(
    levels: Sequence[float],
    motions: Sequence[tuple[float, float]],
    force: Callable[[Array, Array, Array], Array],
    noise: float,
    spread: float = 0.0,
) -> Recording:
    """Every level of the duty [1] by every motion [Hz], [m].

    force : of x, xdot and duty [N];  noise : of the force [N];  spread : of its gain from one
        record to another [1]
    """
    random, t = np.random.default_rng(2), np.arange(SAMPLES) / 200.0
    parts = []
    for level, (f, size) in product(levels, motions):
        x, v = (size * g(2 * np.pi * f * t) for g in (np.sin, np.cos))
        v *= 2 * np.pi * f
        u = np.full(len(t), level)
        F = force(x, v, u) * (1.0 + spread * random.standard_normal())
        parts.append((v, x, u, F + noise * random.standard_normal(len(t))))
    v, x, u, F = (np.concatenate(c) for c in zip(*parts, strict=True))
    n = len(parts)
    starts = [SAMPLES * k for k in range(n + 1)]
    return recording(v, x=x, duty=u, force=F, t=np.tile(t, n), starts=starts)

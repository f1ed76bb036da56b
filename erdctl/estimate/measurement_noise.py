"""Measurement noise of a residual: what motion and control do not predict of it.

A misfit comes back whenever the damper comes back to the same state; noise does not. So two samples
in nearly the same state, but seconds apart, differ by noise alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from erdctl.core.blocks import Block, sample
from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals

SAMPLES, MOST = 8_000, 40_000  # that are compared, and among which they are chosen
NEIGHBOURS = 24  # among which those of other stretches are looked for
USED = 2  # of these, the nearest
CLOSEST = 0.3  # part of the pairs, the nearest: between distant states a misfit changes
APART = 0.5  # s from which noise has forgotten itself; diagnose leaves out stretches of 0.8 s
SLOW = 0.5  # weight of the time in the record: heat and drift come back later or never
LAG = 0.02  # s
SINCE = 1.0  # s, of times since an event


def of_recording(recording: Recording, modelled: Array) -> float:
    """Noise of a recording's force beside a model of it (n,) [N]."""
    if recording.force is None:
        raise ValueError("the recording has no measured force")
    rest = replace(recording, force=recording.force - modelled)
    block = sample(rest, MOST)
    return measurement_noise(block, block.force)


def measurement_noise(block: Block, residual: Array) -> float:
    """Standard deviation of the noise in a residual (n,) of a block [N].

        s = 1.4826 median |r_i - r_j| / sqrt(2)

    over pairs i, j that are nearest in x, xdot, its past, duty, the times since a reversal and a
    duty step, and the time in the record, each over its spread, and come from different stretches.
    Never more than the residual's own root mean square.
    Source: D. Evans, A. J. Jones, Proc. R. Soc. Lond. A 458 (2002) 2759-2799 (the Gamma test), with
    the median, since a misfit has edges.
    """
    used = np.flatnonzero(block.weight > 0)
    if len(used) < 2 * NEIGHBOURS:
        return _rms(residual[used])
    chosen = used[:: max(1, len(used) // SAMPLES)]
    states, stretch = _states(block.signals, chosen)
    from scipy.spatial import cKDTree

    away, near = cKDTree(states).query(states, k=min(NEIGHBOURS, len(chosen)))
    r = residual[chosen]
    apart = stretch[near] != stretch[:, None]
    order = np.cumsum(apart, axis=1)
    i, k = np.nonzero(apart & (order <= USED))
    if len(i) < NEIGHBOURS:
        return _rms(r)
    distance = away[i, k]
    closest = distance <= np.quantile(distance, CLOSEST)
    i, k = i[closest], k[closest]
    differences = np.abs(r[i] - r[near[i, k]])
    return min(float(1.4826 * np.median(differences) / np.sqrt(2.0)), _rms(r))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0


def _states(s: Signals, chosen: np.ndarray) -> tuple[Array, np.ndarray]:
    """(m, p) states of chosen samples, each over its spread, and (m,) their stretches."""
    start = np.repeat(s.starts[:-1], np.diff(s.starts))
    back = max(1, round(LAG / (s.typical_step or 1.0)))
    before = np.maximum(chosen - back, start[chosen])
    elapsed = s.t - s.t[start]
    columns = [
        s.x[chosen], s.xdot[chosen], s.xdot[before], s.sign[chosen],
        s.duty[chosen], s.duty[before], SLOW * elapsed[chosen] / max(float(elapsed.std()), 1e-12),
        np.minimum(s.since_reversal[chosen], SINCE), np.minimum(s.since_duty_step[chosen], SINCE),
    ]  # fmt: skip
    out = []
    for c in columns:
        spread = float(c.std())
        if spread > 0:
            out.append(c / spread if c is not columns[6] else c)
    record = np.searchsorted(s.starts, chosen, side="right")
    stretch = record * 1_000_000 + (elapsed[chosen] / APART).astype(np.intp)
    return np.column_stack(out), stretch

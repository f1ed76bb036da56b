"""Whether a parameter changes at all: the largest of many tests, and what chance makes of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from erdctl.compare.history import Flags
from erdctl.compare.shape import bend_edges, step_edges
from erdctl.core.recording import Array

CLIP = 3.0  # spreads to which a single log counts: two outliers at the end must be no change


@dataclass(frozen=True)
class Scan:
    """The test that speaks most for a change.

    statistic : t, of the best step, ramp or line;  p : of no change, all places looked at counted
    """

    statistic: float
    p: float


def scan(t: Array, value: Array, spread: Array) -> Scan:
    """Test a constant against a step, a bend or a line, anywhere.

    t : (n,) ascending [days];  value, spread : (n,) of each log
    The errors are only relative weights, what is left of the values themselves is the measure; a
    value counts as at most `CLIP` spreads from the middle. Neighbours that resemble each other
    (weather, mounting) count as fewer logs. The places are many and alike, and are counted as if
    they were not (Bonferroni): p is too large rather than too small.
    """
    n = len(t)
    shapes = np.concatenate([_steps(t), _ramps(t)])
    if n < 4 or not len(shapes):
        return Scan(0.0, 1.0)
    weight = spread**-2.0 / np.mean(spread**-2.0)
    middle = float(np.median(value))
    clipped = np.clip((value - middle) / spread, -CLIP, CLIP) * spread
    y = clipped - np.average(clipped, weights=weight)
    g = shapes - np.average(shapes, axis=1, weights=weight)[:, None]
    total = float(weight @ y**2)
    if total <= 0.0:
        return Scan(0.0, 1.0)
    size = (g**2) @ weight
    told = size > 1e-12 * size.max()
    share = np.where(told, (g @ (weight * y)) ** 2 / np.where(told, size, 1.0) / total, 0.0)
    best = int(share.argmax())
    r2 = min(float(share[best]), 1.0 - 1e-15)
    slope = float(g[best] @ (weight * y)) / float(size[best])
    alike = _neighbours((y - slope * g[best]) * np.sqrt(weight))
    statistic = np.sqrt(r2 / (1.0 - r2) * (n - 2) * (1.0 - alike) / (1.0 + alike))
    p = 2.0 * len(shapes) * float(stats.t.sf(statistic, n - 2))
    return Scan(float(statistic), min(1.0, p))


def appears(named: Flags) -> float:
    """p of no change in how often an effect is named, over all places in the order of time.

    named : (n,);  by the hypergeometric distribution, which holds for any share of logs that name
    it by chance; every place and both directions are counted.
    Check: of 4 logs the last 2 name it. One of the 6 ways to choose 2 of 4 has both at the end; of
    3 places and 2 directions p is 3 x 2 / 6 = 1. Of 20 logs the last 10: 19 x 2 / 184756, which is
    2.1 in 10000.
    >>> appears(np.array([False, False, True, True]))
    1.0
    >>> round(1e4 * appears(np.arange(20) >= 10), 1)
    2.1
    """
    n, k = len(named), int(named.sum())
    if not 0 < k < n:
        return 1.0
    after = np.cumsum(named[::-1])[::-1][1:]  # named among the last n - 1, n - 2, ..., 1
    lasts = np.arange(n - 1, 0, -1)
    more = stats.hypergeom.sf(after - 1, n, k, lasts)
    fewer = stats.hypergeom.cdf(after, n, k, lasts)
    return float(min(1.0, 2.0 * (n - 1) * min(more.min(), fewer.min())))


def _steps(t: Array) -> Array:
    return np.array([t > edge for edge in step_edges(t)], dtype=float).reshape(-1, len(t))


def _ramps(t: Array) -> Array:
    edges = [t[0], *bend_edges(t)] if t[-1] > t[0] else []
    return np.array([np.maximum(t - edge, 0.0) for edge in edges]).reshape(-1, len(t))


def _neighbours(rest: Array) -> float:
    """Correlation of a log's rest with the next one's, 0 to 0.9; outliers clipped, too."""
    scale = float(np.median(np.abs(rest))) * 1.4826
    z = np.clip(rest, -3 * scale, 3 * scale) if scale > 0.0 else rest
    z = z - z.mean()
    square = float(z @ z)
    return float(np.clip(z[1:] @ z[:-1] / square, 0.0, 0.9)) if square > 0.0 else 0.0

"""Where a misfit lives: over each of the contract's variables, the interval in which most of its
energy lies although the log spends little of its time there; of deflection and speed also two, one
on either side, as of what grows towards both ends of the stroke or with speed either way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.plant.refit import Joined

Array = npt.NDArray[np.float64]

CELLS = 200  # of equal numbers of samples
LEAST_SHARE = 0.5  # of the energy that a region must hold
LEAST_EXCESS = 0.25  # of that share over the share of the samples
MOST_WIDTH = 0.6  # of the variable's range
SECOND = 0.1  # of that excess by which two intervals are more than one
NEAR = 2  # samples next to a reversal


@dataclass(frozen=True)
class MisfitRegion:
    """share : of the misfit's energy;  time : of the samples;  width : of the variable's range."""

    variable: str
    low: float
    high: float
    share: float
    time: float
    width: float


def variables(samples: Joined, force: Array) -> dict[str, Array]:
    """(n,) of each variable of the contract; nan where it has no value yet."""
    n = len(samples.x)
    names = ("t", "since_reversal", "since_duty_step", "dissipated_energy")
    out = {"xdot": samples.v, "x": samples.x, "duty": samples.duty}
    out.update({name: np.full(n, np.nan) for name in names})
    dt = samples.dt
    power = np.maximum(force * samples.v, 0.0) * dt
    for a, b in zip(samples.starts[:-1], samples.starts[1:], strict=True):
        at = slice(a, b)
        t = dt * np.arange(b - a)
        out["t"][at] = t
        out["since_reversal"][at] = _since(t, turns(samples.v[at]))
        steps = np.concatenate([[False], np.diff(samples.duty[at]) != 0])
        out["since_duty_step"][at] = _since(t, steps)
        out["dissipated_energy"][at] = np.cumsum(power[at])
    return out


def turns(v: Array) -> npt.NDArray[np.bool_]:
    """(n,) first sample in a new direction."""
    s = np.sign(v)
    return np.concatenate([[False], s[1:] * s[:-1] < 0])


def _since(t: Array, events: npt.NDArray[np.bool_]) -> Array:
    last = np.maximum.accumulate(np.where(events, t, -np.inf))
    return np.where(np.isfinite(last), t - last, np.nan)


def near_reversals(samples: Joined, misfit: Array) -> float:
    """Share of the misfit's energy within two samples of a change of sign of xdot."""
    total = float(np.sum(misfit**2))
    if total == 0.0:
        return 0.0
    close = np.zeros(len(misfit), dtype=bool)
    for a, b in zip(samples.starts[:-1], samples.starts[1:], strict=True):
        first = a + np.flatnonzero(turns(samples.v[a:b]))
        for k in range(-NEAR, NEAR):
            close[np.clip(first + k, a, b - 1)] = True
    return float(np.sum(misfit[close] ** 2)) / total


def regions(samples: Joined, force: Array, misfit: Array) -> tuple[MisfitRegion, ...]:
    """Regions of a misfit (n,) [N], the tightest first; none if it lies everywhere."""
    energy = misfit**2
    total = float(energy.sum())
    if total == 0.0:
        return ()
    found = []
    for name, value in variables(samples, force).items():
        whole = _sharpest(name, value, energy, total, np.isfinite(value))
        if whole is None:
            continue
        two = _either_side(whole, value, energy, total) if name in ("x", "xdot") else []
        for places in (two, [whole]):
            if _points(places):
                found += places
                break
    return tuple(sorted(found, key=lambda r: r.time - r.share))


def _points(places: Sequence[MisfitRegion]) -> bool:
    share, time, width = (sum(getattr(r, of) for r in places) for of in ("share", "time", "width"))
    enough: bool = share >= max(LEAST_SHARE, time + LEAST_EXCESS)
    return enough and 0.0 < width <= MOST_WIDTH


def _either_side(
    whole: MisfitRegion, value: Array, energy: Array, total: float
) -> list[MisfitRegion]:
    """The best interval on either side of rest, or of the middle of the stroke, if the two have
    more than the best one of all."""
    middle = 0.0 if whole.variable == "xdot" else float(value.min() + value.max()) / 2
    sides = (value < middle, value > middle)
    found = [_sharpest(whole.variable, value, energy, total, side) for side in sides]
    two = [r for r in found if r is not None]
    return two if sum(r.share - r.time for r in two) >= whole.share - whole.time + SECOND else []


def _sharpest(
    name: str, value: Array, energy: Array, total: float, known: npt.NDArray[np.bool_]
) -> MisfitRegion | None:
    """The interval of some samples whose part of the energy most exceeds its part of the time."""
    u, e = value[known], energy[known]
    if len(u) < CELLS:
        return None
    low_end, high_end = np.quantile(value[np.isfinite(value)], [0.002, 0.998])
    if high_end <= low_end:
        return None
    edges = np.unique(np.quantile(u, np.linspace(0, 1, CELLS + 1)))
    if len(edges) < 3:
        return None
    cell = np.clip(np.searchsorted(edges, u, side="right") - 1, 0, len(edges) - 2)
    share = np.bincount(cell, e, len(edges) - 1) / total
    time = np.bincount(cell, minlength=len(edges) - 1) / len(energy)
    a, b = _most(share - time)
    low, high = float(edges[a]), float(edges[b])
    width = (min(high, high_end) - max(low, low_end)) / (high_end - low_end)
    return MisfitRegion(
        name, low, high, float(share[a:b].sum()), float(time[a:b].sum()), float(width)
    )


def _most(excess: Array) -> tuple[int, int]:
    """Bounds of the run of cells with the largest sum (Kadane)."""
    best, at, total, begin = -np.inf, (0, 1), 0.0, 0
    for k, value in enumerate(excess):
        if total <= 0.0:
            total, begin = 0.0, k
        total += float(value)
        if total > best:
            best, at = total, (begin, k + 1)
    return at


def overlap(a: MisfitRegion, b: tuple[float, float]) -> float:
    """Intersection over union of two intervals of one variable.

    Check: 0..2 and 1..3 give 1/3 = 0.3333.
    >>> found = MisfitRegion("x", low=0.0, high=2.0, share=0.9, time=0.2, width=0.2)
    >>> round(overlap(found, (1.0, 3.0)), 4)
    0.3333
    """
    inter = max(0.0, min(a.high, b[1]) - max(a.low, b[0]))
    union = max(a.high, b[1]) - min(a.low, b[0])
    return inter / union if union > 0 else 0.0

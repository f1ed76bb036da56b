"""Intervals beside errors: where the cost is no parabola, and at bounds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.core.workers import ahead
from erdctl.estimate.carried import along, beyond, is_wide
from erdctl.estimate.covariance import Fit
from erdctl.estimate.finer import MOST_SAMPLES, Finer
from erdctl.estimate.profile import Linear, interval, others, parabolic, widened
from erdctl.estimate.profile_cost import ProfileData, Refitted, followed
from erdctl.model.parameters import NORMAL_95

GUESS = 1e-3  # of a value or a start, where there is no error to begin with


def with_intervals(
    found: Fit,
    blocks: Sequence[Block],
    finer: Sequence[Finer],
    plain: Array,
    bounded: Sequence[str] = (),
    fixed: Iterable[str] = (),
    progress: Progress = lambda stage, what: None,
    threads: int = 1,
) -> Fit:
    """The fit with intervals of effects' parameters that the cost is no parabola of.

    plain : (p,) variances that noise of unit variance would make, for where each is told from
    bounded : parameters at a bound, which are not free;  fixed : names that keep their value
    Where a profile finds a better value, the fit has it.
    """
    model, free = found.model, found.free
    sizes = {e.key(q.symbol) for e in model.effects for q in e.sizes}
    together = {n for group in found.flat if len(group) > 1 for n in group}
    asked = [
        n for n in free
        if n.split(".")[0] not in DIRECTIONS and n not in sizes and n not in together
    ]  # fmt: skip
    bounded = [n for n in bounded if n not in sizes and n not in together]
    if not (asked or bounded) or sum(len(b.force) for b in blocks) > MOST_SAMPLES:
        return found
    if any(e.smooth for e in model.effects):
        return found  # whose many sizes would be searched anew at every point of every profile
    data, values = ProfileData.of(found, blocks, finer), dict(found.values)
    own = _Own(data, data.rows(values), blocks, plain, frozenset(fixed))
    intervals: dict[str, tuple[float, float]] = {}
    carried: list[tuple[Refitted, Sequence[float]]] = []
    names = waiting = [*asked, *bounded]
    anew = False
    while waiting:
        at, number = values, 0
        profiles = ahead(partial(own.profile, values=at), waiting, threads)
        with closing(profiles):
            for number, name in enumerate(waiting, start=len(names) - len(waiting) + 1):
                progress("intervals", part_of(name, number, len(names)))
                profile = next(profiles)
                if profile is None:
                    continue
                if profile.refitted is not None:
                    carried.append((profile.refitted, profile.points))
                if profile.best != values[name]:
                    moved = {**values, name: profile.best}
                    # The others' step is a leap where a slope holds no farther than the step.
                    up = data.taken_up(moved, name, profile.rest)
                    values = data.best(values, (up, moved))
                low, high = min(profile.low, values[name]), max(profile.high, values[name])
                intervals[name] = low, high
                if values is not at:  # what comes now begins from there
                    break
        waiting = names[number:]
        if not waiting and not anew:
            # A later one may have moved them, to where their own profiles have not been.
            waiting = [n for n, (a, b) in intervals.items() if not a <= values[n] <= b]
            anew, names = True, [*names, *waiting]
    intervals = {n: (min(a, values[n]), max(b, values[n])) for n, (a, b) in intervals.items()}
    flat = tuple(g for g in found.flat if g[0] not in intervals)
    found = replace(found, values=values, intervals=intervals, flat=flat)
    return _carried_along(found, carried, plain, asked, threads)


@dataclass(frozen=True, eq=False)
class _Profile:
    """Where the cost along one parameter is least, and where it ends an interval.

    rest : what the others can take up;  refitted, points : a profile along which the others may go
        far, and values from end to end of it
    """

    rest: Linear
    best: float
    low: float
    high: float
    refitted: Refitted | None
    points: Sequence[float]


@dataclass(frozen=True, eq=False)
class _Own:
    """Profiles of single parameters of a fit.

    rows, plain, fixed : see `ProfileData.rows` and `with_intervals`
    """

    data: ProfileData
    rows: Array
    blocks: Sequence[Block]
    plain: Array
    fixed: frozenset[str]

    def profile(self, name: str, values: dict[str, float]) -> _Profile | None:
        """Along one parameter from some values of all; None where the cost is a parabola."""
        found, data = self.data.found, self.data
        free, robust = found.free, np.diag(found.covariance)
        q, at = found.model.quantities[name], [i for i, n in enumerate(free) if n == name]
        rest, own = others(self.rows, free, name), _noise(robust[at], self.plain[at])
        usual = _noise(robust, self.plain)
        phi = max(own, usual) if np.isfinite(own) else usual
        if not np.isfinite(phi):
            return None
        cost = followed(data, values, name, rest, phi)
        error = float(np.sqrt(max(robust[at[0]], 0.0))) if at else 0.0
        if parabolic(cost, q, values[name], error):
            return None
        if not (error > 0.0 and np.isfinite(error)):
            # Of a value of 0 without a start nothing says how far to look but what it does.
            error = GUESS * max(abs(values[name]), q.start) or data.step(values, name, phi)
        if not error > 0.0:
            return None
        best, low, high = interval(cost, q, values[name], NORMAL_95 * error)
        points: list[float] = []
        again = None
        if len(self.blocks) == 1:
            again = Refitted(data, self.blocks[0], values, name, rest, phi, self.fixed)
            low, high = widened(again, q, best, low, high)
            if is_wide(best, low, high):
                points = [best, *along(q, best, low, high)]
                for value in points:
                    again(value)
        return _Profile(rest, best, low, high, again if points else None, points)


def _carried_along(
    found: Fit,
    carried: Sequence[tuple[Refitted, Sequence[float]]],
    plain: Array,
    searched: Sequence[str],
    threads: int = 1,
) -> Fit:
    """The fit with intervals of what follows others along wide profiles, see `carried`.

    What the data tell only together has none, and what had one keeps at least that.
    """
    robust, usual = np.diag(found.covariance), _noise(np.diag(found.covariance), plain)
    phi, reach = {}, {}
    for i, name in enumerate(found.free):
        own = _noise(robust[[i]], plain[[i]])
        phi[name] = own if np.isfinite(own) else usual
        reach[name] = NORMAL_95 * float(np.sqrt(max(robust[i], 0.0)))
    together, intervals = {n for group in found.flat for n in group}, dict(found.intervals)

    def of_others(wide: tuple[Refitted, Sequence[float]]) -> dict[str, tuple[float, float]]:
        return wide[0].ends_of_others(found.values, wide[1], phi, searched)

    for ends in ahead(of_others, carried, threads):
        ends = {n: e for n, e in ends.items() if n not in together}
        for n, (low, high) in beyond(ends, reach, found.values, found.model.quantities).items():
            had = intervals.get(n, (low, high))
            intervals[n] = (min(low, had[0]), max(high, had[1]))
    return replace(found, intervals=intervals)


def _noise(robust: Array, plain: Array) -> float:
    """Variance of the noise as it counts for some parameters [N^2]."""
    known = (plain > 0.0) & (robust > 0.0)
    return float(np.median(robust[known] / plain[known])) if known.any() else float("nan")

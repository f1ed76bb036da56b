"""Intervals beside errors: where the cost is no parabola, and at bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.progress import Progress, told
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.estimate.carried import along, beyond, is_wide, reached
from erdctl.estimate.covariance import Fit
from erdctl.estimate.finer import MOST_SAMPLES, Finer
from erdctl.estimate.least_squares import fit
from erdctl.estimate.linearisation import linearised
from erdctl.estimate.profile import Linear, interval, others, parabolic, widened
from erdctl.model.parameters import NORMAL_95
from erdctl.model.slots import Values

OUTLYING = 2.0  # standard deviations of the noise: no single sample rises beyond 1.96^2
ROUNDING = 1e-4  # of the force, below which nothing is told apart
REFITS = 12  # evaluations of a search for all other parameters
SETTLED = 1e-4  # of the rise that ends an interval: a step that gains less ends such a search
# Part of all samples that may be farther off where the others leave less: next to turns. Where a
# misfit is left, a sixth of them lies beyond the limit, and is no single samples.
SINGLE = 0.01
GUESS = 1e-3  # of a value or a start, where there is no error to begin with


def with_intervals(
    found: Fit,
    blocks: Sequence[Block],
    finer: Sequence[Finer],
    plain: Array,
    bounded: Sequence[str] = (),
    fixed: Iterable[str] = (),
    progress: Progress = lambda stage, what: None,
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
    data, values = _Data.of(found, blocks, finer), dict(found.values)
    intervals: dict[str, tuple[float, float]] = {}
    rows = data.rows(values)
    robust = np.diag(found.covariance)
    usual = _noise(robust, plain)
    carried: list[_Refitted] = []
    for name in told([*asked, *bounded], progress, "intervals"):
        q, at = model.quantities[name], [i for i, n in enumerate(free) if n == name]
        rest, own = others(rows, free, name), _noise(robust[at], plain[at])
        phi = max(own, usual) if np.isfinite(own) else usual
        if not np.isfinite(phi):
            continue
        cost = _along(data, values, name, rest, phi)
        error = float(np.sqrt(max(robust[at[0]], 0.0))) if at else 0.0
        if parabolic(cost, q, values[name], error):
            continue
        if not (error > 0.0 and np.isfinite(error)):
            # Of a value of 0 without a start nothing says how far to look but what it does.
            error = GUESS * max(abs(values[name]), q.start) or data.step(values, name, phi)
        if not error > 0.0:
            continue
        best, low, high = interval(cost, q, values[name], NORMAL_95 * error)
        if len(blocks) == 1:
            again = _Refitted(data, blocks[0], values, name, rest, phi, frozenset(fixed))
            low, high = widened(again, q, best, low, high)
            if is_wide(best, low, high):
                for value in along(q, best, low, high):
                    again(value)
                carried.append(again)
        if best != values[name]:
            moved = {**values, name: best}
            # The others' step is a leap where a slope holds no farther than the step is long.
            values = data.best(values, (data.taken_up(moved, name, rest), moved))
        intervals[name] = (min(low, values[name]), max(high, values[name]))
    flat = tuple(g for g in found.flat if g[0] not in intervals)
    found = replace(found, values=values, intervals=intervals, flat=flat)
    return _carried_along(found, carried, plain, asked)


def _carried_along(
    found: Fit, carried: Sequence[_Refitted], plain: Array, searched: Sequence[str]
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
    for again in carried:
        ends = again.ends_of_others(found.values, phi, searched)
        ends = {n: e for n, e in ends.items() if n not in together}
        for n, (low, high) in beyond(ends, reach, found.values, found.model.quantities).items():
            had = intervals.get(n, (low, high))
            intervals[n] = (min(low, had[0]), max(high, had[1]))
    return replace(found, intervals=intervals)


def farthest(residual: Array, root: Array, measured: Array) -> float:
    """Residual beyond which a sample holds more than noise [N].

    A contact that falls to the other side of one sample is no noise, and must not decide against
    what all others tell: it counts as if it were no larger.
    """
    size = np.abs(residual[root > 0.0])
    if not size.size:
        return np.inf
    least = ROUNDING * float(np.abs(measured).max())
    return max(OUTLYING * 1.4826 * float(np.median(size)), least)


def _noise(robust: Array, plain: Array) -> float:
    """Variance of the noise as it counts for some parameters [N^2]."""
    known = (plain > 0.0) & (robust > 0.0)
    return float(np.median(robust[known] / plain[known])) if known.any() else float("nan")


@dataclass(frozen=True, eq=False)
class _Data:
    """What a fit was to: (n,) measured force [N] and roots of the weights, over all blocks.

    limit : see `farthest`
    """

    found: Fit
    finer: Sequence[Finer]
    measured: Array
    root: Array
    limit: float

    @classmethod
    def of(cls, found: Fit, blocks: Sequence[Block], finer: Sequence[Finer]) -> _Data:
        root = np.sqrt(np.concatenate([b.weight for b in blocks]))
        measured = np.concatenate([b.force for b in blocks])
        # A sample that may be engaged in part takes up its own noise: one value of a play fits it
        # best, and next to it none, where all that contacts tell is on which side a sample is.
        out = cls(found, [f.sharp for f in finer], measured, root, np.inf)
        rest = measured - out.force(found.values)
        return replace(out, limit=farthest(rest, root, measured))

    def force(self, values: Values) -> Array:
        """(n,) [N]."""
        return np.concatenate([f.force(self.found.model, values) for f in self.finer])

    def rows(self, values: Values) -> Array:
        """(p, n) slopes by the free parameters, weighted."""
        model, free = self.found.model, self.found.free
        parts = [linearised(model, f, values, free, wide=True)[1] for f in self.finer]
        return np.concatenate(parts, axis=1) * self.root

    def step(self, values: Values, name: str, phi: float) -> float:
        """By how much a parameter alone makes the cost over phi rise by one; 0 if it never does."""
        parts = [linearised(self.found.model, f, values, [name])[1][0] for f in self.finer]
        slope = np.concatenate(parts) * self.root
        square = float(slope @ slope)
        return float(np.sqrt(phi / square)) if square > 0.0 else 0.0

    def left(self, values: Values, rest: Linear) -> float:
        """Sum of squares beyond what the other parameters can take up from here [N^2]."""
        residual = self.measured - self.force(values)
        over = np.abs(residual) > self.limit
        beyond = float(np.sum((self.root[over] * self.limit) ** 2))
        return rest.left(np.where(over, 0.0, residual * self.root)) + beyond

    def best(
        self, values: dict[str, float], others: Sequence[dict[str, float]]
    ) -> dict[str, float]:
        """The values, or others that leave less of samples up to the limit, and no more of all.

        Of all but the few that grow most. Where a misfit is left, what lies beyond the limit
        is not single samples: it would grow there without end.
        """
        single = round(SINGLE * len(self.measured))

        def off(at: Values) -> Array:
            return np.abs(self.measured - self.force(at)) * self.root

        def limited(left: Array) -> float:
            return float(np.sum(np.minimum(left, self.limit * self.root) ** 2))

        here = off(values)
        least = limited(here)
        for other in others:
            left = off(other)
            grown = np.sort(left**2 - here**2)[: len(left) - single]
            if limited(left) < least and float(grown.sum()) <= 0.0:
                values, least = other, limited(left)
        return values

    def taken_up(self, values: dict[str, float], name: str, rest: Linear) -> dict[str, float]:
        """The values with all parameters but one moved to their best for it."""
        step = rest.normal.solve(rest.rows @ ((self.measured - self.force(values)) * self.root))
        out = dict(values)
        for other, move in zip([n for n in self.found.free if n != name], step, strict=True):
            q = self.found.model.quantities[other]
            out[other] = float(np.clip(values[other] + move, q.low, q.high))
        return out


def _along(
    data: _Data, values: dict[str, float], name: str, rest: Linear, phi: float
) -> Callable[[float], float]:
    """The cost over phi at values of one parameter, all others following to first order."""
    known: dict[float, float] = {}

    def cost(value: float) -> float:
        if value not in known:
            known[value] = data.left({**values, name: value}, rest) / phi
        return known[value]

    return cost


@dataclass(frozen=True, eq=False)
class _Refitted:
    """The same with all others searched, from where they are at the nearest value.

    The search goes in the log's own steps, and what it leaves is counted between them.
    """

    data: _Data
    block: Block
    values: dict[str, float]
    name: str
    rest: Linear
    phi: float
    fixed: frozenset[str]
    solved: dict[float, tuple[float, dict[str, float]]] = field(default_factory=dict)

    def __call__(self, value: float) -> float:
        near = min(self.solved, key=lambda v: abs(v - value), default=None)
        start = {**(self.values if near is None else self.solved[near][1]), self.name: value}
        held = {*self.fixed, self.name}
        model = self.data.found.model
        followed = self.data.left({**self.values, self.name: value}, self.rest)
        tolerance = SETTLED * NORMAL_95**2 * self.phi / max(followed, self.phi)
        found = fit(
            model, self.block, start=start, fixed=held,
            max_evaluations=REFITS, tolerance=tolerance,
        )  # fmt: skip
        left = self.data.left({**found.values, self.name: value}, self.rest)
        self.solved[value] = left / self.phi, dict(found.values)
        return min(followed, left) / self.phi

    def ends_of_others(
        self, values: Values, phi: Mapping[str, float], searched: Sequence[str]
    ) -> dict[str, tuple[float, float]]:
        """How far the data let the others go with it, from their values.

        phi : of each by name;  searched : those with intervals by profile, as slopes may say little
            of them: where they are found is all that counts here
        """
        free = [n for n in self.data.found.free if n != self.name]
        least, best = min(self.solved.values(), key=lambda s: s[0])
        near = [(c, v) for c, v in self.solved.values() if c <= least + NORMAL_95**2]
        # The log's own steps have a bias, and the same one all along.
        at = np.array([[values[n] + v[n] - best[n] for n in free] for _, v in near])
        variance = np.array([0.0 if n in searched else phi[n] for n in free])
        errors = []
        for _, v in near:
            told = others(
                self.data.rows(v), self.data.found.free, self.name
            ).normal.pseudo_inverse()
            errors.append(np.sqrt(np.maximum(np.diag(told), 0.0) * variance))
        low, high = reached(np.array([c for c, _ in near]), at, np.array(errors))
        return dict(zip(free, zip(low.tolist(), high.tolist(), strict=True), strict=True))

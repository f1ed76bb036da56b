"""What the data say at values of one parameter, all others at their best for it.

To first order where they follow on a straight line, searched anew where they do not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import Array
from erdctl.estimate.carried import reached
from erdctl.estimate.covariance import Fit
from erdctl.estimate.finer import Finer
from erdctl.estimate.least_squares import fit
from erdctl.estimate.linearisation import linearised
from erdctl.estimate.profile import Linear, others
from erdctl.model.parameters import NORMAL_95
from erdctl.model.slots import Values

OUTLYING = 2.0  # standard deviations of the noise: no single sample rises beyond 1.96^2
ROUNDING = 1e-4  # of the force, below which nothing is told apart
REFITS = 12  # evaluations of a search for all other parameters
SETTLED = 1e-4  # of the rise that ends an interval: a step that gains less ends such a search
# Part of all samples that may be farther off where the others leave less: next to turns. Where a
# misfit is left, a sixth of them lies beyond the limit, and is no single samples.
SINGLE = 0.01


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


@dataclass(frozen=True, eq=False)
class ProfileData:
    """What a fit was to: (n,) measured force [N] and roots of the weights, over all blocks.

    limit : see `farthest`
    """

    found: Fit
    finer: Sequence[Finer]
    measured: Array
    root: Array
    limit: float

    @classmethod
    def of(cls, found: Fit, blocks: Sequence[Block], finer: Sequence[Finer]) -> ProfileData:
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


def followed(
    data: ProfileData, values: dict[str, float], name: str, rest: Linear, phi: float
) -> Callable[[float], float]:
    """The cost over phi at values of one parameter, all others following to first order."""
    known: dict[float, float] = {}

    def cost(value: float) -> float:
        if value not in known:
            known[value] = data.left({**values, name: value}, rest) / phi
        return known[value]

    return cost


@dataclass(frozen=True, eq=False)
class Refitted:
    """The same with all others searched, from where they are at the nearest value.

    The search goes in the log's own steps, and what it leaves is counted between them.

    solved : by value what all others leave, over phi, and where they are;  ended : the costs of
        those searches that need not go on
    """

    data: ProfileData
    block: Block
    values: dict[str, float]
    name: str
    rest: Linear
    phi: float
    fixed: frozenset[str]
    solved: dict[float, tuple[float, dict[str, float]]] = field(default_factory=dict)
    ended: dict[float, float] = field(default_factory=dict)

    def __call__(self, value: float) -> float:
        if value in self.ended:
            return self.ended[value]
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
        cost = min(followed, left) / self.phi
        if found.converged:
            self.ended[value] = cost
        return cost

    def ends_of_others(
        self,
        values: Values,
        points: Sequence[float],
        phi: Mapping[str, float],
        searched: Sequence[str],
    ) -> dict[str, tuple[float, float]]:
        """How far the data let the others go with it, from their values.

        points : of the profile from end to end, which say it with the outermost that the data
            allow: of those by which the ends were narrowed down the others are next to these
        phi : of each by name;  searched : those with intervals by profile, as slopes may say little
            of them: where they are found is all that counts here
        """
        free = [n for n in self.data.found.free if n != self.name]
        least, best = min(self.solved.values(), key=lambda s: s[0])
        allowed = sorted(v for v, s in self.solved.items() if s[0] <= least + NORMAL_95**2)
        few = {v for v in allowed if v in points or v in (allowed[0], allowed[-1])}
        near = [self.solved[v] for v in allowed if v in few]
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

"""What any onset leaves of a residual: sums of products give the gain of all in one pass.

With w(t) of `erdctl.model.onset`, d = 1 - f and A the force of the groups that fail,

    r = F - F_healthy,   residual = r + d w A - (J - d w J_A) dp

dp : step of all other parameters, J and J_A the derivatives of the whole force and of A by them.
The sums of the products of (J, r) and (J_A, -A), times 1, t and t^2, from the first sample to each
edge of a grid give the normal equations of every onset and ramp on that grid: the gain of each is
exact to the first order in dp, not only in d. (A two-phase regression, Quandt 1958, with a ramp.)
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.estimate.seldom import moved_on, seldom_weighed
from erdctl.model.onset import AMOUNT, RAMP, START, onset_weight

EDGES = 80  # of the first grid, over the whole time; budget
FINER = 24  # of each further one, within the last one's neighbours
ZOOMS = 5
BLOCKS = 256
RAMPS = (0, 1, 2, 3, 5, 8, 12, 18, 27, 40, 60, 79)  # cells of the first grid that a ramp may last
LOSSES = (0.02, 0.06, 0.12, 0.2, 0.35, 0.5, 0.7, 0.9, 1.0)  # 1 - f that are tried first
ROUNDED = 1e-6  # of a step
RIDGE = 1e-9  # of the normal equations' diagonal
# Likelihood ratio of a ramp against a step below which it is a step: 1 % of chi-square with 2.
A_RAMP = 9.21
# 95 % of the likelihood ratio: of a parameter in which the force is smooth, and of the place of a
# step, where it is the highest of a walk (Hansen 2000, Econometrica 68, Theorem 2 and Table I).
SMOOTH, OF_A_STEP = 3.84, 7.35


class Onset(NamedTuple):
    """What is left [1], onset and ramp [s];  square : what they leave of the residual's [N^2]."""

    f: float
    t_0: float
    t_r: float
    square: float

    @property
    def values(self) -> dict[str, float]:
        """By symbol."""
        return {AMOUNT: self.f, START: self.t_0, RAMP: self.t_r}


class Profile:
    """What any onset of a loss in some groups leaves of the residual's square."""

    def __init__(self, signals: Signals, acted: Array, whole: Array, failing: Array) -> None:
        """The samples' onset times and rows.

        acted : (n,) time at which the force of a sample acted, before its channel showed it [s]
        whole, failing : (p + 1, n) rows (J, r) and (J_A, -A), weighted
        """
        self.step, self.starts = signals.typical_step, signals.starts
        self.order = np.argsort(acted, kind="stable")
        self.t, self.q = acted[self.order], len(whole)
        rows = np.concatenate([whole, failing])
        self.weighed = np.any(rows != 0.0, axis=0)  # what has no weight is 0, and no noise
        self.X = rows[:, self.order]
        self.seldom = seldom_weighed(self.weighed[self.order])
        self.middle = 0.5 * float(self.t[0] + self.t[-1])
        # Times that differ by rounding are one: the sums over so short a ramp would be rounding.
        apart = np.diff(self.t, prepend=-np.inf) > ROUNDED * self.step
        between = self.t[apart]
        self.edges = 0.5 * (between[1:] + between[:-1])
        # Sums of all samples from some of them on, so that one onset costs what lies in its ramp.
        self.marks = np.unique(np.linspace(0, len(self.t), BLOCKS + 1).astype(np.intp))
        before = self._up_to_marks(powers=1)[:, 0]
        self.after = before[-1] - before
        self.total = self.after[0, : self.q, : self.q]
        scale = np.sqrt(np.maximum(np.diag(self.total), 0.0))[:-1]
        self.scale = np.where(scale == 0.0, 1.0, scale)
        self.square = float(self._schur(self.total[None])[0])

    def best(self) -> Onset:
        """The onset that leaves least; a ramp only where it is significantly better than a step."""
        if len(self.edges) == 0 or self.square <= 0.0:
            return Onset(1.0, float(self.t[0]), 0.0, self.square)
        before = self._up_to_marks(powers=3)  # as large as the rows: not kept
        ramp, step = self._search(before, ramps=True), self._search(before, ramps=False)
        return ramp if self.ratio(step, ramp) > A_RAMP else step

    def ratio(self, other: Onset, best: Onset) -> float:
        """Likelihood ratio of another onset against the best, in noise of the colour that is left.

        (SSE - SSE_best) |g|^2 / g'Cg,   g the difference of the two forces
        C as of noise alike all along, or as loud as it is where g lies (next to rest), if more
        """
        left = self.left(best)
        g = self.left(other) - left
        norm, more = float(g @ g), other.square - best.square
        if norm <= 0.0 or more <= 0.0:
            return 0.0
        noise = ColouredNoise.of(left, self.starts, used=self.weighed)
        spread = noise.colour(g[None], self.starts)[0] ** 2
        alike = noise.innovation * float(spread.sum())
        there = float(spread @ noise.innovations(left, self.starts) ** 2)
        return more * norm / max(alike, there, 1e-300)

    def _up_to_marks(self, powers: int) -> Array:
        """(marks, powers, 2 p + 2, 2 p + 2) `_moments` of all samples before each mark."""
        first, blocks = self._moments(0, 0, powers), pairwise(self.marks.tolist())
        return np.cumsum([first, *(self._moments(a, b, powers) for a, b in blocks)], axis=0)

    def _moments(self, a: int, b: int, powers: int) -> Array:
        """Sums of products of all rows times 1, t and t^2, or the first of these, from a to b."""
        part, tau = self.X[:, a:b], self.t[a:b] - self.middle
        return np.array([(part * tau**power) @ part.T for power in range(powers)])

    def left(self, at: Onset) -> Array:
        """(n,) weighted residual that an onset leaves, all other parameters moved by dp."""
        d = 1.0 - at.f
        TA, AA = self._sums(at.t_0, at.t_r)
        along = np.append(-self._moves(self.total - d * (TA + TA.T) + d * d * AA), 1.0)
        w = d * onset_weight(self.t, at.t_0, at.t_r, self.step)
        out = np.empty(len(self.t))
        out[self.order] = along @ self.X[: self.q] - w * (along @ self.X[self.q :])
        return out

    def _sums(self, t_0: float, t_r: float) -> tuple[Array, Array]:
        """(p + 1, p + 1) sums of w T A' and of w^2 A A' over all samples."""
        half, q = 0.5 * self.step, self.q
        a, b = np.searchsorted(self.t, [t_0 - half, t_0 + t_r + half])
        k = int(np.searchsorted(self.marks, b))
        upto = self.marks[k] if k < len(self.marks) else len(self.t)
        w = onset_weight(self.t[a:upto], t_0, t_r, self.step)
        part = self.X[:, a:upto]
        wA = w * part[q:]
        rest = self.after[min(k, len(self.marks) - 1)]
        return part[:q] @ wA.T + rest[:q, q:], wA @ wA.T + rest[q:, q:]

    def intervals(self, best: Onset) -> dict[str, tuple[float, float]]:
        """95 % intervals of onset and ramp by profile likelihood, to the last sample.

        What no step of the grid excludes goes as far as the grid does: half a sample on either
        side, since between two samples nothing is seen.
        """
        is_step = best.t_r == 0.0
        out = {}
        for symbol, most in ((START, OF_A_STEP if is_step else SMOOTH), (RAMP, SMOOTH)):
            out[symbol] = self.interval(best, symbol, most)
        return out

    def interval(self, best: Onset, symbol: str, most: float) -> tuple[float, float]:
        """Where the likelihood ratio of one of them, the other and f fitted, stays below `most`."""
        value = getattr(best, symbol)
        found = [value, value]
        half = 0.5 * self.step
        longest = float(self.t[-1] - self.t[0])
        for side, way in enumerate((-1.0, 1.0)):
            limit = 0.0 if symbol == RAMP and way < 0 else None
            reach, inside, outside = self.step, 0.0, None
            while reach < longest:
                if limit is not None and value - reach <= limit:
                    reach = value - limit
                if self.ratio(self._given(best, symbol, value + way * reach), best) > most:
                    outside = reach
                    break
                inside = reach
                if limit is not None and value - reach <= limit:
                    break
                reach *= 2.0
            while outside is not None and outside - inside > half:
                mid = 0.5 * (inside + outside)
                if self.ratio(self._given(best, symbol, value + way * mid), best) > most:
                    outside = mid
                else:
                    inside = mid
            found[side] = value + way * (inside if outside is None else outside)
        if symbol == RAMP:
            return max(found[0], 0.0), found[1] + half
        low, high = (moved_on(self.t, self.seldom, found[k], 2 * k - 1) for k in (0, 1))
        return low - half, high + half

    def _given(self, best: Onset, symbol: str, value: float) -> Onset:
        """The best with one of onset and ramp given, the other searched for near and far."""
        end, width = best.t_0 + best.t_r, max(value if symbol == RAMP else 0.0, best.t_r)
        width = max(width, 2.0 * self.step)
        if symbol == START:
            # The same end, none, and others: a ramp that outlasts the record may have any.
            spans = [0.0, *(max(end - value, 2.0 * self.step) * np.geomspace(0.5, 2.0, 7))]
            pairs = [(value, float(span)) for span in spans]
        else:
            # The same onset, the same end, and others: where it outlasts the record, f makes up.
            starts = best.t_0 + width * np.linspace(-0.75, 0.75, 7)
            starts = np.unique([*starts, best.t_0, end - value, 0.5 * (best.t_0 + end - value)])
            pairs = [(float(t_0), value) for t_0 in starts]
        found = [self.least(*pair, best.f) for pair in pairs]
        k = int(np.argmin([o.square for o in found]))
        # Once more between the neighbours of the best.
        around = [pairs[max(k - 1, 0)], pairs[k], pairs[min(k + 1, len(pairs) - 1)]]
        fine = [
            (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))
            for a, b in pairwise(around)
            for part in (0.2, 0.5, 0.8)
        ]
        return min([*found, *(self.least(*pair, best.f) for pair in fine)], key=lambda o: o.square)

    def least(self, t_0: float, t_r: float, f: float) -> Onset:
        """The best f of a given onset and ramp."""
        TA, AA = self._sums(t_0, t_r)
        size = 1.0 - f
        tried = np.unique(np.clip(size * np.array([0.5, 0.85, 1.0, 1.2, 2.0]), 1e-3, 1.0))
        sizes, least = self._over_sizes((TA + TA.T)[None], AA[None], tried)
        return Onset(1.0 - float(sizes[0]), t_0, t_r, float(least[0]))

    def _search(self, before: Array, *, ramps: bool) -> Onset:
        """The best of ever finer grids."""
        edges = _spread(self.edges, EDGES)
        i, j = _pairs(len(edges), RAMPS if ramps else (0,))
        best = self._over(before, edges, i, j, np.array(LOSSES))
        width = float(edges[min(1, len(edges) - 1)] - edges[0]) if len(edges) > 1 else 0.0
        width = max(width, float(np.diff(edges).max(initial=0.0)))
        # A ramp of the first grid is known to the next one that was tried.
        wide = max(width, 0.4 * best.t_r)
        for _ in range(ZOOMS):
            ends = [best.t_0, best.t_0 + best.t_r] if ramps else [best.t_0]
            near = np.zeros(len(self.edges), dtype=bool)
            for end, reach in zip(ends, (width, wide), strict=False):
                near |= np.abs(self.edges - end) <= reach
            window = self.edges[near]
            # The pair of the last grid stays, or a coarse one could lose it.
            edges = np.unique(np.concatenate([_spread(window, (len(ends)) * FINER), ends]))
            i, j = _pairs(len(edges), range(len(edges)) if ramps else (0,))
            f = 1.0 - best.f
            sizes = np.unique(np.clip(f * np.array([0.7, 0.85, 1.0, 1.15, 1.4]), 1e-3, 1.0))
            best = min(best, self._over(before, edges, i, j, sizes), key=lambda o: o.square)
            if len(window) <= (len(ends)) * FINER:
                break
            width, wide = 3.0 * width / FINER, 3.0 * wide / FINER
        return best

    def _over(self, before: Array, edges: Array, i: Index, j: Index, sizes: Array) -> Onset:
        """The best of onsets at edges i with ramps that end at edges j."""
        q, at = self.q, np.searchsorted(self.t, edges)
        mark = np.searchsorted(self.marks, at, side="right") - 1
        upto = zip(self.marks[mark].tolist(), at.tolist(), strict=True)
        sums = before[mark] + np.array([self._moments(a, b, 3) for a, b in upto])
        t_0, t_r = edges[i] - self.middle, edges[j] - edges[i]
        u, v = t_0[:, None, None], np.where(t_r > 0.0, t_r, 1.0)[:, None, None]
        ta, aa = sums[:, :2, :q, q:], sums[:, :, q:, q:]
        in_ta, in_aa = ta[j] - ta[i], aa[j] - aa[i]
        TA = (in_ta[:, 1] - u * in_ta[:, 0]) / v + self.after[0, :q, q:] - ta[j, 0]
        AA = (in_aa[:, 2] - 2.0 * u * in_aa[:, 1] + u * u * in_aa[:, 0]) / v**2
        AA += self.after[0, q:, q:] - aa[j, 0]
        TA += np.swapaxes(TA, 1, 2).copy()
        size, least = self._over_sizes(TA, AA, sizes)
        k = int(np.argmin(least))
        return Onset(1.0 - float(size[k]), float(edges[i[k]]), float(t_r[k]), float(least[k]))

    def _over_sizes(self, TA: Array, AA: Array, sizes: Array) -> tuple[Array, Array]:
        """(m,) the best loss of each onset, and what it leaves, from sums (m, p + 1, p + 1)."""

        def square(d: Array | float) -> Array:
            d = np.reshape(d, (-1, 1, 1))
            return self._schur(self.total - d * TA + d * d * AA)

        tried = np.array([square(d) for d in sizes])
        k, m = np.argmin(tried, axis=0), np.arange(len(TA))
        size, least = sizes[k], tried[k, m]
        if len(sizes) > 2:
            at = _vertex(sizes, tried)
            found = square(at)
            size, least = np.where(found < least, at, size), np.minimum(found, least)
        return size, least

    def _schur(self, G: Array) -> Array:
        """(m,) square that is left of the last row beyond the others, from Grams (m, p+1, p+1)."""
        N, right = self._normal(G)
        whole = G[:, -1, -1]
        least: Array = whole - np.sum(np.linalg.solve(N, right) * right, axis=(1, 2))
        return np.where(least >= 0.0, least, whole)  # one below 0 is rounding, and says nothing

    def _moves(self, G: Array) -> Array:
        """(p,) dp of one Gram matrix."""
        N, right = self._normal(G[None])
        return np.asarray(np.linalg.solve(N, right)[0, :, 0] / self.scale)

    def _normal(self, G: Array) -> tuple[Array, Array]:
        """Normal equations (m, p, p) and (m, p, 1) in scaled units."""
        ridge = RIDGE * np.eye(len(self.scale))
        N = G[:, :-1, :-1] / np.outer(self.scale, self.scale) + ridge
        return N, G[:, :-1, -1:] / self.scale[:, None]


def _spread(values: Array, most: int) -> Array:
    """At most so many of some values, evenly."""
    if len(values) <= most:
        return values
    return values[np.linspace(0, len(values) - 1, most).round().astype(np.intp)]


def _pairs(count: int, apart: Sequence[int]) -> tuple[Index, Index]:
    """All pairs i, i + k of so many edges with k among `apart`."""
    i, k = np.meshgrid(np.arange(count), np.asarray(list(apart)), indexing="ij")
    inside = i + k < count
    return i[inside], (i + k)[inside]


def _vertex(x: Array, y: Array) -> Array:
    """(m,) where parabolas through the lowest three points of curves (k, m) over x (k,) turn."""
    c = np.clip(np.argmin(y, axis=0), 1, len(x) - 2)
    m = np.arange(y.shape[1])
    x0, x1, x2 = x[c - 1], x[c], x[c + 1]
    a, b = (y[c - 1, m] - y[c, m]) / (x0 - x1), (y[c + 1, m] - y[c, m]) / (x2 - x1)
    curve = (b - a) / (x2 - x0)
    slope = a - curve * (x0 - x1)
    turn: Array = x1 - slope / np.where(curve > 0.0, 2.0 * curve, np.inf)
    return np.clip(turn, x0, x2)

"""A cheap look at every effect: how much of the residual it could take, and from which start.

At each of a grid of starts the effect changes the force by some D. What D explains of the residual
beyond what the parameters of the present model can (their Jacobian is projected out) needs one
evaluation of the model instead of a search. Hypotheses are fitted from the best starts found here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.estimate.linearisation import jacobian
from erdctl.estimate.onsets import profile
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.slots import (
    ChannelSlot,
    HysteresisSlot,
    MotionSlot,
    SeriesSlot,
    SignSlot,
    TermSlot,
    Values,
    YieldSlot,
)

CARRYING = (MotionSlot, SeriesSlot, ChannelSlot)  # what an added force acts behind, or through


@dataclass(frozen=True)
class Candidate:
    """An effect, the part of the mean square that it may take, and where to start."""

    effect: Effect
    gain: float
    starts: tuple[dict[str, float], ...]


class Screen:
    """Looks at effects to add to one hypothesis; what they share is computed once.

    most : values of parameters above which an effect is none, by name
    every : of the samples one in so many is looked at
    """

    def __init__(
        self, problem: Problem, parent: Hypothesis, most: Values | None = None, every: int = 1
    ) -> None:
        self.problem, self.parent, self.most = problem, parent, most or {}
        self.every = slice(None, None, every)
        self.root = np.sqrt(parent.problem.block.weight)
        signals = problem.block.signals
        self.lever = self.root  # of a force of the model on a weighted residual
        if parent.record_effects is not None:
            self.lever = self.root * parent.record_effects.along(signals.starts)[0]
        J = jacobian(parent.model, signals, parent.values, parent.free) * self.lever
        self.basis = _orthonormal(J[:, self.every])
        self.residual = self._beyond((parent.residual[None] * self.root)[:, self.every])[0]
        self.square = float(self.residual @ self.residual)
        self.force = parent.model.force(signals, parent.values)

    def candidate(self, effect: Effect) -> Candidate | None:
        """What one effect promises; None where the parent's or the log do not admit it."""
        found = self._promise(effect)
        if found is not None and found.gain < thresholds.BEHIND_SPRING and self._behind(effect):
            return None
        return found

    def _behind(self, effect: Effect) -> bool:
        """Whether it brings together a spring and a yield force that is no law of speed alone.

        The two bend each other's loops: they fit much that is neither, and only at these motions.
        """
        spring = any(isinstance(e.slot, SeriesSlot) for e in self.parent.effects)
        other = any(_is_other(e) for e in self.parent.effects)
        joins = isinstance(effect.slot, SeriesSlot) and other
        return not (spring and other) and (joins or (spring and _is_other(effect)))

    def _promise(self, effect: Effect) -> Candidate | None:
        if effect.sets_in:
            return self._onset(effect)
        if effect.smooth:
            return self._smooth(effect)
        found = []
        for guess in starts(effect, self.parent.problem, self.parent.residual):
            try:
                gain = self._gain(effect, guess)
            except IncompatibleEffects:
                return None
            found.append((gain, {effect.key(s): v for s, v in guess.items()}))
        found.sort(key=lambda f: -f[0])
        best = found[:1]
        for f in found[1:]:  # what begins next to a better one ends where that does
            if len(best) < thresholds.SEARCHED_STARTS and all(_apart(f[1], b[1]) for b in best):
                best.append(f)
        if any(v > self.most.get(name, v) for name, v in best[0][1].items()):
            return None
        return Candidate(effect, found[0][0], tuple(guess for _, guess in best))

    def _onset(self, effect: Effect) -> Candidate:
        """What sets in: the gain of its best time, exact to first order in the other parameters.

        With these as the parent has them, fitted to before and after alike, it would count a tenth.
        """
        parent, signals = self.parent, self.problem.block.signals
        residual = parent.residual * self.root
        lookup = profile(
            parent.model, effect, signals, residual, self.lever, parent.values, parent.problem.held
        )
        best = lookup.best()
        start = {effect.key(s): v for s, v in best.values.items()}
        return Candidate(effect, 1.0 - best.square / max(lookup.square, 1e-300), (start,))

    def _smooth(self, effect: Effect) -> Candidate | None:
        """What changes the force in proportion to its sizes, all else of it at its start."""
        start = {q.symbol: q.start for q in effect.quantities}
        sizes = effect.sizes
        try:
            rows = [*self._added(effect, start), *self._slopes(effect, start)]
        except IncompatibleEffects:
            return None
        gain, found = self._taken(rows, [q.low for q in sizes], [q.high for q in sizes])
        start |= {q.symbol: float(v) for q, v in zip(sizes, found, strict=True)}
        return Candidate(effect, gain, ({effect.key(s): v for s, v in start.items()},))

    def _added(self, effect: Effect, guess: Values) -> Array:
        """(k, n) what a unit of each amplitude of an effect changes in the recorded force [N].

        It acts on the motion that the parent's effects leave the piston, and goes through their
        springs and their force channel.
        """
        signals = self.problem.block.signals
        rows = effect.added(signals, guess)
        if not (len(rows) and any(isinstance(e.slot, CARRYING) for e in self.parent.effects)):
            return rows
        model = Model((*self.parent.effects, effect))
        names = [effect.key(q.symbol) for q in effect.amplitudes]
        values = {**self.parent.values, **effect.off, **dict.fromkeys(names, 0.0)}
        values |= {effect.key(s): v for s, v in guess.items()}
        if model.separable or not effect.carried:
            columns = model.prepare(signals, values).columns()
            return columns[[model.linear.index(name) for name in names]]
        bare = model.force(signals, values)
        step = thresholds.ADDED_STEP * float(np.ptp(self.problem.block.force))
        out = np.empty_like(rows)
        for name, row, added in zip(names, out, rows, strict=True):
            size = step / max(float(np.abs(added).max()), 1e-300)
            row[:] = (model.force(signals, {**values, name: size}) - bare) / size
        return out

    def _slopes(self, effect: Effect, start: dict[str, float]) -> list[Array]:
        """(n,) slopes of the force by the sizes that are no amplitudes."""
        signals, step = self.problem.block.signals, thresholds.SMOOTH_STEP
        model = Model((*self.parent.effects, effect))
        values = {**self.parent.values, **{effect.key(s): v for s, v in start.items()}}
        out = []
        for q in effect.sizes:
            if not q.linear:
                moved = model.force(signals, {**values, effect.key(q.symbol): step})
                out.append((moved - self.force) / step)
        return out

    def _gain(self, effect: Effect, guess: dict[str, float]) -> float:
        """Part of the residual's square that an effect takes, in the amounts that suit best.

        A nonlinear effect can only be more or less what its start says: its amount is not negative.
        """
        signals = self.problem.block.signals
        rows = list(self._added(effect, guess))
        low = [-np.inf if q.low < 0 else 0.0 for q in effect.amplitudes]
        if not isinstance(effect.slot, TermSlot):
            model = Model((*self.parent.effects, effect))
            values = {**self.parent.values, **effect.off}
            values |= {effect.key(s): v for s, v in guess.items()}
            values |= {effect.key(q.symbol): 0.0 for q in effect.amplitudes}
            rows.append(model.force(signals, values) - self.force)
            low.append(0.0)
        return self._taken(rows, low, [np.inf] * len(rows))[0]

    def _taken(
        self, rows: Sequence[Array], low: Sequence[float], high: Sequence[float]
    ) -> tuple[float, Array]:
        """Part of the residual's square that some changes (k, n) of the force take, and (k,) of
        each how much."""
        from scipy.linalg import qr
        from scipy.optimize import lsq_linear

        X = self._beyond(np.array(rows)[:, self.every] * self.lever[self.every])
        scale = np.sqrt(np.einsum("ij,ij->i", X, X))
        use = scale > 0.0
        much = np.zeros(len(rows))
        if not use.any():
            return 0.0, much
        bounds = np.array(low)[use] * scale[use], np.array(high)[use] * scale[use]
        # What the changes can take lies in as many directions as there are of them.
        q, r = qr((X[use] / scale[use, None]).T, mode="economic")
        within = self.residual @ q
        much[use] = most = np.linalg.lstsq(r, within)[0]
        if ((most < bounds[0]) | (most > bounds[1])).any():
            much[use] = most = lsq_linear(r, within, bounds=bounds, method="bvls").x
        much /= np.where(use, scale, 1.0)
        taken = float(within @ within) - float(np.sum((within - r @ most) ** 2))
        return taken / max(self.square, 1e-300), much

    def _beyond(self, rows: Array) -> Array:
        return np.asarray(rows - (rows @ self.basis.T) @ self.basis)


def _orthonormal(rows: Array) -> Array:
    """(m, n) orthonormal basis of some rows (k, n), m <= k, from the largest on."""
    from scipy.linalg import qr

    scale = np.sqrt(np.einsum("ij,ij->i", rows, rows))
    scaled = rows / np.where(scale > 0, scale, 1.0)[:, None]
    q, r, _ = qr(scaled.T, mode="economic", pivoting=True)
    size = np.abs(np.diag(r))
    return np.ascontiguousarray(q[:, size > thresholds.BASIS * size[:1]].T)


def _is_other(effect: Effect) -> bool:
    """Whether it makes the yield force one of more than the piston's speed."""
    slot = effect.slot
    return isinstance(slot, HysteresisSlot | YieldSlot) or (
        isinstance(slot, SignSlot) and slot.of_another
    )


def starts(effect: Effect, problem: Problem, residual: Array) -> list[dict[str, float]]:
    """Starts for the shape parameters of an effect, by symbol: its own, or those of a grid.

    residual : (n,) of the model without the effect [N]
    """
    rest = np.where(problem.block.weight > 0.0, residual, 0.0)
    own = effect.starts(problem.block.signals, rest)
    if own is not None:
        return own
    axes = [_axis(q, problem) for q in effect.shape]
    while np.prod([len(a) for a in axes]) > thresholds.MOST_STARTS:
        longest = max(range(len(axes)), key=lambda i: len(axes[i]))
        axes[longest] = axes[longest][::2]
    symbols = [q.symbol for q in effect.shape]
    return [dict(zip(symbols, point, strict=True)) for point in product(*axes)]


def _axis(q: Quantity, problem: Problem) -> list[float]:
    """Starts of one parameter: its unit says which scale of the recording it goes with."""
    r, s = problem.recording, problem.block.signals
    assert r.force is not None
    longest = float((s.t[s.starts[1:] - 1] - s.t[s.starts[:-1]]).max())
    stroke, force = float(np.ptp(r.x)) / 2, float(np.ptp(r.force))
    speed = float(np.abs(r.xdot).max())
    work = float(np.abs(r.force * r.xdot * r.step).sum()) / len(r.names)
    negative = thresholds.INVERSE_NEGATIVE
    match q.unit:
        case "m":
            values = [p * stroke for p in thresholds.PARTS]
        case "m/s":
            values = [p * speed for p in thresholds.PARTS]
        case "N s/m":
            values = [p * force / speed for p in thresholds.MULTIPLES]
        case "m/N":
            values = [p * stroke / force for p in thresholds.PARTS]
        case "1/m":
            values = [p / stroke for p in thresholds.INVERSE_PARTS]
            values += [negative / stroke] if q.low < 0 else []
        case "1/m^2":
            values = [0.0, thresholds.INVERSE_SQUARE / stroke**2]
            values += [negative / stroke**2] if q.low < 0 else []
        case "s" if q.start < longest:
            values = np.geomspace(s.finest_step, longest / 2, thresholds.DELAYS).tolist()
            values.append(thresholds.PART_OF_STEP * s.finest_step)
        case "1/J":
            values = [p / work for p in thresholds.ENERGY_PARTS]
        case _ if q.low < 0 < q.high:
            values = [p * q.start for p in thresholds.SIGNED_MULTIPLES]
        case _:
            values = [p * q.start for p in thresholds.MULTIPLES]
    inside = sorted({min(max(v, q.low), q.high) for v in values})
    return inside or [q.start]


def _apart(one: Values, other: Values) -> bool:
    """Whether two starts differ by more than a step of a fine grid in any parameter."""
    step = thresholds.NEXT_START
    pairs = [(one[n], other[n]) for n in one]
    return any(a != b and not (a * b > 0.0 and 1.0 / step < a / b < step) for a, b in pairs)

"""A cheap look at every effect: how much of the residual it could take, and from which start.

At each of a grid of starts the effect changes the force by some D. What D explains of the residual
beyond what the parameters of the present model can (their Jacobian is projected out) needs one
evaluation of the model instead of a search. Full hypotheses begin at the best starts found here.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.estimate.covariance import jacobian
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

PARTS = (0.003, 0.01, 0.03, 0.1, 0.3)  # of what the recording spans, for lengths and the like
TIMES = (
    0.1,
    0.3,
    1.0,
    3.0,
    10.0,
)  # of a parameter's own start, where nothing in a log sets a scale
DELAYS = 6  # of those of a time, from a sample to half of the longest record
MOST = 30  # starts for one effect


@dataclass(frozen=True)
class Candidate:
    """An effect, the part of the mean square that it may take, and where to start."""

    effect: Effect
    gain: float
    starts: tuple[dict[str, float], ...]


class Screen:
    """Looks at effects beside one hypothesis; what they share is computed once."""

    def __init__(self, problem: Problem, parent: Hypothesis) -> None:
        self.problem, self.parent = problem, parent
        self.root = np.sqrt(parent.problem.block.weight)
        signals = problem.block.signals
        free = [
            n for n, q in parent.model.quantities.items()
            if n not in problem.held and q.low < parent.values[n] < q.high
        ]  # fmt: skip
        record_effects = parent.record_effects
        self.lever = self.root  # of a force of the model on a weighted residual
        if record_effects is not None:
            self.lever = self.root * record_effects.along(signals.starts)[0]
        J = jacobian(parent.model, signals, parent.values, free) * self.lever
        scale = np.sqrt(np.einsum("ij,ij->i", J, J))
        J /= np.where(scale > 0, scale, 1.0)[:, None]
        w, v = np.linalg.eigh(J @ J.T)
        keep = w > 1e-8 * w[-1]
        self.basis = (v[:, keep] / np.sqrt(w[keep])).T @ J
        self.residual = self._beyond(parent.residual[None] * self.root)[0]
        self.square = float(self.residual @ self.residual)
        self.force = parent.model.force(signals, parent.values)

    def assess(self, effect: Effect, best: int = 2) -> Candidate | None:
        """What one effect promises; None if it cannot act beside the parent's."""
        found = []
        for guess in starts(effect, self.problem):
            try:
                gain = self._gain(effect, guess)
            except ValueError:
                return None
            found.append((gain, {effect.key(s): v for s, v in guess.items()}))
        found.sort(key=lambda f: -f[0])
        return Candidate(effect, found[0][0], tuple(guess for _, guess in found[:best]))

    def _gain(self, effect: Effect, guess: dict[str, float]) -> float:
        signals = self.problem.block.signals
        rows, signs = [], []
        if effect.apply is not None:
            model = Model((*self.parent.effects, effect))
            values = {**self.parent.values, **effect.off}
            values |= {effect.key(s): v for s, v in guess.items()}
            values |= {effect.key(q.symbol): 0.0 for q in effect.amplitudes}
            rows.append(model.force(signals, values) - self.force)
            signs.append(True)
        if effect.columns is not None:
            rows += list(effect.columns(signals, guess))
            signs += [q.low >= 0 for q in effect.amplitudes]
        X = self._beyond(np.array(rows) * self.lever)
        one_sided = np.array(signs)
        use = np.einsum("ij,ij->i", X, X) > 0.0
        while use.any():
            amounts = np.linalg.lstsq(X[use] @ X[use].T, X[use] @ self.residual, rcond=1e-9)[0]
            wrong = np.flatnonzero(use)[(amounts < 0) & one_sided[use]]
            if wrong.size == 0:
                return float(amounts @ (X[use] @ self.residual)) / max(self.square, 1e-300)
            use[wrong] = False
        return 0.0

    def _beyond(self, rows: Array) -> Array:
        return np.asarray(rows - (rows @ self.basis.T) @ self.basis)


def starts(effect: Effect, problem: Problem) -> list[dict[str, float]]:
    """A grid of starts for the shape parameters of an effect, by symbol."""
    if effect.guesses is not None:
        return [dict(g) for g in effect.guesses(problem.block.signals)]
    shape = [q for q in effect.quantities if not q.linear]
    axes = [_axis(q, problem) for q in shape]
    while np.prod([len(a) for a in axes]) > MOST:
        longest = max(range(len(axes)), key=lambda i: len(axes[i]))
        axes[longest] = axes[longest][::2]
    return [
        dict(zip((q.symbol for q in shape), point, strict=True)) for point in product(*axes)
    ] or [{}]


def _axis(q: Quantity, problem: Problem) -> list[float]:
    r = problem.recording
    assert r.force is not None
    s = problem.block.signals
    longest = float((s.t[s.starts[1:] - 1] - s.t[s.starts[:-1]]).max())
    stroke, force = float(np.ptp(r.x)) / 2, float(np.ptp(r.force))
    speed = float(np.abs(r.xdot).max())
    work = float(np.abs(r.force * r.xdot * r.step).sum()) / len(r.names)
    match q.unit:
        case "m":
            values = [p * stroke for p in PARTS]
        case "m/s":
            values = [p * speed for p in PARTS]
        case "m/N":
            values = [p * stroke / force for p in PARTS]
        case "1/m":
            values = [p / stroke for p in (0.1, 0.5)] + ([-0.3 / stroke] if q.low < 0 else [])
        case "1/m^2":
            values = [0.0, 0.5 / stroke**2] + ([-0.3 / stroke**2] if q.low < 0 else [])
        case "s" if q.start < longest:
            values = np.geomspace(s.typical_step, longest / 2, DELAYS).tolist()
        case "1/J":
            values = [p / work for p in (0.03, 0.3)]
        case _ if q.low < 0 < q.high:
            values = [0.3 * q.start, q.start, -q.start]
        case _:
            values = [p * q.start for p in TIMES]
    inside = sorted({min(max(v, q.low), q.high) for v in values})
    return inside or [q.start]

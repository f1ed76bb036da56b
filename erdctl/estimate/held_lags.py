"""What a lag that no step of the duty shows leaves of the errors of all other parameters.

One state of F_ER serves both directions (Eq. 12): after a reversal it goes from the yield force of
one to that of the other, with the lag. Where no duty steps this is all that shows of a lag, and it
is held at 0, as a fit to so little may run far. But if it is not 0, the others have made up for it:
of a single sine at one duty stiffness and damping of either direction were told to 1.6 % and off by
40 %. So they are told as far as a lag that the data allow would move them:

    within = union of theta(T) +- 1.96 sigma over T = 0 and all T with c(T) - min c <= 1.96^2 phi

c is the sum of squares that all other parameters leave, phi as in `erdctl.estimate.profile`. Where
with a lag nothing but noise is left, and it is clearly told by that, it is free.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from erdctl.core.blocks import Block
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.estimate.covariance import Fit
from erdctl.estimate.least_squares import Fitted
from erdctl.estimate.linearisation import jacobian
from erdctl.estimate.measurement_noise import measurement_noise
from erdctl.estimate.normal_equations import Normal
from erdctl.model.parameters import NORMAL_95
from erdctl.model.slots import Values

LAGS = tuple(f"{d}.T_d" for d in DIRECTIONS)
TIMES = np.geomspace(0.004, 0.3, 11)  # of lags [s]; published ones of ER dampers end at 0.06 s
RATIOS = (0.5, 0.7, 1.4, 2.0)  # of the lags of the two directions
CLOSER = 3  # halvings of what lies between a time and the next
NOISE_ALONE = 1.1  # of the measurement noise, rms, that a fit with them free may leave
# Times the noise, rms, from which on a residual is told to hold more: of 36 logs of the paper's
# damper the most was 1.65, in AR(1) noise, of which neighbours in state hold less.
LACKING = 2.0
# Of the mean square beyond the noise, what may be left where that is correlated: AR(1) noise of 0.9
# left 0.1, a force that grows with the cube of the deflection 0.45.
LEFT = 0.2
CLEAR = 4.0  # standard errors from 0
FELT = 0.5  # of a standard error, a move of a parameter below which its error holds it


def with_held_lags(found: Fit, block: Block, held: Sequence[str]) -> tuple[Fit, Values | None]:
    """The fit with intervals of the parameters that a lag among those held at 0 would move.

    And where a fit with the lags free may begin, if the data clearly ask for that: as short as lags
    are, and clear of 0. See `tell_the_lags` for what that fit is worth.
    block : what to tell it by, all of the data or a part of them;  held : parameters that are held
        though the data may hold something of them
    """
    none = set(held) >= set(LAGS) and all(found.values[n] == 0.0 for n in LAGS)
    line = _Line.of(found, block) if none and found.jumps is None else None
    if line is None:
        return found, None
    line.look()
    values = line.allowed()
    errors, intervals = found.stderr, dict(found.intervals)
    for i, name in enumerate(found.free):
        low, high = float(values[:, i].min()), float(values[:, i].max())
        reach = NORMAL_95 * errors[name]
        if high - low <= FELT * errors[name] or not np.isfinite(reach):
            continue
        q = found.model.quantities[name]
        sides = intervals.get(name, (low, high))
        low, high = min(low - reach, sides[0]), max(high + reach, sides[1])
        intervals[name] = (max(low, q.low), min(high, q.high))
    return replace(found, intervals=intervals), line.asked_for()


def tell_the_lags(without: Fit, found: Fitted, block: Block) -> bool:
    """Whether a fit with the lags free leaves nothing but noise, so that the data tell them.

    What does not fit otherwise would take them anywhere (1 s on a real damper). Noise that is
    correlated leaves more than its own size, as `LACKING` allows for; then the fit without must
    leave more than that, and the lags take nearly all that is beyond the noise.
    """
    if max(found.values[n] for n in LAGS) >= TIMES[-1]:
        return False
    noise = measurement_noise(block, found.residual)
    rms = float(np.sqrt(np.average(found.residual**2, weights=block.weight)))
    if rms <= NOISE_ALONE * noise:
        return True
    if not rms <= LACKING * noise < without.rms:
        return False
    return rms**2 - noise**2 <= LEFT * (without.rms**2 - noise**2)


@dataclass(frozen=True, eq=False)
class _Line:
    """What is left, and the free parameters (p,), at some pairs of lags [s]."""

    found: Fit
    block: Block
    phi: float
    lacks: bool  # more than noise is left with both at 0
    known: dict[tuple[float, float], tuple[float, Array]] = field(default_factory=dict)

    @classmethod
    def of(cls, found: Fit, block: Block) -> _Line | None:
        """With both at 0; None where the data tell nothing at all."""
        values, weight = found.values, block.weight
        model, free = found.model, list(found.free)
        here = model.force(block.signals, values)
        rows = jacobian(model, block.signals, values, free) * np.sqrt(weight)
        plain = np.diag(Normal.of(rows @ rows.T).pseudo_inverse())
        robust = np.diag(found.covariance)
        told = (plain > 0.0) & (robust > 0.0)
        if not told.any():
            return None
        # A part of the data tells less of a lag than all of them tell of the others.
        part = found.samples / max(int(np.count_nonzero(weight)), 1)
        phi = float(np.median(robust[told] / plain[told])) * part
        rest = block.force - here
        start = np.array([values[n] for n in free])
        rms = float(np.sqrt(np.average(rest**2, weights=weight)))
        lacks = rms > LACKING * measurement_noise(block, rest)
        return cls(found, block, phi, lacks, {(0.0, 0.0): (float(np.dot(weight, rest**2)), start)})

    def look(self) -> None:
        """Along equal lags, closer at the ends of what is allowed, and unequal ones at the best."""
        last = (0.0, 0.0)
        for time in TIMES.tolist():
            last = self._at(time, time, last)
        for _ in range(CLOSER):
            times = sorted(c for c, r in self.known if c == r)
            for a, b in pairwise(times):
                if self._is_allowed((a, a)) != self._is_allowed((b, b)):
                    self._at(0.5 * (a + b), 0.5 * (a + b), (b, b))
        best = min(self.known, key=lambda lags: self.known[lags][0])
        for ratio in RATIOS:
            self._at(best[0] * ratio, best[1], best)
            self._at(best[0], best[1] * ratio, best)

    def asked_for(self) -> Values | None:
        """All values at the best lags that were looked at, if these are clear and short.

        A misfit counts as noise in `phi`; if it is the lags' own it hides them. Where there is one
        the fit with them free says what they take of it.
        """
        best = min(self.known, key=lambda lags: self.known[lags][0])
        gained = self.known[0.0, 0.0][0] - self.known[best][0]
        clear = gained >= CLEAR**2 * self.phi or self.lacks
        if not clear or not 0.0 < max(best) < TIMES[-1]:
            return None
        return self._values(best, self.known[best][1])

    def allowed(self) -> Array:
        """(m, p) free parameters with both at 0 and at all lags that the data allow."""
        return np.array(
            [
                v
                for lags, (_, v) in self.known.items()
                if lags == (0.0, 0.0) or self._is_allowed(lags)
            ]
        )

    @property
    def least(self) -> float:
        """The least that is left anywhere."""
        return min(cost for cost, _ in self.known.values())

    def _is_allowed(self, lags: tuple[float, float]) -> bool:
        return self.known[lags][0] - self.least <= NORMAL_95**2 * self.phi

    def _at(self, T_c: float, T_r: float, near: tuple[float, float]) -> tuple[float, float]:
        """Look at a pair of lags, from where the others are at one that is known."""
        model, free, block = self.found.model, list(self.found.free), self.block
        root = np.sqrt(block.weight)
        at = self.known[near][1]
        low = np.array([model.quantities[n].low for n in free])
        high = np.array([model.quantities[n].high for n in free])
        costs: list[tuple[float, Array]] = []
        steps = 2 if model.effects else 1  # the paper's model is linear but for beta
        for step in range(steps + 1):
            values = self._values((T_c, T_r), at)
            rest = (block.force - model.force(block.signals, values)) * root
            costs.append((float(rest @ rest), at))
            far = step > 0 and costs[-1][0] > self.least + CLEAR**2 * self.phi
            if step == steps or far or not np.isfinite(costs[-1][0]):
                break
            rows = jacobian(model, block.signals, values, free) * root
            at = np.clip(at + Normal.of(rows @ rows.T).solve(rows @ rest), low, high)
        self.known[T_c, T_r] = min(costs, key=lambda found: found[0])
        return T_c, T_r

    def _values(self, lags: tuple[float, float], free: Array) -> dict[str, float]:
        own = dict(zip(self.found.free, free.tolist(), strict=True))
        return {**self.found.values, **own, **dict(zip(LAGS, lags, strict=True))}

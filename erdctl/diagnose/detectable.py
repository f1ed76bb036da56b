"""What could have been missed: the size from which these data would have shown an effect.

An effect of a size s changes the force by D(s), simulated with the model that the search ended
with. What the model's own parameters absorb of it is projected out, D' = D - J (J'WJ)^-1 J'W D, and
the rest is added to the residual as it was recorded, with its noise and whatever else is in it:

    without : e + D'    with : e, beyond one parameter more    each as a fit without its group

The search's own decision takes the second for better from some size on, whichever sign the noise
has: it is as likely to hide an effect as to show it. What is told is half as much again, so that
other noise of the same kind would not hide it. Exact where the force is linear in the size; for
others the first Gauss-Newton step, like the cross-validation itself. What acts next to turns of
the motion alone is seen by nothing, however large (see `resolved`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, inf, isfinite, log

import numpy as np

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.progress import Progress, part_of
from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.as_taken import as_taken
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.hypothesis import Hypothesis, left_out, slopes
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.resolved import next_to_turns
from erdctl.diagnose.sizes import amount_of, is_linear, point, span, ways
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

ABSORBED = "the other parameters of the model take its place on these data"
TAKEN = "it cannot act together with what the model already has"


@dataclass(frozen=True)
class Detectable:
    """An effect that was not named, and the size from which these data would have shown it.

    values : every parameter by symbol at that size, SI; None if these data could not show it
    force : rms of the force that it would make [N];  beyond : of what no other parameter absorbs
    reason : why these data could not show it
    """

    effect: Effect
    values: Mapping[str, float] | None = None
    force: float | None = None
    beyond: float | None = None
    reason: str | None = None

    @property
    def quantity(self) -> Quantity:
        """The parameter that says how much of the effect there is."""
        return amount_of(self.effect)

    @property
    def size(self) -> float | None:
        """Its value."""
        return None if self.values is None else self.values[self.quantity.symbol]


def detectable(
    problem: Problem,
    best: Hypothesis,
    candidates: Sequence[Effect],
    untestable: Mapping[str, str],
    progress: Progress = lambda stage, what: None,
) -> tuple[Detectable, ...]:
    """For every effect that a hypothesis lacks, the size from which the data would have shown it.

    problem, best : among which was searched, and what the search ended with
    untestable : effects that the log cannot show, each with what is missing
    """
    chosen = {e.name for e in best.effects}
    left = [e for e in candidates if e.name not in chosen and e.name not in untestable]
    injection = Injection(problem, best)
    out = [Detectable(e, reason=untestable[e.name]) for e in candidates if e.name in untestable]
    for number, effect in enumerate(left, start=1):
        progress("what could have been missed", part_of(effect.name, number, len(left)))
        out.append(injection.least(effect))
    return tuple(sorted(out, key=lambda d: d.effect.name))


class Injection:
    """Adds effects to the residual of one hypothesis; what they share is computed once."""

    def __init__(self, problem: Problem, best: Hypothesis) -> None:
        self.problem, self.best = problem, best
        signals = problem.block.signals
        self.force = best.model.force(signals, best.values)
        self.slopes = slopes(best)
        self.lever = (
            1.0 if best.record_effects is None else best.record_effects.along(signals.starts)[0]
        )
        self.steps = -1  # below what is as large as the residual; then where the last one was seen

    def least(self, effect: Effect) -> Detectable:
        """The smallest size that would have been seen: in the middle one of some shapes."""
        try:
            found = [
                self._along(effect, way) for way in ways(effect, self.problem, self.best.residual)
            ]
        except IncompatibleEffects:
            return Detectable(effect, reason=TAKEN)
        seen = sorted((f for f in found if f.force is not None), key=lambda f: f.force or 0.0)
        if not seen or 2 * len(seen) < len(found):
            return Detectable(effect, reason=ABSORBED)
        return seen[(len(seen) - 1) // 2]

    def beyond(self, added: Array) -> Array:
        """(n,) what the model's own parameters do not absorb of an added force (n,) [N]."""
        weight = self.best.problem.block.weight
        return np.asarray(_project((added * self.lever)[None], self.slopes, weight)[0])

    def _along(self, effect: Effect, way: Mapping[str, float]) -> Detectable:
        """The least size along a straight way from off to some values by symbol, and beyond."""
        low, high = span(effect, way)
        # What is simulated another way as soon as it is on at all must not be seen by that alone.
        none = self.force if low == 0.0 else self._simulated(effect, point(effect, way, low))[1]
        if is_linear(effect):
            at = self._at(effect, point(effect, way, 1.0), none)
            s = inf if at is None else min(at.times, high)
        else:
            s, at = self._sought(effect, way, low, high, none)
        if at is None or not isfinite(s) or (s >= high and at.times > 1.0):
            return Detectable(effect, reason=ABSORBED)
        grown = s if is_linear(effect) else at.times
        return Detectable(effect, point(effect, way, s), grown * at.force, grown * at.beyond)

    def _sought(
        self, effect: Effect, way: Mapping[str, float], low: float, high: float, none: Array
    ) -> tuple[float, _Added | None]:
        """s at which the effect is just seen, by secants of the logarithms, and what it adds."""
        s, step = min(max(1.0, low), high), log(thresholds.SIZE_STEP)
        low *= thresholds.SIZE_STEP  # at its least value it changes nothing, by definition
        hidden, shown = log(max(low, 1e-300)), log(high)  # sizes in between which it is just seen
        nearest: tuple[float, float, _Added | None] = (inf, s, None)
        last: tuple[float, float] | None = None
        for _ in range(thresholds.SIZES_TRIED):
            at = self._at(effect, point(effect, way, s), none)
            missing = step
            if at is not None and 0.0 < at.times < inf:
                missing = log(at.times)
                nearest = min(nearest, (abs(missing), s, at), key=lambda n: n[0])
            elif at is not None and at.times == 0.0:
                missing = -step
            ends = (s <= low and missing < 0.0) or (s >= high and missing > 0.0)
            if ends or nearest[0] < thresholds.SIZE_CLOSE:
                break
            here = (log(s), missing)
            hidden, shown = (here[0], shown) if missing > 0.0 else (hidden, here[0])
            following = _following(here, last)
            if not hidden < following < shown:
                apart = isfinite(hidden) and isfinite(shown)
                following = 0.5 * (hidden + shown) if apart else min(max(following, hidden), shown)
            s, last = exp(following), here
        return nearest[1:]

    def _simulated(
        self, effect: Effect, values: Mapping[str, float]
    ) -> tuple[Model, Array, dict[str, float]]:
        """The model with an effect, its (n,) force [N] and its values.

        Raises IncompatibleEffects if the model cannot hold it.
        """
        model = Model((*self.best.effects, effect))
        full = {**self.best.values, **{effect.key(s): v for s, v in values.items()}}
        return model, model.force(self.problem.block.signals, full), full

    def _at(self, effect: Effect, values: Mapping[str, float], none: Array) -> _Added | None:
        """An effect with given values; None if it changes nothing that the model does not absorb.

        none : (n,) force with nothing of it [N]
        """
        best = self.best
        model, force, full = self._simulated(effect, values)
        added = (force - none) * self.lever
        if not np.isfinite(added).all():
            return None
        part = as_taken(best.problem, model, full)
        weight = part.block.weight
        beyond = _project(added[None], self.slopes, weight)[0]
        size = _rms(beyond, weight)
        if size <= thresholds.CV_SINGULAR * _rms(added, weight) or not weight.any():
            return None
        rest = _project(best.residual[None], beyond[None], weight)[0]
        columns = np.vstack([self.slopes, beyond])
        more = replace(
            best,
            problem=part,
            fitted=replace(best.fitted, model=model, values=full),
            cross_validated=left_out(part, columns, rest),
        )
        alone = left_out(part, self.slopes, beyond)

        def seen(times: float) -> bool:
            return all(
                self.seen(best.cross_validated + sign * times * alone, more) for sign in (1.0, -1.0)
            )

        alike = _rms(best.cross_validated, weight) / max(_rms(alone, weight), 1e-300)
        least, self.steps = _least(seen, alike, self.steps)
        return _Added(thresholds.SIZE_SURE * least, _rms(added, weight), size)

    def seen(self, without: Array, more: Hypothesis) -> bool:
        """Whether the search would take a hypothesis for better than one with such a residual."""
        fewer = replace(self.best, cross_validated=without)
        clear = compare(self.problem, fewer, more).significant
        least = thresholds.SIZE_SURE * thresholds.LEAST_ELSEWHERE
        return clear and not next_to_turns(self.problem, fewer, more, least)


@dataclass(frozen=True)
class _Added:
    """What an effect of some size adds.

    times : by which its force must grow to be seen for sure
    force, beyond : rms [N], of all of it and of what the other parameters do not absorb
    """

    times: float
    force: float
    beyond: float


def _least(seen: Callable[[float], bool], guess: float, first: int) -> tuple[float, int]:
    """The smallest factor that is seen, infinite if none is; and how many steps from a guess.

    first : steps from the guess at which the search begins; what it finds does not depend on it
    """
    base, most, k = thresholds.SIZE_STEP, thresholds.SIZE_STEPS, first
    if seen(guess * base**k):
        while seen(guess * base ** (k - 1)):
            k -= 1
            if k <= -most:
                return 0.0, first
    else:
        k += 1
        while not seen(guess * base**k):
            k += 1
            if k > most:
                return inf, first
    low, high = k - 1.0, float(k)
    while (high - low) * log(base) > thresholds.SIZE_CLOSE / 2:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if seen(guess * base**middle) else (middle, high)
    return guess * base**high, k


def _following(here: tuple[float, float], last: tuple[float, float] | None) -> float:
    """log s at which log times should be 0, by a straight line through the last two."""
    slope = -1.0
    if last is not None and last[0] != here[0]:
        slope = min(max((here[1] - last[1]) / (here[0] - last[0]), -3.0), -0.3)
    return here[0] - here[1] / slope


def _project(rows: Array, basis: Array, weight: Array) -> Array:
    """(k, n) rows without what a basis (p, n) takes of them, in weighted least squares."""
    root = np.sqrt(weight)
    scale = np.sqrt(np.einsum("ij,ij,j->i", basis, basis, weight))
    use = scale > 0.0
    if not use.any():
        return rows
    scaled = basis[use] / scale[use, None]
    taken = np.linalg.lstsq((scaled * root).T, (rows * root).T, rcond=thresholds.BASIS)[0]
    return np.asarray(rows - taken.T @ scaled)


def _rms(values: Array, weight: Array) -> float:
    total = float(weight.sum())
    return float(np.sqrt(np.dot(weight, values**2) / total)) if total > 0.0 else 0.0

"""Hypotheses with one effect more: which effects are worth a fit, and their fits."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from erdctl.core.progress import part_of
from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare, is_better, ranked
from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import Candidate, Screen
from erdctl.estimate.least_squares import NEAR, at_bound
from erdctl.estimate.starts import fresh_start
from erdctl.model.effect import Effect, Stage
from erdctl.model.slots import FeedbackSlot, GasSlot, SeriesSlot, SignSlot, ViscousSlot

DISTINCT = (SignSlot, ViscousSlot, GasSlot, SeriesSlot)  # one effect at most in each


def key_of(effects: Iterable[Effect]) -> frozenset[str]:
    """The names of effects, by which a hypothesis is known."""
    return frozenset(e.name for e in effects)


class Explored(dict[frozenset[str], Hypothesis]):
    """Hypotheses by the names of their effects; of several fits of the same, the best.

    restarts : the names of hypotheses that were also fitted from where a larger one had ended, each
        with the names of that
    asked : what was fitted so far, by all that a fit was asked for, where that may come again
    """

    def __init__(self, hypotheses: Iterable[Hypothesis]) -> None:
        super().__init__((key_of(h.effects), h) for h in hypotheses)
        self.restarts: set[tuple[frozenset[str], frozenset[str]]] = set()
        self.asked: dict[Hashable, Hypothesis | None] = {}

    def keep(self, hypothesis: Hypothesis) -> None:
        """A hypothesis, unless a better fit of the same effects is there."""
        key = key_of(hypothesis.effects)
        if key not in self or is_better(hypothesis, self[key]):
            self[key] = hypothesis


class Exploration(NamedTuple):
    """A search under way: its data, the model it begins with, what it has fitted, its executor.

    as_given : that model with the values that a user gave, before any fit
    """

    problem: Problem
    base: Hypothesis
    explored: Explored
    executor: Executor
    as_given: Hypothesis | None = None

    def added(self, hypothesis: Hypothesis) -> tuple[Effect, ...]:
        """The effects of a hypothesis that the base does not have."""
        return tuple(e for e in hypothesis.effects if e not in self.base.effects)


def without_one(x: Exploration, best: Hypothesis, effect: Effect) -> Hypothesis:
    """A hypothesis without one of its effects, fitted from where it is, if it was not yet."""
    others = tuple(e for e in best.effects if e is not effect)
    if key_of(others) not in x.explored:
        task = Task("second pass", others, (best.values,), record_effects=best.record_effects)
        x.explored.keep(*x.executor.fit_compatible(x.problem, [task]))
    return x.explored[key_of(others)]


def forward_step(
    x: Exploration, parents: Sequence[Hypothesis], candidates: Sequence[Effect], stage: str
) -> list[Hypothesis]:
    """Hypotheses with one effect more than some parents, none of them fitted before."""
    waiting: dict[frozenset[str], list[Task]] = {}
    for parent in parents:
        for seen_from, candidate in _worth_a_fit(x, parent, candidates):
            key = key_of(parent.effects) | {candidate.effect.name}
            if key not in x.explored:
                waiting.setdefault(key, []).append(with_effect(stage, seen_from, candidate))
    found = []
    while waiting:
        # Where several parents lead to one hypothesis the next is asked only if the first fails.
        fits = x.executor.fit(x.problem, [tasks.pop(0) for tasks in waiting.values()])
        for key, hypothesis in zip(list(waiting), fits, strict=True):
            if hypothesis is not None:
                x.explored.keep(hypothesis)
                found.append(hypothesis)
            if hypothesis is not None or not waiting[key]:
                del waiting[key]
    return found


def of_equivalents(
    x: Exploration, best: Hypothesis, candidates: Sequence[Effect], stage: str
) -> Hypothesis:
    """A hypothesis with the equivalent in place of its last effect, where that does better.

    Only one of the two was fitted. No force tells them apart but by a little, and what the wrong
    one leaves of it, a strong effect's, would be given names before the look-alikes are compared.
    """
    *others, effect = best.effects
    parent = x.explored[key_of(others)]
    equivalents = [e for e in candidates if e.name in effect.equivalents]
    fresh = [e for e in equivalents if key_of((*others, e)) not in x.explored]
    if fresh:
        screen = Screen(x.problem, parent, x.executor.most)
        promises = [c for e in fresh if (c := screen.candidate(e)) is not None]
        for hypothesis in x.executor.fit(
            x.problem, [with_effect(stage, parent, c) for c in promises]
        ):
            if hypothesis is not None:
                x.explored.keep(hypothesis)
    keys = [key_of((*others, e)) for e in equivalents]
    for other in ranked(x.explored[key] for key in keys if key in x.explored):
        gain = compare(x.problem, best, other)
        if gain.gain > 0.0 and not gain.tied and not gain.pays:
            return other
    return best


def with_effect(stage: str, parent: Hypothesis, candidate: Candidate) -> Task:
    """The fit of one effect more, from the parent's values."""
    starts = [{**parent.values, **guess} for guess in candidate.starts]
    series = isinstance(candidate.effect.slot, SeriesSlot)
    if series or _stuck(parent):
        # Without the lag that stands in for a compliance, or that vanished for want of the effect.
        fresh = fresh_start(*(thresholds.FRESH_SERIES if series else thresholds.FRESH))
        starts.append({**parent.values, **fresh, **candidate.starts[0]})
    effects = (*parent.effects, candidate.effect)
    return Task(stage, effects, tuple(starts), record_effects=parent.record_effects)


def _worth_a_fit(
    x: Exploration, parent: Hypothesis, candidates: Sequence[Effect]
) -> list[tuple[Hypothesis, Candidate]]:
    """The effects worth a fit together with the parent's, the most promising first, each with the
    hypothesis from which it was seen."""
    views = [parent]
    if parent is x.base and x.as_given is not None:
        # What is missing in a model bends its parameters, and far away from where they were it may
        # seem to be worth nothing: a friction that shear thinning has taken up, say.
        views.append(x.as_given)
    screens = [Screen(x.problem, view, x.executor.most) for view in views]
    found = list[tuple[Hypothesis, Candidate]]()
    tried = list(_additions(parent, candidates))
    for number, effect in enumerate(tried, start=1):
        x.executor.progress("screening", part_of(effect.name, number, len(tried)))
        seen = []
        for screen in screens:
            candidate = screen.candidate(effect)
            if candidate is not None:
                left = (1.0 - candidate.gain) * screen.square / max(screens[0].square, 1e-300)
                seen.append((screen.parent, replace(candidate, gain=1.0 - left)))
        if seen:
            found.append(max(seen, key=lambda s: s[1].gain))
    # Of two that are the same force the damper's own comes first, before an error of the rig.
    found.sort(key=lambda f: (-round(f[1].gain, 6), f[1].effect.stage is Stage.SENSOR))
    found = _one_of_each_kind(_richer_where_it_pays(found))
    bar = thresholds.SCREENED_GAIN * found[0][1].gain if found else 0.0
    # What feeds the force back can be worth nothing near the present fit and all of it elsewhere.
    return [
        (view, c) for i, (view, c) in enumerate(found)
        if i < thresholds.SCREENED_LEAST or c.gain > bar
        or (isinstance(c.effect.slot, SeriesSlot | FeedbackSlot) and not c.effect.richer_than)
    ]  # fmt: skip


def _additions(parent: Hypothesis, candidates: Sequence[Effect]) -> Iterator[Effect]:
    taken = {type(e.slot) for e in parent.effects}.intersection(DISTINCT)
    names = {e.name for e in parent.effects}
    for effect in candidates:
        other_form = any(related(effect, e) for e in parent.effects)
        if effect.name not in names and type(effect.slot) not in taken and not other_form:
            yield effect


def related(one: Effect, other: Effect) -> bool:
    """Whether one of two effects is a richer form of the other, or of its equivalents."""
    forms = ((one, other), (other, one))
    return any({e.name, *e.equivalents}.intersection(rich.richer_than) for rich, e in forms)


def _one_of_each_kind(
    seen: Sequence[tuple[Hypothesis, Candidate]],
) -> list[tuple[Hypothesis, Candidate]]:
    """Of those that no force data can tell apart the first; the others are fitted in its place."""
    kept: list[tuple[Hypothesis, Candidate]] = []
    for view, c in seen:
        if not any(c.effect.name in k.effect.equivalents for _, k in kept):
            kept.append((view, c))
    return kept


def _richer_where_it_pays(
    seen: Sequence[tuple[Hypothesis, Candidate]],
) -> list[tuple[Hypothesis, Candidate]]:
    """Without the richer forms that promise hardly more than the plain ones."""
    left = {c.effect.name: 1.0 - c.gain for _, c in seen}
    kept = []
    for view, c in seen:
        plain = [left[name] for name in c.effect.richer_than if name in left]
        if 1.0 - c.gain < thresholds.RICHER * min(plain, default=np.inf):
            kept.append((view, c))
    return kept


def _stuck(hypothesis: Hypothesis) -> bool:
    """Whether a shape parameter of the paper's was driven to a bound, from where no search returns.

    What stands in for a missing effect may be pushed as far as it goes.
    """
    ends = fresh_start(0.0, 0.0).keys() - hypothesis.problem.held.keys()
    quantities, values = hypothesis.model.quantities, hypothesis.values
    return any(at_bound(quantities[name], values[name], near=NEAR) for name in ends)

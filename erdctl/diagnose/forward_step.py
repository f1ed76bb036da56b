"""Hypotheses with one effect more: which are worth a full hypothesis, and the hypotheses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.hypothesis import Hypothesis, fresh_start
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import Candidate, Screen
from erdctl.estimate.least_squares import at_bound
from erdctl.model.effect import Effect, Slot

HOPE = 0.4  # of the most promising effect's gain: worth a full hypothesis
ALWAYS = 4  # effects that get one in any case
DISTINCT = (Slot.SIGN, Slot.VISCOUS, Slot.GAS, Slot.SERIES)  # one effect at most in each


def key_of(effects: Iterable[Effect]) -> frozenset[str]:
    """The names of effects, by which a hypothesis is known."""
    return frozenset(e.name for e in effects)


class Explored(dict[frozenset[str], Hypothesis]):
    """Hypotheses by the names of their effects; of several searches for the same, the best.

    descents : the names of hypotheses that were also searched for from where a larger one had ended,
        each with the names of that
    """

    def __init__(self, hypotheses: Iterable[Hypothesis]) -> None:
        super().__init__((key_of(t.effects), t) for t in hypotheses)
        self.restarts: set[tuple[frozenset[str], frozenset[str]]] = set()

    def keep(self, hypothesis: Hypothesis) -> None:
        """A hypothesis, unless a better one of the same effects is there."""
        key = key_of(hypothesis.effects)
        if key not in self or hypothesis.score < self[key].score:
            self[key] = hypothesis


def forward_step(
    problem: Problem,
    pool: Sequence[Hypothesis],
    candidates: Sequence[Effect],
    stage: str,
    explored: Explored,
    executor: Executor,
) -> list[Hypothesis]:
    """Hypotheses with one effect more than those of the pool, none of them seen before."""
    waiting: dict[frozenset[str], list[Task]] = {}
    for parent in pool:
        for candidate in _candidates_beside(problem, parent, candidates, executor):
            key = key_of(parent.effects) | {candidate.effect.name}
            if key not in explored:
                waiting.setdefault(key, []).append(with_effect(stage, parent, candidate))
    found = []
    while waiting:
        # Where several parents lead to one hypothesis the next is asked only if the first fails.
        hypotheses = executor.run(problem, [tasks.pop(0) for tasks in waiting.values()])
        for key, hypothesis in zip(list(waiting), hypotheses, strict=True):
            if hypothesis is not None:
                explored.keep(hypothesis)
                found.append(hypothesis)
            if hypothesis is not None or not waiting[key]:
                del waiting[key]
    return found


def _additions(parent: Hypothesis, candidates: Sequence[Effect]) -> Iterator[Effect]:
    taken = {e.slot for e in parent.effects}
    names = {e.name for e in parent.effects}
    for effect in candidates:
        if effect.name not in names and not (effect.slot in DISTINCT and effect.slot in taken):
            yield effect


def _candidates_beside(
    problem: Problem, parent: Hypothesis, candidates: Sequence[Effect], executor: Executor
) -> list[Candidate]:
    """The effects worth a full hypothesis beside the parent's, the most promising first."""
    screen = Screen(problem, parent)
    found = []
    for effect in _additions(parent, candidates):
        executor.progress("screening", effect.name)
        candidate = screen.assess(effect)
        if candidate is not None:
            found.append(candidate)
    found.sort(key=lambda p: -p.gain)
    found = _one_of_each_kind(found)
    bar = HOPE * found[0].gain if found else 0.0
    # What feeds the force back can be worth nothing near the present fit and all of it elsewhere.
    return [
        p for i, p in enumerate(found)
        if i < ALWAYS or p.gain > bar or p.effect.slot in (Slot.SERIES, Slot.FEEDBACK)
    ]  # fmt: skip


def _one_of_each_kind(found_candidates: Sequence[Candidate]) -> list[Candidate]:
    """Of those that no force data can tell apart the first; the others are tried as its look-alikes."""
    kept: list[Candidate] = []
    for p in found_candidates:
        if not any(p.effect.name in k.effect.equivalents for k in kept):
            kept.append(p)
    return kept


def with_effect(stage: str, parent: Hypothesis, candidate: Candidate) -> Task:
    """The hypothesis of one effect more, from the parent's values."""
    starts = [{**parent.values, **guess} for guess in candidate.starts]
    series = candidate.effect.slot is Slot.SERIES
    if series or _at_bound(parent):
        # Without the lag that stands in for a compliance, or that vanished for want of the effect.
        fresh = fresh_start(0.005 if series else 0.05, 0.4)
        starts.append({**parent.values, **fresh, **candidate.starts[0]})
    effects = (*parent.effects, candidate.effect)
    return Task(stage, effects, tuple(starts), record_effects=parent.record_effects)


def _at_bound(hypothesis: Hypothesis) -> bool:
    """Whether a shape parameter of the paper's was driven to a bound, from where no search returns.

    What stands in for a missing effect may be pushed as far as it goes.
    """
    ends = fresh_start(0.0, 0.0).keys() - hypothesis.problem.held.keys()
    return any(
        at_bound(hypothesis.model.quantities[name], hypothesis.values[name]) for name in ends
    )

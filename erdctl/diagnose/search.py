"""The search for effects: beam forward, look at pairs, second pass, drop what became useless.

Training cost lets false effects in, so every decision rests on groups that the fit left out, and
one hypothesis replaces another only if it is better by more than the scatter between groups.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from erdctl.diagnose.companion_effects import companion_sets, joint_task
from erdctl.diagnose.comparison import LEAST, compare
from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.forward_step import Explored, forward_step, key_of, with_effect
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis, fresh_start
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import LackOfFit, lack_of_fit_test
from erdctl.diagnose.screening import Screen
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters

BEAM = 3  # hypotheses that are extended side by side
WIDE = 3  # effects up to which they are; what comes fourth is seen beside any good three
TIE = 2.0  # below that many times their scatter two hypotheses cannot be told apart
CONFIRM = 12  # steps of a search from where another has ended


@dataclass(frozen=True, eq=False)
class Selection:
    """What the search found.

    base : the paper's model, or that of given parameters;  best : with the chosen effects
    singles : the base with every effect alone
    without : for each chosen effect, the best model that lacks it
    look-alikes : for each chosen effect, those that would do as well in its place, best first
    """

    base: Hypothesis
    best: Hypothesis
    singles: tuple[Hypothesis, ...]
    without: Mapping[str, Hypothesis]
    look_alikes: Mapping[str, tuple[tuple[str, Hypothesis], ...]]

    @property
    def named(self) -> tuple[Effect, ...]:
        """The chosen effects."""
        return _beyond(self.base, self.best)


def refit(problem: Problem, found: Selection, executor: Executor) -> Selection:
    """The same choice refitted on another problem, usually all samples, from where it was found.

    What a part of the samples spoke for and all of them do not is dropped.
    """
    again = {key_of(t.effects): t for t in (found.base, found.best, *found.without.values())}
    tasks = [
        Task("all samples", t.effects, (t.values,), CONFIRM, record_effects=t.record_effects)
        for t in again.values()
    ]
    explored = Explored(_fitted_together(t) for t in executor.run(problem, tasks))
    explored.restarts.update((key, key_of(found.best.effects)) for key in again)
    base = explored[key_of(found.base.effects)]
    best = _backward_elimination(
        problem, base, explored[key_of(found.best.effects)], explored, executor
    )
    names = [e.name for e in _beyond(base, best)]
    without = {n: explored[key_of(best.effects) - {n}] for n in names}
    look_alikes = {n: found.look_alikes[n] for n in names}
    return Selection(base, best, found.singles, without, look_alikes)


def search(
    problem: Problem,
    candidates: Sequence[Effect],
    most: int,
    executor: Executor,
    seed: int = 0,
    given: Parameters | None = None,
) -> Selection:
    """Search for the effects, at most `most`, that the recording shows beside a given model."""
    base = _base(problem, given, executor)
    explored = Explored([base])
    best, rest, singles = _forward_selection(
        problem, base, candidates, most, explored, executor, seed
    )
    if rest.significant:
        alone = best
        joint = [joint_task(problem, base, together) for together in companion_sets(candidates)]
        for hypothesis in executor.run(problem, joint):
            if hypothesis is not None and _replaces(problem, best, hypothesis):
                best = hypothesis
                explored.keep(hypothesis)
        if best is not alone:
            left = most - len(_beyond(base, best))
            best, _, _ = _forward_selection(
                problem, best, candidates, left, explored, executor, seed
            )
    best = _backward_elimination(problem, base, best, explored, executor)
    best = _second_pass(problem, base, best, most, explored, executor)
    best = _as_good_as_seen(problem, base, best, explored, executor)
    look_alikes: dict[str, tuple[tuple[str, Hypothesis], ...]] = {}
    for effect in _beyond(base, best):
        found = _look_alikes(problem, best, effect, candidates, singles, explored, executor)
        name = effect.name
        likelier = [f for f in found if _preferred(problem, f[1], best)]
        if likelier:
            name, first = likelier[0]
            found = [(effect.name, best), *(f for f in found if f[1] is not first)]
            best = first
        look_alikes[name] = tuple(found[:2])
    lesser = _without_each(problem, base, best, explored, executor)
    without = {
        e.name: hypothesis for e, hypothesis in zip(_beyond(base, best), lesser, strict=True)
    }
    return Selection(explored[key_of(base.effects)], best, tuple(singles), without, look_alikes)


def _forward_selection(
    problem: Problem,
    best: Hypothesis,
    candidates: Sequence[Effect],
    most: int,
    explored: Explored,
    executor: Executor,
    seed: int,
) -> tuple[Hypothesis, LackOfFit, list[Hypothesis]]:
    """Up to `most` effects beside those of a hypothesis, one by one, in a beam.

    Returns the best hypothesis, what remains of it, and the hypotheses of a single effect more.
    """
    pool, singles = [best], list[Hypothesis]()
    rest: LackOfFit | None = None
    for depth in range(most):
        if depth or explored.keys() > {key_of(best.effects)}:
            rest = lack_of_fit_test(best.problem, best.residual, seed)
            if not rest.hint:
                break  # more effects would have nothing to explain
        stage = f"{depth + 1} effects" if depth else "each effect"
        more = forward_step(problem, pool, candidates, stage, explored, executor)
        singles = singles if depth else more
        more.sort(key=lambda t: (t.score, len(t.model.shape)))
        better = [t for t in more if compare(problem, best, t).significant]
        if better:
            best, rest = better[0], None
        elif depth:
            break
        # Also hypotheses that gain nothing alone: one may be worth something beside another.
        pool = (better or more)[: BEAM if depth + 1 < WIDE else 1]
    return best, rest or lack_of_fit_test(best.problem, best.residual, seed), singles


def _base(problem: Problem, given: Parameters | None, executor: Executor) -> Hypothesis:
    """The model before any effect is added, from fresh starts and from the given values."""
    executor.progress("base", "the paper's model" if given is None else "the given model")
    fresh = [fresh_start(0.05, 0.4), fresh_start(0.01, 1.0)]
    if given is None:
        return fit_hypothesis(problem, (), fresh)
    starts = [*({**given.values, **f} for f in fresh), given.values]
    return fit_hypothesis(problem, given.model.effects, starts)


def _beyond(base: Hypothesis, hypothesis: Hypothesis) -> tuple[Effect, ...]:
    """The effects of a hypothesis that the base does not have."""
    return tuple(e for e in hypothesis.effects if e not in base.effects)


def _fitted_together(hypothesis: Hypothesis | None) -> Hypothesis:
    assert hypothesis is not None, "effects of a trial can act together"
    return hypothesis


def _replaces(problem: Problem, best: Hypothesis, joint: Hypothesis) -> bool:
    """Whether effects that come together replace what was found one by one."""
    return compare(problem, best, joint).significant or _preferred(problem, joint, best)


def _preferred(problem: Problem, look_alike: Hypothesis, best: Hypothesis) -> bool:
    """Whether a look-alike should have the name: it is as good with less, or better with no more."""
    extra = len(look_alike.model.quantities) - len(best.model.quantities)
    if extra < 0:
        return not compare(problem, look_alike, best).significant
    return extra == 0 and compare(problem, best, look_alike).gain > 0.0


def _without_each(
    problem: Problem, base: Hypothesis, best: Hypothesis, explored: Explored, executor: Executor
) -> list[Hypothesis]:
    """The best hypothesis without each of its effects in turn, but for those of the base.

    Searched for from where the larger one ended, too: else an effect may owe its worth to a smaller
    hypothesis that was stuck, and not to what it adds.
    """
    rests = [tuple(e for e in best.effects if e is not out) for out in _beyond(base, best)]
    new = [rest for rest in rests if (key_of(rest), key_of(best.effects)) not in explored.restarts]
    tasks = [
        Task("second pass", rest, (best.values,), record_effects=best.record_effects)
        for rest in new
    ]
    for rest, hypothesis in zip(new, executor.run(problem, tasks), strict=True):
        explored.restarts.add((key_of(rest), key_of(best.effects)))
        explored.keep(_fitted_together(hypothesis))
    return [explored[key_of(rest)] for rest in rests]


def _backward_elimination(
    problem: Problem, base: Hypothesis, best: Hypothesis, explored: Explored, executor: Executor
) -> Hypothesis:
    """Remove effects that others have made useless, the one with the least evidence first.

    Losses that scatter hides one by one may be clear together: then the last of them stays.
    """
    top = min(explored.values(), key=lambda t: t.score)
    while _beyond(base, best):
        lesser = _without_each(problem, base, best, explored, executor)
        worth = [(compare(problem, t, best), t) for t in lesser]
        useless = [(c.t_stretches, i, t) for i, (c, t) in enumerate(worth) if not c.significant]
        missed = compare(
            problem, best, top
        ).significant  # already: then it is no reason to keep anything
        idle = [
            t for *_, t in sorted(useless) if missed or not compare(problem, t, top).significant
        ]
        if not idle:
            return best
        best = idle[0]
    return best


def _second_pass(
    problem: Problem,
    base: Hypothesis,
    best: Hypothesis,
    most: int,
    explored: Explored,
    executor: Executor,
) -> Hypothesis:
    """What another effect had put in the shade may be worth its place once that one is gone."""
    key = key_of(best.effects)
    if len(_beyond(base, best)) >= most:
        return best
    more = [t for k, t in explored.items() if k > key and len(k) == len(key) + 1]
    better = [t for t in more if compare(problem, best, t).significant]
    return (
        _backward_elimination(problem, base, min(better, key=lambda t: t.score), explored, executor)
        if better
        else best
    )


def _as_good_as_seen(
    problem: Problem, base: Hypothesis, best: Hypothesis, explored: Explored, executor: Executor
) -> Hypothesis:
    """Pruning goes one way down from one hypothesis; another of that size may have done better."""
    while True:
        size = len(key_of(best.effects))
        even = [t for k, t in explored.items() if len(k) == size and t.score < best.score]
        better = [t for t in even if _preferred(problem, t, best)]
        if not better:
            return best
        best = _backward_elimination(
            problem, base, min(better, key=lambda t: t.score), explored, executor
        )


def _look_alikes(
    problem: Problem,
    best: Hypothesis,
    effect: Effect,
    candidates: Sequence[Effect],
    singles: Sequence[Hypothesis],
    explored: Explored,
    executor: Executor,
) -> list[tuple[str, Hypothesis]]:
    """Effects that explain as much in the place of one: no worse by more than scatter."""
    rest = tuple(e for e in best.effects if e is not effect)
    order = sorted(singles, key=lambda t: t.score)
    likely = [t.effects[-1] for t in order[:6]]
    likely += [c for c in candidates if c.name in effect.equivalents]
    names = key_of(best.effects)
    keys = {r.name: key_of(rest) | {r.name} for r in likely if r.name not in names}
    if key_of(rest) not in explored:
        task = Task("second pass", rest, (best.values,), record_effects=best.record_effects)
        (base,) = executor.run(problem, [task])
        explored.keep(_fitted_together(base))
    new = [r for r in dict.fromkeys(likely) if r.name in keys and keys[r.name] not in explored]
    screen = Screen(problem, explored[key_of(rest)]) if new else None
    found_candidates = [screen.assess(look_alike) for look_alike in new] if screen else []
    tasks = [
        with_effect("look-alikes", explored[key_of(rest)], p)
        for p in found_candidates
        if p is not None
    ]
    for hypothesis in executor.run(problem, tasks):
        if hypothesis is not None:
            explored.keep(hypothesis)
    found = []
    for name, key in keys.items():
        if key not in explored:
            continue
        against = compare(problem, explored[key], best)
        if (
            against.t_stretches < TIE
            or against.gain < LEAST
            or _preferred(problem, explored[key], best)
        ):
            found.append((name, explored[key]))
    found.sort(key=lambda f: f[1].score)
    return found

"""Effects that explain as much in the place of a chosen one."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare, ranked
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, key_of, related, with_effect, without_one
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import misfit_is_left
from erdctl.diagnose.screening import Candidate, Screen
from erdctl.model.effect import Effect


def is_preferred(problem: Problem, other: Hypothesis, best: Hypothesis) -> bool:
    """Whether another hypothesis should have the name.

    As good with less, better with no more, or so much better that it is worth its parameters.
    """
    extra = len(other.model.quantities) - len(best.model.quantities)
    if extra < 0:
        loss = compare(problem, other, best)
        return not loss.significant and loss.gain < thresholds.AS_GOOD
    gain = compare(problem, best, other)
    return gain.gain > 0.0 and not gain.pays if extra == 0 else gain.significant


def look_alikes(
    x: Exploration,
    best: Hypothesis,
    effect: Effect,
    candidates: Sequence[Effect],
    singles: Sequence[Hypothesis],
    untested: Sequence[Effect] = (),
) -> list[tuple[str, Hypothesis]]:
    """Effects that do as well in the place of one, the best first, each with its hypothesis.

    singles : hypotheses of one effect, the best first
    untested : effects that the log cannot show by themselves: of two duties, say, no law of the
        duty can be told. None takes a name, but what does as well is told
    """
    others = tuple(e for e in best.effects if e is not effect)
    names, rest = key_of(best.effects), key_of(others)
    parent = without_one(x, best, effect)
    promises = dict[str, Candidate]()
    alone = rest == key_of(x.base.effects)
    if alone:
        likely = [h.effects[-1] for h in singles[: thresholds.LOOK_ALIKES]]
    else:  # what promised little alone may be what the others lack
        promises = _promises(x, parent, [c for c in candidates if c.name not in names])
        bar = thresholds.SCREENED_GAIN * _taken(parent, best)
        first = sorted(promises.values(), key=lambda c: -c.gain)[: thresholds.LOOK_ALIKES]
        likely = [c.effect for c in first if c.gain > bar]
    again = [] if alone else list(likely)
    # In the place of an effect those may differ that nothing tells apart where they are alone.
    alike = {name for e in (effect, *likely) for name in e.equivalents}
    likely += [c for c in candidates if c.name in alike or related(c, effect)]
    likely += untested
    likely += [c for c in candidates if rest | {c.name} in x.explored]
    likely = [c for c in likely if not any(related(c, e) for e in others)]
    keys = {e.name: rest | {e.name} for e in likely if e.name not in names}
    new = [e for e in dict.fromkeys(likely) if e.name in keys and keys[e.name] not in x.explored]
    if new:
        promises |= _promises(x, parent, [e for e in new if e.name not in promises])
        worth = [promises[e.name] for e in new if e.name in promises]
        tasks = [
            with_effect("look-alikes", parent, c)
            for c in worth if c.gain > 0.0 or c.effect not in untested
        ]  # fmt: skip
        _keep(x, tasks)
    _keep(x, [_instead(parent, promises[e.name], best) for e in again])
    room = _misfit_leaves(x, rest, best)
    richer = {c.name for c in likely if c.richer_than and related(c, effect)}
    found = {}
    for name, key in keys.items():
        other = x.explored.get(key)
        if other is None:
            continue
        gain = compare(x.problem, other, best)
        near = gain.before - gain.after <= room
        # A richer form holds the effect itself: no other explanation, unless it has the name.
        if (name not in richer and (gain.tied or near)) or is_preferred(x.problem, other, best):
            found[key] = name
    return [(found[key_of(h.effects)], h) for h in ranked(x.explored[key] for key in found)]


def _taken(rest: Hypothesis, best: Hypothesis) -> float:
    """Part of the mean square of what a smaller hypothesis leaves that the best one takes."""
    left = [h.rms**2 for h in (best, rest)]
    return float(1.0 - left[0] / max(left[1], 1e-300))


def _instead(parent: Hypothesis, candidate: Candidate, best: Hypothesis) -> Task:
    """The fit of one effect beside those of a parent, in place of one of the best hypothesis.

    From where the others are in that: without what is replaced they may be far from it, and a fit
    from there stuck.
    """
    beside = {name: best.values[name] for name in parent.values}
    return Task(
        "look-alikes", (*parent.effects, candidate.effect), ({**beside, **candidate.starts[0]},),
        record_effects=best.record_effects,
    )  # fmt: skip


def _keep(x: Exploration, tasks: Sequence[Task]) -> None:
    for hypothesis in x.executor.fit(x.problem, tasks):
        if hypothesis is not None:
            x.explored.keep(hypothesis)


def _promises(
    x: Exploration, parent: Hypothesis, effects: Sequence[Effect]
) -> dict[str, Candidate]:
    """What effects promise beside those of a hypothesis, by name; of those that can be there."""
    if not effects:
        return {}
    screen = Screen(x.problem, parent, x.executor.most)
    promises = (screen.candidate(e) for e in effects)
    return {c.effect.name: c for c in promises if c is not None}


def _misfit_leaves(x: Exploration, rest: frozenset[str], best: Hypothesis) -> float:
    """Difference of mean squares that two hypotheses may have and still be alike [N^2].

    Where noise alone is left their residuals tell them apart, and this is 0. What is left of
    physics speaks for either by chance, however many samples repeat it: then only what is beyond
    the scatter of a mean square over the groups does, of what is left, or of what the effect takes
    if that is less.
    """
    if not misfit_is_left(best):
        return 0.0
    worth = compare(x.problem, x.explored[rest], best)
    return worth.scatter * min(worth.after, worth.before - worth.after)

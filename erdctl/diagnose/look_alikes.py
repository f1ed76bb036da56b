"""Effects that explain as much in the place of a chosen one."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare, ranked
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, key_of, with_effect
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import misfit_is_left
from erdctl.diagnose.screening import Screen
from erdctl.model.effect import Effect


def is_preferred(problem: Problem, other: Hypothesis, best: Hypothesis) -> bool:
    """Whether another hypothesis should have the name.

    As good with less, better with no more, or so much better that it is worth its parameters.
    """
    extra = len(other.model.quantities) - len(best.model.quantities)
    if extra < 0:
        return not compare(problem, other, best).significant
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
    likely = [h.effects[-1] for h in singles[: thresholds.LOOK_ALIKES]]
    likely += [c for c in candidates if c.name in effect.equivalents]
    likely += untested
    names, rest = key_of(best.effects), key_of(others)
    likely += [c for c in candidates if rest | {c.name} in x.explored]
    keys = {e.name: rest | {e.name} for e in likely if e.name not in names}
    if rest not in x.explored:
        task = Task("second pass", others, (best.values,), record_effects=best.record_effects)
        x.explored.keep(*x.executor.fit_compatible(x.problem, [task]))
    new = [e for e in dict.fromkeys(likely) if e.name in keys and keys[e.name] not in x.explored]
    if new:
        parent = x.explored[rest]
        screen = Screen(x.problem, parent, x.executor.most)
        promises = [screen.candidate(e) for e in new]
        worth = [
            c for c in promises if c is not None and (c.gain > 0.0 or c.effect not in untested)
        ]
        tasks = [with_effect("look-alikes", parent, c) for c in worth]
        for hypothesis in x.executor.fit(x.problem, tasks):
            if hypothesis is not None:
                x.explored.keep(hypothesis)
    room = _misfit_leaves(x, rest, best)
    found = {}
    for name, key in keys.items():
        other = x.explored.get(key)
        if other is None:
            continue
        gain = compare(x.problem, other, best)
        near = gain.before - gain.after <= room
        if gain.tied or near or is_preferred(x.problem, other, best):
            found[key] = name
    return [(found[key_of(h.effects)], h) for h in ranked(x.explored[key] for key in found)]


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

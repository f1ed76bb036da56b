"""Hypotheses with one effect less: what others have made useless goes again."""

from __future__ import annotations

from erdctl.diagnose.comparison import compare_alike, is_better, ranked
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, key_of
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.look_alikes import is_preferred


def without_each(x: Exploration, best: Hypothesis) -> list[Hypothesis]:
    """The best hypothesis without each of its effects in turn, but for those of the base.

    Fitted from where the larger one ended, too: else an effect may owe its worth to a smaller
    hypothesis whose search was stuck, and not to what it adds.
    """
    all_, explored = key_of(best.effects), x.explored
    smaller = [tuple(e for e in best.effects if e is not out) for out in x.added(best)]
    new = [effects for effects in smaller if (key_of(effects), all_) not in explored.restarts]
    tasks = [
        Task("second pass", effects, (best.values,), record_effects=best.record_effects)
        for effects in new
    ]
    for effects, found in zip(new, x.executor.fit_compatible(x.problem, tasks), strict=True):
        explored.restarts.add((key_of(effects), all_))
        explored.keep(found)
    return [explored[key_of(effects)] for effects in smaller]


def eliminate(x: Exploration, best: Hypothesis) -> Hypothesis:
    """Remove effects that others have made useless, the one with the least evidence first.

    Losses that are not significant one by one may be so together: then the last of them stays,
    unless the model does no worse without it: what does not help on unseen data is no finding,
    however good another hypothesis is.
    """
    top = ranked(x.explored.values())[0]
    while x.added(best):
        smaller = without_each(x, best)
        loss = [(compare_alike(x.problem, h, best), h) for h in smaller]
        useless = [(c.t_stretches, i, h) for i, (c, h) in enumerate(loss) if not c.significant]
        harmful = [(c.gain, i, h) for i, (c, h) in enumerate(loss) if not c.gain > 0.0]
        if harmful:
            best = min(harmful)[-1]
            continue
        # Where the present one misses the best hypothesis already, that keeps nothing.
        behind = compare_alike(x.problem, best, top).significant
        idle = [
            h for *_, h in sorted(useless)
            if behind or not compare_alike(x.problem, h, top).significant
        ]  # fmt: skip
        if not idle:
            return best
        best = idle[0]
    return best


def second_pass(x: Exploration, best: Hypothesis, most: int) -> Hypothesis:
    """What another effect had made useless may be worth its place once that one is gone."""
    key = key_of(best.effects)
    if len(x.added(best)) >= most:
        return best
    more = [h for k, h in x.explored.items() if k > key and len(k) == len(key) + 1]
    better = [h for h in more if compare_alike(x.problem, best, h).significant]
    return eliminate(x, ranked(better)[0]) if better else best


def as_good_as_explored(x: Exploration, best: Hypothesis) -> Hypothesis:
    """Elimination goes one way down from one hypothesis; another of that size may do better.

    Or as well with fewer parameters. What is left of that other one must do as well, too: two steps
    down that are not significant one by one may be so together.
    """
    seen = set[frozenset[str]]()
    while key_of(best.effects) not in seen:
        seen.add(key_of(best.effects))
        count = len(best.model.quantities)
        even = [
            h for k, h in x.explored.items()
            if len(k) == len(best.effects) and k not in seen
            and (is_better(h, best) or len(h.model.quantities) < count)
        ]  # fmt: skip
        for other in ranked(h for h in even if is_preferred(x.problem, h, best)):
            left = eliminate(x, other)
            if left is other or not compare_alike(x.problem, left, best).significant:
                best = left
                break
    return best

"""Other dips of the cost of a hypothesis, in which its effects lie once more are beside them."""

from __future__ import annotations

from erdctl.core.progress import part_of
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, key_of, without_one
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.screening import Screen
from erdctl.model.effect import Effect


def deepest_dip(x: Exploration, best: Hypothesis) -> Hypothesis:
    """The hypothesis itself, or the same effects from where one of them begins anew, if better.

    The cost of a joint, or of what feeds the force back, has several dips, and the deepest one
    beside few effects need not be so beside more: what is still missing can make a joint stiff that
    is soft. The last effect began beside all others.
    """
    for effect in x.added(best)[:-1]:
        if not _has_dips(effect):
            continue
        rest = without_one(x, best, effect)
        x.executor.progress("other dips", part_of(effect.name, 1, 1))
        found = Screen(x.problem, rest, x.executor.most).candidate(effect)
        if found is None:
            continue
        starts = tuple({**best.values, **start} for start in found.starts)
        task = Task("other dips", best.effects, starts, record_effects=best.record_effects)
        for hypothesis in x.executor.fit(x.problem, [task]):
            if hypothesis is not None:
                x.explored.keep(hypothesis)
        best = x.explored[key_of(best.effects)]
    return best


def _has_dips(effect: Effect) -> bool:
    """Whether the force depends on a parameter of it in more than proportion."""
    return bool(effect.shape) and not effect.smooth

"""Richer forms of effects: tried in the place of the plain ones, and kept only where they earn it.

A form with a parameter more fits at least as well, and would take the names of what it holds.
"""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.diagnose import thresholds
from erdctl.diagnose.carry_over import carries_over_as_well
from erdctl.diagnose.comparison import compare_alike
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, related
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.residual.predictability import misfit_is_left
from erdctl.diagnose.screening import starts
from erdctl.model.effect import Effect


def in_the_place_of_plain(
    x: Exploration, best: Hypothesis, candidates: Sequence[Effect]
) -> Hypothesis:
    """A hypothesis with a richer form in place of all its plain ones, where it earns that, and
    carries over to other motions as well."""
    for effect in candidates:
        plain = tuple(e for e in x.added(best) if related(effect, e))
        if effect.richer_than and plain and effect not in best.effects:
            guesses = starts(effect, x.problem, best.residual)
            points = [{effect.key(s): v for s, v in g.items()} for g in guesses]
            best = _changed(x, best, plain, (effect,), points, earned=True)
    return best


def plain_where_as_good(
    x: Exploration, best: Hypothesis, candidates: Sequence[Effect]
) -> Hypothesis:
    """A hypothesis with the plain forms together in place of each richer one that does not earn its
    name."""
    for effect in x.added(best):
        plain = tuple(e for e in candidates if e.name in effect.richer_than)
        if plain:
            own = effect.local(best.values)
            point = {e.key(q.symbol): own[q.symbol] for e in plain for q in e.quantities}
            best = _changed(x, best, (effect,), plain, [point], earned=False)
    return best


def earns_it(x: Exploration, plain: Hypothesis, richer: Hypothesis) -> bool:
    """Whether a richer form is better by more than chance, and where a misfit is left by more than
    a little of it: of what is left of physics some speaks for either form."""
    found = compare_alike(x.problem, plain, richer)
    much = 1.0 - found.gain < thresholds.RICHER
    return found.significant and (much or not misfit_is_left(richer))


def _changed(
    x: Exploration,
    best: Hypothesis,
    out: Sequence[Effect],
    into: Sequence[Effect],
    points: Sequence[dict[str, float]],
    *,
    earned: bool,
) -> Hypothesis:
    effects = (*(e for e in best.effects if e not in out), *into)
    begun = tuple({**best.values, **point} for point in points)
    task = Task(
        "together", effects, begun, thresholds.STEPS_TOGETHER,
        thresholds.COMPANION_BEST if len(begun) > 1 else None, best.record_effects,
    )  # fmt: skip
    (other,) = x.executor.fit(x.problem, [task])
    if other is None:
        return best
    if earned:
        takes = earns_it(x, best, other) and carries_over_as_well(x, other, best)
    else:
        takes = not earns_it(x, other, best)
    if takes:
        x.explored.keep(other)
    return other if takes else best

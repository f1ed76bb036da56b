"""The smallest correction of the rest that carries over: one law after the other.

Each is a hypothesis as an effect of the catalogue is: screened, fitted with all other parameters
beside it, and taken only if it predicts what its fits have not seen by more than chance, picked as
it was among many.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from erdctl.core.progress import part_of
from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import eliminate, without_each
from erdctl.diagnose.carry_over import to_other_motions
from erdctl.diagnose.comparison import compare, compare_alike, critical_of, ranked
from erdctl.diagnose.executor import Executor
from erdctl.diagnose.forward_step import Exploration, Explored, key_of, with_effect
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.learning.closed_forms import closed_forms
from erdctl.diagnose.learning.laws import finer, laws, swings
from erdctl.diagnose.levels_of_records import beyond_levels
from erdctl.diagnose.look_alikes import is_preferred
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import lack_of_fit_test
from erdctl.diagnose.screening import Candidate, Screen
from erdctl.diagnose.search import Selection
from erdctl.model.effect import Effect
from erdctl.model.learned.coordinates import along
from erdctl.model.learned.law import Law, LearnedEffect


def learn(
    problem: Problem,
    base: Hypothesis,
    named: Hypothesis,
    candidates: Sequence[Effect],
    line: float | None,
    executor: Executor,
    seed: int,
) -> Selection:
    """The laws that a model lacks, if there are any, beside the effects that it still needs.

    An effect that had stood in for what a law says goes. What an effect says as well, once another
    law takes its part of the misfit, is no law.

    base : the model to answer for;  named : with the effects that were found
    candidates : the effects that the log can show
    line : frequency of a line that the rest holds, on all samples [Hz]: the few of a search are too
        far apart to show it
    """
    x = Exploration(problem, base, Explored([base, named]), executor)
    best = named
    rivals: dict[str, list[Hypothesis]] = {}
    for number in range(1, thresholds.MOST_LAWS + 1):
        if number > 1 and not lack_of_fit_test(best.problem, best.residual, seed).hint:
            break
        stage = f"law {number}"
        promising = _screened(x, best, laws(problem))
        if line is not None:
            promising += swings(problem, line)
        more = _fitted(x, best, promising, stage)
        critical = critical_of(problem, best, more)
        better = [
            h for h in more
            if compare_alike(problem, best, h).beyond(critical)
            and beyond_levels(problem, best, h, critical)
        ]  # fmt: skip
        if not better:
            break
        found = _sharpened(x, best, better[0], stage)
        rivals[found.effects[-1].name] = [
            h for h in better[1:] if _apart(h, found) and compare(problem, h, better[0]).tied
        ]
        best = _catalogued(x, found, candidates, stage)
    if best is not named:
        best = to_other_motions(x, eliminate(x, best), or_records=True)
    names = [e.name for e in x.added(best)]
    without = dict(zip(names, without_each(x, best), strict=True))
    alike = {n: tuple((h.effects[-1].name, h) for h in rivals.get(n, ())) for n in names}
    return Selection(x.explored[key_of(base.effects)], best, (), without, alike)


def _catalogued(
    x: Exploration, best: Hypothesis, candidates: Sequence[Effect], stage: str
) -> Hypothesis:
    """A hypothesis with an effect in the place of each law that one says as well."""
    known = key_of(best.effects)
    for rest in without_each(x, best):
        (gone,) = (e for e in best.effects if e.name not in key_of(rest.effects))
        if isinstance(gone, LearnedEffect):
            tried = [e for e in candidates if e.name not in known]
            for h in _fitted(x, rest, _promising(x, rest, tried), stage):
                if is_preferred(x.problem, h, best):
                    return _catalogued(x, h, candidates, stage)
    return best


def learned_in(effects: Iterable[Effect]) -> list[LearnedEffect]:
    """Those of some effects that were learned."""
    return [e for e in effects if isinstance(e, LearnedEffect)]


def _apart(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether their last laws differ in more than the form of the curve."""
    return _what(_law(one)[0]) != _what(_law(other)[0])


def _screened(x: Exploration, parent: Hypothesis, tried: Iterable[Law]) -> list[Candidate]:
    """The laws that promise most beside a parent."""
    x.executor.progress("screening", part_of("laws to learn", 1, 1))
    known = key_of(parent.effects)
    taken = {_what(e.law) for e in learned_in(parent.effects) if not e.law.curve.kind.late}
    new = (law for law in tried if law.name not in known and _what(law) not in taken)
    return _promising(x, parent, (law.effect for law in new))


def _what(law: Law) -> tuple[str, str]:
    """The slot and the coordinate; a curve over x can be any over its size."""
    return law.slot, law.curve.coordinate.removeprefix("abs_")


def _promising(x: Exploration, parent: Hypothesis, tried: Iterable[Effect]) -> list[Candidate]:
    """The effects that promise most beside a parent."""
    screen = Screen(x.problem, parent, x.executor.most)
    found = [screen.candidate(effect) for effect in tried]
    best = sorted((c for c in found if c is not None), key=lambda c: -c.gain)
    return best[: thresholds.LAWS_FITTED]


def _fitted(
    x: Exploration, parent: Hypothesis, candidates: Iterable[Candidate], stage: str
) -> list[Hypothesis]:
    """Some laws fitted beside a parent, the best first."""
    tasks = [with_effect(stage, parent, c) for c in candidates]
    found = [h for h in x.executor.fit(x.problem, tasks) if h is not None]
    for h in found:
        x.explored.keep(h)
    return ranked(found)


def _sharpened(x: Exploration, parent: Hypothesis, found: Hypothesis, stage: str) -> Hypothesis:
    """A law with more knots where these pay, and in a closed form where one does as well."""
    law, values = _law(found)
    if law.curve.form is not None:
        return found
    while (more := finer(x.problem, law, values.get("tau"))) is not None:
        better = _fitted(x, parent, _screened(x, parent, [more]), stage)
        if not (better and is_preferred(x.problem, better[0], found)):
            break
        found = better[0]
        law, values = _law(found)
    s, weight = x.problem.block.signals, x.problem.block.weight
    z = along(law.curve.coordinate, s, values.get("tau"))
    z = z[(weight > 0.0) & np.isfinite(z)]
    forms = [
        Candidate(new.effect, 0.0, ({new.effect.key(symbol): v for symbol, v in own.items()},))
        for new, own in closed_forms(law, values, z)
    ]
    alike = [h for h in _fitted(x, parent, forms, stage) if compare(x.problem, h, found).tied]
    # A power of 0.99 is a line.
    return min(alike, key=lambda h: len(h.model.quantities), default=found)


def _law(hypothesis: Hypothesis) -> tuple[Law, dict[str, float]]:
    """The law that was added last, and its own values."""
    effect = hypothesis.effects[-1]
    assert isinstance(effect, LearnedEffect)
    return effect.law, effect.local(hypothesis.values)

"""The smallest correction of the rest that carries over: one law after the other.

Each is a hypothesis as an effect of the catalogue is: screened, fitted with all other parameters
beside it, and taken only if it predicts what its fits have not seen by more than chance, picked as
it was among many.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import eliminate, without_each
from erdctl.diagnose.carry_over import to_every_kind, to_other_motions
from erdctl.diagnose.comparison import compare, compare_alike, critical_of, ranked
from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.forward_step import Exploration, Explored, key_of, with_effect
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.learning.closed_forms import closed_forms
from erdctl.diagnose.learning.laws import finer, swings
from erdctl.diagnose.learning.promising import (
    Promising,
    learned_in,
    place_of,
    promising,
    promising_laws,
    screened,
)
from erdctl.diagnose.learning.replaced_terms import takes_the_place_of_a_term
from erdctl.diagnose.learning.unseen_corners import goes_beyond_what_was_seen
from erdctl.diagnose.levels_of_records import beyond_levels
from erdctl.diagnose.look_alikes import is_preferred
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import lack_of_fit_of, search_is_worthwhile
from erdctl.diagnose.screening import Candidate
from erdctl.diagnose.search import Selection
from erdctl.estimate.least_squares import at_bound
from erdctl.model.effect import Effect
from erdctl.model.learned.coordinates import Memory, along
from erdctl.model.learned.forms import FORMS
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
    best, rivals = named, dict[str, list[Hypothesis]]()
    first = promising_laws(x, named, wide=True)
    if line is not None or not first.halved_by_two:
        best, rivals = _laws(x, named, first.plain, line, seed, wide=False)
    if search_is_worthwhile(best, seed):
        # A law over two coordinates can be an effect and a law at once: it comes where these fail.
        wide, others = _laws(x, named, first, line, seed, wide=True)
        if wide is not named and is_preferred(problem, wide, best):
            best, rivals = wide, others
    if best is not named:
        best = _catalogued(x, best, candidates)
        best = to_other_motions(x, eliminate(x, best), or_records=True)
        best = to_every_kind(x, best)
    names = [e.name for e in x.added(best)]
    without = dict(zip(names, without_each(x, best), strict=True))
    alike = {n: tuple((h.effects[-1].name, h) for h in rivals.get(n, ())) for n in names}
    return Selection(x.explored[key_of(base.effects)], best, (), without, alike)


def _laws(
    x: Exploration, named: Hypothesis, first: Promising, line: float | None, seed: int, *,
    wide: bool,
) -> tuple[Hypothesis, dict[str, list[Hypothesis]]]:  # fmt: skip
    """A hypothesis with laws, one after the other, and what does as well in the place of each.

    first : what promises most beside what is named
    wide : over two coordinates, too, and in the place of names. A further one over two only where
        much is left: else it would say what the few knots of the first leave.
    """
    best, rivals, least = named, dict[str, list[Hypothesis]](), 0.0
    for number in range(1, thresholds.MOST_LAWS + 1):
        if number > 1 and not search_is_worthwhile(best, seed):
            break
        stage = f"law {number}"
        two = wide and number > 1 and _leaves_much(named, best, seed)
        likely = first if number == 1 else promising_laws(x, best, wide=two)
        found, others = _beside(x, best, likely, line, stage, least)
        if wide and number == 1 and x.added(named) and _leaves_much(named, found, seed):
            anew, instead = _in_place_of_names(x, named, line, stage)
            if anew and is_preferred(x.problem, anew, found or named):
                found, others = anew, instead
        if found is None:
            break
        least = least or thresholds.LAW_PART * _taken(x.problem, best, found)
        rivals[learned_in(found.effects)[-1].name] = others
        best = found
    return best, rivals


def _leaves_much(parent: Hypothesis, found: Hypothesis | None, seed: int) -> bool:
    """Whether a law, if there is any, leaves so much that a name may hide where it acts."""
    if found is None:
        return True
    if not search_is_worthwhile(found, seed):
        return False
    before, after = (lack_of_fit_of(h, seed).misfit_rms ** 2 for h in (parent, found))
    return after > thresholds.HIDDEN * before


def _square(hypothesis: Hypothesis) -> float:
    """The cross-validated mean square [N^2]."""
    weight = hypothesis.problem.block.weight
    return float(np.average(hypothesis.cross_validated**2, weights=weight))


def _taken(problem: Problem, parent: Hypothesis, found: Hypothesis) -> float:
    """What a hypothesis takes of the cross-validated mean square of another [N^2]."""
    gain = compare(problem, parent, found)
    return gain.before - gain.after


def _promised(parent: Hypothesis, tried: Sequence[Candidate]) -> float:
    """What some laws may take at most of the cross-validated mean square of a parent [N^2]."""
    most = max((c.gain for c in tried), default=0.0)
    return thresholds.PROMISED * most * _square(parent)


def _beside(
    x: Exploration, parent: Hypothesis, likely: Promising, line: float | None, stage: str,
    least: float = 0.0,
) -> tuple[Hypothesis | None, list[Hypothesis]]:  # fmt: skip
    """A parent with one law more, if any carries over, and those that do as well in its place.

    least : that it must take of the mean square [N^2]
    """
    tried = [*likely.curves, *likely.surfaces]
    if line is not None:
        tried += swings(x.problem, line)
    elif _promised(parent, tried) < least:
        return None, []
    more = _fitted(x, parent, tried, stage)
    critical = critical_of(x.problem, parent, more)
    better = [
        h for h in more
        if compare_alike(x.problem, parent, h).beyond(critical)
        and beyond_levels(x.problem, parent, h, critical)
        and not takes_the_place_of_a_term(parent, h)
        and not goes_beyond_what_was_seen(h)
    ]  # fmt: skip
    if not better or _taken(x.problem, parent, better[0]) < least:
        return None, []
    found = _of_fewest(x, parent, better, stage)
    best = better[0]
    alike = [h for h in better if _apart(h, found) and compare(x.problem, h, best).tied]
    return found, alike


def _in_place_of_names(
    x: Exploration, named: Hypothesis, line: float | None, stage: str
) -> tuple[Hypothesis | None, list[Hypothesis]]:
    """A law beside the model to answer for, and then what the names still say beside it.

    A name that stood in for what no effect says also hides where that acts.
    """
    found, alike = _beside(x, x.base, promising_laws(x, x.base, wide=True), line, stage)
    if found is None:
        return None, []
    effects = (*x.added(named), found.effects[-1])
    start = {**named.values, **found.values}
    task = Task(stage, (*x.base.effects, *effects), (start,), record_effects=found.record_effects)
    both = [h for h in x.executor.fit(x.problem, [task]) if h is not None]
    for h in both:
        x.explored.keep(h)
    better = [h for h in both if is_preferred(x.problem, h, found)]
    return (better or [found])[0], alike


def _catalogued(x: Exploration, best: Hypothesis, candidates: Sequence[Effect]) -> Hypothesis:
    """A hypothesis with an effect in the place of each law that one says as well."""
    known = key_of(best.effects)
    for rest in without_each(x, best):
        (gone,) = (e for e in best.effects if e.name not in key_of(rest.effects))
        if isinstance(gone, LearnedEffect):
            tried = [e for e in candidates if e.name not in known]
            likely = promising(x, rest, tried, thresholds.NAMES_FITTED)
            for h in _fitted(x, rest, likely, "names of laws"):
                if is_preferred(x.problem, h, best):
                    return _catalogued(x, h, candidates)
    return best


def _apart(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether their last laws differ in more than the form of the curve."""
    return place_of(_law(one)[0]) != place_of(_law(other)[0])


def _fitted(
    x: Exploration, parent: Hypothesis, candidates: Iterable[Candidate], stage: str
) -> list[Hypothesis]:
    """Some laws fitted beside a parent, the best first; what was fitted before is not again."""
    tasks = {_asked(t): t for t in (with_effect(stage, parent, c) for c in candidates)}
    known = x.explored.asked
    new = {key: task for key, task in tasks.items() if key not in known}
    known.update(zip(new, x.executor.fit(x.problem, list(new.values())), strict=True))
    found = [h for h in map(known.get, tasks) if h is not None]
    for h in found:
        x.explored.keep(h)
    return ranked(found)


def _asked(task: Task) -> Hashable:
    """What a task asks for."""
    effects = ((e.name, e.law) if isinstance(e, LearnedEffect) else e.name for e in task.effects)
    starts = (tuple(start.items()) for start in task.starts)
    return tuple(effects), tuple(starts)


def _of_fewest(
    x: Exploration, parent: Hypothesis, better: Sequence[Hypothesis], stage: str
) -> Hypothesis:
    """The best of some laws over one coordinate, unless one over two is worth its parameters."""
    plain = [h for h in better if len(_law(h)[0].curve.axes) == 1]
    wide = [h for h in better if h not in plain]
    if not plain:
        return wide[0]
    if wide:
        parts = [_taken(x.problem, parent, h) for h in (plain[0], wide[0])]
        if parts[0] < thresholds.MOST_OF_IT * parts[1]:
            return wide[0]  # to sharpen the other one would not make up for it
    found = _sharpened(x, parent, plain[0], stage)
    return wide[0] if wide and is_preferred(x.problem, wide[0], found) else found


def _sharpened(x: Exploration, parent: Hypothesis, found: Hypothesis, stage: str) -> Hypothesis:
    """A law with more knots where these pay, and in a closed form where one does as well."""
    law, values = _law(found)
    if law.curve.form is not None:
        return found
    while (more := finer(x.problem, law, Memory.of(values))) is not None:
        better = _fitted(x, parent, screened(x, parent, [more]), stage)
        better = [h for h in better if not goes_beyond_what_was_seen(h)]
        if not (better and is_preferred(x.problem, better[0], found)):
            break
        found = better[0]
        law, values = _law(found)
    s, weight = x.problem.block.signals, x.problem.block.weight
    z = along(law.curve.coordinate, s, Memory.of(values))
    z = z[(weight > 0.0) & np.isfinite(z)]
    forms = [
        Candidate(new.effect, 0.0, ({new.effect.key(symbol): v for symbol, v in own.items()},))
        for new, own in closed_forms(law, values, z)
    ]
    fits = [
        h
        for h in _fitted(x, parent, forms, stage)
        if not (_at_an_end(h) or _untold(h, z) or goes_beyond_what_was_seen(h))
    ]
    alike = [h for h in fits if compare(x.problem, h, found).tied]
    # A power of 0.99 is a line.
    return min(alike, key=lambda h: len(h.model.quantities), default=found)


def _at_an_end(hypothesis: Hypothesis) -> bool:
    """Whether a parameter of the last law is as large as can be: then it is of another form."""
    effect = hypothesis.effects[-1]
    return any(at_bound(q, hypothesis.values[effect.key(q.symbol)]) for q in effect.quantities)


def _untold(hypothesis: Hypothesis, z: Array) -> bool:
    """Whether the form of the last law swings or bulges between samples (n,) of its coordinate."""
    law, own = _law(hypothesis)
    assert law.curve.form is not None
    return own.get("w", np.inf) < FORMS[law.curve.form].narrowest(z)


def _law(hypothesis: Hypothesis) -> tuple[Law, dict[str, float]]:
    """The law that was added last, and its own values."""
    effect = hypothesis.effects[-1]
    assert isinstance(effect, LearnedEffect)
    return effect.law, effect.local(hypothesis.values)

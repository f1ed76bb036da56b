"""The smallest correction of the rest that carries over: one law after the other.

Each is a hypothesis as an effect of the catalogue is: screened, fitted with all other parameters
beside it, and taken only if it predicts what its fits have not seen by more than chance, picked as
it was among many.
"""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import eliminate, without_each
from erdctl.diagnose.carry_over import to_every_kind, to_other_motions
from erdctl.diagnose.comparison import compare, compare_alike, critical_of
from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.forward_step import Exploration, Explored, key_of
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.learning.law_fits import fitted, law_of, promised, taken
from erdctl.diagnose.learning.law_form import of_fewest
from erdctl.diagnose.learning.laws import swings
from erdctl.diagnose.learning.promising import (
    Promising,
    learned_in,
    place_of,
    promising,
    promising_laws,
)
from erdctl.diagnose.learning.replaced_terms import (
    said_again,
    still_act,
    takes_the_place_of_a_term,
)
from erdctl.diagnose.learning.unseen_corners import goes_beyond_what_was_seen
from erdctl.diagnose.levels_of_records import beyond_levels
from erdctl.diagnose.look_alikes import is_preferred
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import lack_of_fit_of, search_is_worthwhile
from erdctl.diagnose.search import Selection
from erdctl.model.effect import Effect
from erdctl.model.learned.law import LearnedEffect


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
    law takes its part of the misfit, is no law. Nor does a law take the place of a name whose part
    of the force it makes again, however much better it fits: the name stays, in the base of what is
    selected, and what is learned is the rest of its form.

    base : the model to answer for;  named : with the effects that were found
    candidates : the effects that the log can show
    line : frequency of a line that the rest holds, on all samples [Hz]: the few of a search are too
        far apart to show it
    """
    x = Exploration(problem, base, Explored([base, named]), executor)
    best, rivals = _learned(x, named, candidates, line, seed)
    if again := said_again(named, best):
        start, free = (named.values,), named.record_effects
        task = Task("names", (*base.effects, *again), start, record_effects=free)
        (with_names,) = executor.fit_compatible(problem, [task])
        x.explored.keep(with_names)
        y = x._replace(base=with_names)
        beside, others = _learned(y, named, candidates, line, seed)
        if learned_in(beside.effects) and still_act(again, with_names, beside):
            x, best, rivals = y, beside, others
    names = [e.name for e in x.added(best)]
    without = dict(zip(names, without_each(x, best), strict=True))
    alike = {n: tuple((h.effects[-1].name, h) for h in rivals.get(n, ())) for n in names}
    return Selection(x.explored[key_of(x.base.effects)], best, (), without, alike)


def _learned(
    x: Exploration, named: Hypothesis, candidates: Sequence[Effect], line: float | None, seed: int
) -> tuple[Hypothesis, dict[str, list[Hypothesis]]]:
    """A hypothesis with the laws that carry over, and what does as well in the place of each.

    The effects of the base stay; of the others those that are needed beside the laws.
    """
    best, rivals = named, dict[str, list[Hypothesis]]()
    first = promising_laws(x, named, wide=True)
    if line is not None or not first.halved_by_two:
        best, rivals = _laws(x, named, first.plain, line, seed, wide=False)
    if search_is_worthwhile(best, seed):
        # A law over two coordinates can be an effect and a law at once: it comes where these fail.
        wide, others = _laws(x, named, first, line, seed, wide=True)
        if wide is not named and is_preferred(x.problem, wide, best):
            best, rivals = wide, others
    if best is not named:
        best = _catalogued(x, best, candidates)
        best = to_other_motions(x, eliminate(x, best), or_records=True)
        best = to_every_kind(x, best)
    return best, rivals


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
        least = least or thresholds.LAW_PART * taken(x.problem, best, found)
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
    elif promised(parent, tried) < least:
        return None, []
    more = fitted(x, parent, tried, stage)
    critical = critical_of(x.problem, parent, more)
    better = [
        h for h in more
        if compare_alike(x.problem, parent, h).beyond(critical)
        and beyond_levels(x.problem, parent, h, critical)
        and not takes_the_place_of_a_term(parent, h)
        and not goes_beyond_what_was_seen(h)
    ]  # fmt: skip
    if not better or taken(x.problem, parent, better[0]) < least:
        return None, []
    found = of_fewest(x, parent, better, stage)
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
            for h in fitted(x, rest, likely, "names of laws"):
                if is_preferred(x.problem, h, best):
                    return _catalogued(x, h, candidates)
    return best


def _apart(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether their last laws differ in more than the form of the curve."""
    return place_of(law_of(one)[0]) != place_of(law_of(other)[0])

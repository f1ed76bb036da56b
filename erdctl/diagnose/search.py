"""The search for effects: forward in a beam, companions together, then backward, and look-alikes.

Training cost lets false effects in, so every decision rests on cross-validated residuals, and one
hypothesis replaces another only if it is better by more than chance.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

from erdctl.core.progress import part_of
from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import (
    as_good_as_explored,
    eliminate,
    second_pass,
    without_each,
)
from erdctl.diagnose.carry_over import to_other_motions
from erdctl.diagnose.companion_effects import joint_tasks
from erdctl.diagnose.comparison import compare_alike, critical_of, ranked
from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.fault_beside import a_fault_explains
from erdctl.diagnose.form_error import beyond_form_error, is_only_form
from erdctl.diagnose.forward_step import (
    Exploration,
    Explored,
    forward_step,
    key_of,
    of_equivalents,
    related,
)
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.look_alikes import is_preferred, look_alikes
from erdctl.diagnose.other_dips import deepest_dip
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import misfit_is_left, search_is_worthwhile
from erdctl.diagnose.richer_forms import (
    earns_it,
    in_the_place_of_plain,
    plain_where_as_good,
)
from erdctl.diagnose.whose_name import has_the_name
from erdctl.estimate.starts import fresh_start
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters


@dataclass(frozen=True, eq=False)
class Selection:
    """What the search found.

    base : the paper's model, or that of given parameters;  best : with the chosen effects
    singles : the base with every effect alone, the best first
    without : for each chosen effect, the best model that lacks it
    look_alikes : for each chosen effect, those that would do as well in its place, best first
    simpler : of fewer effects, others than the chosen ones, that nearly do as well, best first
    ended : whether no further effects were sought, as with a fault that sets in once no misfit is
        left, which takes another search
    """

    base: Hypothesis
    best: Hypothesis
    singles: tuple[Hypothesis, ...]
    without: Mapping[str, Hypothesis]
    look_alikes: Mapping[str, tuple[tuple[str, Hypothesis], ...]]
    simpler: tuple[Hypothesis, ...] = ()
    ended: bool = False

    @property
    def named(self) -> tuple[Effect, ...]:
        """The chosen effects."""
        return tuple(e for e in self.best.effects if e not in self.base.effects)

    @property
    def nothing(self) -> Selection:
        """The same search with nothing named."""
        return replace(self, best=self.base, without={}, look_alikes={})


def search(
    problem: Problem,
    candidates: Sequence[Effect],
    most: int,
    executor: Executor,
    seed: int = 0,
    given: Parameters | None = None,
    untested: Sequence[Effect] = (),
    *,
    once: bool = False,
) -> Selection:
    """Search for the effects, at most `most`, by which the recording differs from a given model.

    untested : effects that the log cannot show, which are no candidates but may be look-alikes
    once : end where a fault that sets in once would leave nothing
    """
    base = _base(problem, given, executor)
    # One evaluation is the start itself.
    told = (
        None if given is None else fit_hypothesis(problem, given.model.effects, [given.values], 1)
    )
    x = Exploration(problem, base, Explored([base]), executor, told)
    ends = partial(_ends, x, tuple(e for e in candidates if once and e.sets_in), seed)
    best, singles = _forward_selection(x, base, candidates, most, seed, ends)
    if misfit_is_left(best, seed) and not ends(best):
        alone = best
        parents = [base] if best is base else [base, best]
        for hypothesis in executor.fit(problem, joint_tasks(x, parents, candidates, most)):
            if hypothesis is not None and _replaces(problem, best, hypothesis):
                best = hypothesis
                x.explored.keep(hypothesis)
        if best is not alone:
            more = most - len(x.added(best))
            best, _ = _forward_selection(x, best, candidates, more, seed, ends)
    if misfit_is_left(best, seed):
        if ends(best):
            return replace(_named(x, best, candidates, singles, untested), ended=True)
        best = in_the_place_of_plain(x, deepest_dip(x, best), candidates)
    best = eliminate(x, best)
    best = second_pass(x, best, most)
    best = as_good_as_explored(x, best)
    best = to_other_motions(x, best)
    # Beside what is needless others would hide what the richer form takes.
    plain = plain_where_as_good(x, best, candidates)
    best = best if plain is best else eliminate(x, plain)
    best = beyond_form_error(x, best, candidates)
    found = _named(x, best, candidates, singles, untested)
    return replace(found, simpler=_simpler(x, found.best))


def _simpler(x: Exploration, best: Hypothesis) -> tuple[Hypothesis, ...]:
    """What is to be compared once more on all samples, on the few of a search too near to tell."""
    key, base = key_of(best.effects), x.base.score
    least = thresholds.NEARLY_AS_MUCH * (base - best.score)
    fewer = [
        h for k, h in x.explored.items()
        if len(k) < len(key) and not k <= key and base - h.score > least
        and not any(related(e, other) for e in h.effects for other in best.effects)
    ]  # fmt: skip
    return tuple(ranked(fewer)[: thresholds.SIMPLER])


def named_again(
    problem: Problem,
    found: Selection,
    kept: Hypothesis,
    candidates: Sequence[Effect],
    executor: Executor,
    untested: Sequence[Effect] = (),
) -> Selection:
    """The search's names once more, where all samples keep fewer effects.

    What was dropped kept others out of the place of those that stay: a lag, which is none, any
    compliance. Where others took the place of all, they have it: these samples do not tell them.
    """
    known = (found.base, *found.singles, *found.without.values(), *found.simpler, found.best)
    x = Exploration(problem, found.base, Explored([]), executor)
    for h in known:
        x.explored.keep(h)
    effects, key = kept.effects, key_of(kept.effects)
    if key not in x.explored:
        again = Task("second pass", effects, (kept.values,), record_effects=kept.record_effects)
        x.explored.keep(*executor.fit_compatible(problem, [again]))
    sure = not key <= key_of(found.best.effects)
    return _named(x, x.explored[key], candidates, found.singles, untested, sure=sure)


def _named(
    x: Exploration,
    best: Hypothesis,
    candidates: Sequence[Effect],
    singles: Sequence[Hypothesis],
    untested: Sequence[Effect],
    *,
    sure: bool = False,
) -> Selection:
    """The best hypothesis, in which an effect that does better has the place of a chosen one.

    sure : whether none may
    """
    problem = x.problem
    alike: dict[str, tuple[tuple[str, Hypothesis], ...]] = {}
    for effect in x.added(best):
        found = look_alikes(x, best, effect, candidates, singles, untested)
        name, by_name = effect.name, {c.name: c for c in (*candidates, *untested)}
        richer = {c.name for c in candidates if c.richer_than and related(c, effect)}
        rest = x.explored[key_of(best.effects) - {name}]
        # It must be worth a name itself, or the next elimination leaves neither of the two.
        preferred = [
            f for f in found
            if not sure
            and f[0] not in key_of(untested)
            and has_the_name(x, (by_name[f[0]], f[1]), (effect, best))
            and compare_alike(problem, rest, f[1]).significant
            and not is_only_form(x, best, f[1])
            and (f[0] not in richer or earns_it(x, best, f[1]))
        ]  # fmt: skip
        if preferred:
            name, first = preferred[0]
            found = [(effect.name, best), *(f for f in found if f[1] is not first)]
            best = first
        alike[name] = tuple(found[: thresholds.LOOK_ALIKES_LISTED])
    without = dict(zip((e.name for e in x.added(best)), without_each(x, best), strict=True))
    return Selection(
        x.explored[key_of(x.base.effects)], best, tuple(singles), without, alike
    )  # fmt: skip


def _forward_selection(
    x: Exploration,
    best: Hypothesis,
    candidates: Sequence[Effect],
    most: int,
    seed: int,
    ends: Callable[[Hypothesis], bool],
) -> tuple[Hypothesis, list[Hypothesis]]:
    """Up to `most` effects more than those of a hypothesis, one by one, in a beam.

    ends : whether a hypothesis is the last one
    Returns the best hypothesis, and the hypotheses with a single effect more.
    """
    parents, singles = [best], list[Hypothesis]()
    for depth in range(most):
        begun = depth or x.explored.keys() > {key_of(best.effects)}
        if begun and (not search_is_worthwhile(best, seed) or ends(best)):
            break  # more effects would have nothing to explain
        if parents[:1] == [best]:
            best = parents[0] = deepest_dip(x, best)
        stage = f"{depth + 1} effects" if depth else "each effect"
        more = ranked(forward_step(x, parents, candidates, stage))
        singles = singles if depth else more
        critical = critical_of(x.problem, best, more)
        better = [h for h in more if compare_alike(x.problem, best, h).beyond(critical)]
        if better:
            best = better[0] = of_equivalents(x, better[0], candidates, stage)
        elif depth:
            break
        # Also hypotheses that gain nothing alone: together with another one may.
        beam = thresholds.BEAM if depth + 1 < thresholds.BEAM_DEPTH else 1
        parents = (better or more)[:beam]
    return best, singles


def _base(problem: Problem, given: Parameters | None, executor: Executor) -> Hypothesis:
    """The model before any effect is added, from fresh starts and from the given values."""
    name = "the paper's model" if given is None else "the given model"
    executor.progress("base", part_of(name, 1, 1))
    if given is None:
        return fit_hypothesis(problem, (), base_starts({})[:-1])
    return fit_hypothesis(problem, given.model.effects, base_starts(given.values))


def base_starts(given: Mapping[str, float]) -> list[dict[str, float]]:
    """Where the fits of a model with given values begin before any effect is added."""
    fresh = fresh_start(*thresholds.FRESH), fresh_start(*thresholds.FRESH_SECOND)
    return [*({**given, **f} for f in fresh), dict(given)]


def _ends(x: Exploration, faults: tuple[Effect, ...], seed: int, best: Hypothesis) -> bool:
    """Whether a fault leaves nothing, asked once that takes little beside one effect more."""
    return len(x.added(best)) >= thresholds.BEFORE_A_FAULT and a_fault_explains(best, faults, seed)


def _replaces(problem: Problem, best: Hypothesis, joint: Hypothesis) -> bool:
    """Whether effects that come together replace what was found one by one."""
    return compare_alike(problem, best, joint).significant or is_preferred(problem, joint, best)

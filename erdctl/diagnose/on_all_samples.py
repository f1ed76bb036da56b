"""What a search has chosen on some samples, fitted to all of them, and what of it they keep."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import eliminate, without_each
from erdctl.diagnose.carry_over import to_other_records
from erdctl.diagnose.comparison import compare_alike
from erdctl.diagnose.executor import Executor, Task
from erdctl.diagnose.form_error import beyond_form_error
from erdctl.diagnose.forward_step import Exploration, Explored, key_of
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.levels_of_records import not_of_records
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.resolved import resolved
from erdctl.diagnose.search import Selection
from erdctl.model.effect import Effect


def refit(
    problem: Problem, found: Selection, executor: Executor, idle: Effect | None = None
) -> Selection:
    """The same selection refitted to another problem, usually all samples, from where it ended.

    What a part of the samples spoke for and all of them do not is dropped, and so is what does not
    carry over to records that were left out.
    idle : one of the chosen effects, that is left out
    """
    kept = key_of(found.best.effects) - ({idle.name} if idle else set())
    known = found.base, found.best, *found.without.values(), *found.simpler
    again = {key_of(h.effects): h for h in known}
    whole = found.base.problem.recording is problem.recording  # all samples were searched
    if whole and found.best.record_effects is None:  # which settle by and by
        explored = Explored(again.values())
    else:
        explored = _on_all_samples(problem, again.values(), found.best, executor)
    explored.restarts.update((key, key_of(found.best.effects)) for key in again)
    base = explored[key_of(found.base.effects)]
    x = Exploration(problem, base, explored, executor)
    best, last = explored[kept], None
    while best is not last:  # each may leave what the other one drops
        last, best = best, to_other_records(x, resolved(x, eliminate(x, best)))
        best = not_of_records(x, beyond_form_error(x, best))
    for other in (explored[key_of(h.effects)] for h in found.simpler):
        # As much by fewer effects, which the samples of the search were too few to tell.
        if len(other.effects) < len(best.effects):
            left = eliminate(x, other)
            best = left if compare_alike(problem, best, left).gain > 0.0 else best
    names = [e.name for e in x.added(best)]
    without = dict(zip(names, without_each(x, best), strict=True))
    alike = {n: found.look_alikes.get(n, ()) for n in names}
    return Selection(base, best, found.singles, without, alike)


def _on_all_samples(
    problem: Problem, hypotheses: Iterable[Hypothesis], best: Hypothesis, executor: Executor
) -> Explored:
    """Hypotheses fitted to all samples, from where they ended on some.

    Where a cost has several dips, as that of a delay has, also from where the best one has these
    parameters: a dip that was next on some samples can be far on all.
    """
    tasks = []
    for h in hypotheses:
        dips = {e.key(q.symbol) for e in h.effects if e.guesses for q in e.quantities}
        elsewhere = {n: v for n, v in best.values.items() if n in dips and v != h.values[n]}
        starts = (h.values, {**h.values, **elsewhere}) if elsewhere else (h.values,)
        tasks.append(
            Task(
                "all samples", h.effects, starts, thresholds.STEPS_AGAIN,
                record_effects=h.record_effects,
            )
        )  # fmt: skip
    return Explored(executor.fit_compatible(problem, tasks))


def on_all(problem: Problem, found: Selection, executor: Executor) -> Selection:
    """The chosen model and its base fitted to more data than chose them; no choice rests on it."""
    tasks = [
        Task("all records", h.effects, (h.values,), thresholds.STEPS_AGAIN)
        for h in ((found.base, found.best) if found.named else (found.base,))
    ]
    fits = executor.fit_compatible(problem, tasks)
    return replace(found, base=fits[0], best=fits[-1])

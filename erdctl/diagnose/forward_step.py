"""Hypotheses with one effect more: which are worth a full trial, and the trials."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from erdctl.diagnose.executor import Crew, Task
from erdctl.diagnose.hypothesis import Trial, fresh_start
from erdctl.diagnose.problem import Study
from erdctl.diagnose.screening import Prospect, Screen
from erdctl.estimate.least_squares import at_bound
from erdctl.model.effect import Effect, Slot

HOPE = 0.4  # of the most promising effect's gain: worth a full trial
ALWAYS = 4  # effects that get one in any case
DISTINCT = (Slot.SIGN, Slot.VISCOUS, Slot.GAS, Slot.SERIES)  # one effect at most in each


def key_of(effects: Iterable[Effect]) -> frozenset[str]:
    """The names of effects, by which a hypothesis is known."""
    return frozenset(e.name for e in effects)


class Seen(dict[frozenset[str], Trial]):
    """Trials by the names of their effects; of several searches for the same, the best.

    descents : the names of trials that were also searched for from where a larger one had ended,
        each with the names of that
    """

    def __init__(self, trials: Iterable[Trial]) -> None:
        super().__init__((key_of(t.effects), t) for t in trials)
        self.descents: set[tuple[frozenset[str], frozenset[str]]] = set()

    def keep(self, trial: Trial) -> None:
        """A trial, unless a better one of the same effects is there."""
        key = key_of(trial.effects)
        if key not in self or trial.score < self[key].score:
            self[key] = trial


def grown(
    study: Study,
    pool: Sequence[Trial],
    candidates: Sequence[Effect],
    stage: str,
    seen: Seen,
    crew: Crew,
) -> list[Trial]:
    """Hypotheses with one effect more than those of the pool, none of them seen before."""
    waiting: dict[frozenset[str], list[Task]] = {}
    for parent in pool:
        for prospect in _prospects(study, parent, candidates, crew):
            key = key_of(parent.effects) | {prospect.effect.name}
            if key not in seen:
                waiting.setdefault(key, []).append(extension(stage, parent, prospect))
    grown = []
    while waiting:
        # Where several parents lead to one hypothesis the next is asked only if the first fails.
        trials = crew.run(study, [tasks.pop(0) for tasks in waiting.values()])
        for key, trial in zip(list(waiting), trials, strict=True):
            if trial is not None:
                seen.keep(trial)
                grown.append(trial)
            if trial is not None or not waiting[key]:
                del waiting[key]
    return grown


def _addable(parent: Trial, candidates: Sequence[Effect]) -> Iterator[Effect]:
    taken = {e.slot for e in parent.effects}
    names = {e.name for e in parent.effects}
    for effect in candidates:
        if effect.name not in names and not (effect.slot in DISTINCT and effect.slot in taken):
            yield effect


def _prospects(
    study: Study, parent: Trial, candidates: Sequence[Effect], crew: Crew
) -> list[Prospect]:
    """The effects worth a full trial beside the parent's, the most promising first."""
    screen = Screen(study, parent)
    found = []
    for effect in _addable(parent, candidates):
        crew.progress("screening", effect.name)
        prospect = screen.look(effect)
        if prospect is not None:
            found.append(prospect)
    found.sort(key=lambda p: -p.gain)
    found = _unlike(found)
    bar = HOPE * found[0].gain if found else 0.0
    # What feeds the force back can be worth nothing near the present fit and all of it elsewhere.
    return [
        p for i, p in enumerate(found)
        if i < ALWAYS or p.gain > bar or p.effect.slot in (Slot.SERIES, Slot.FEEDBACK)
    ]  # fmt: skip


def _unlike(prospects: Sequence[Prospect]) -> list[Prospect]:
    """Of those that no force data can tell apart the first; the others are tried as its rivals."""
    kept: list[Prospect] = []
    for p in prospects:
        if not any(p.effect.name in k.effect.equivalents for k in kept):
            kept.append(p)
    return kept


def extension(stage: str, parent: Trial, prospect: Prospect) -> Task:
    """The trial of one effect more, from the parent's values."""
    starts = [{**parent.values, **guess} for guess in prospect.starts]
    series = prospect.effect.slot is Slot.SERIES
    if series or _cornered(parent):
        # Without the lag that stands in for a compliance, or that vanished for want of the effect.
        fresh = fresh_start(0.005 if series else 0.05, 0.4)
        starts.append({**parent.values, **fresh, **prospect.starts[0]})
    effects = (*parent.effects, prospect.effect)
    return Task(stage, effects, tuple(starts), scatter=parent.scatter)


def _cornered(trial: Trial) -> bool:
    """Whether a shape parameter of the paper's was driven to a bound, from where no search returns.

    What stands in for a missing effect may be pushed as far as it goes.
    """
    ends = fresh_start(0.0, 0.0).keys() - trial.study.held.keys()
    return any(at_bound(trial.model.quantities[name], trial.values[name]) for name in ends)

"""Hypotheses with one effect more: which are worth a full trial, and the trials."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from erdctl.diagnose.crew import Crew, Task
from erdctl.diagnose.screen import Prospect, Screen
from erdctl.diagnose.study import Study
from erdctl.diagnose.trial import Trial, fresh_start
from erdctl.effect import Effect, Slot

HOPE = 0.4  # of the most promising effect's gain: worth a full trial
ALWAYS = 4  # effects that get one in any case
DISTINCT = (Slot.SIGN, Slot.VISCOUS, Slot.GAS, Slot.SERIES)  # one effect at most in each


def key_of(effects: Iterable[Effect]) -> frozenset[str]:
    """The names of effects, by which a hypothesis is known."""
    return frozenset(e.name for e in effects)


def grown(
    study: Study,
    pool: Sequence[Trial],
    candidates: Sequence[Effect],
    stage: str,
    seen: dict[frozenset[str], Trial],
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
                seen[key] = trial
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
    if prospect.effect.slot is Slot.SERIES:
        # Without the lag that stands in for the compliance.
        starts.append({**parent.values, **fresh_start(0.005, 0.4), **prospect.starts[0]})
    effects = (*parent.effects, prospect.effect)
    return Task(stage, effects, tuple(starts), scatter=parent.scatter)

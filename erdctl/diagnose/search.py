"""The search for effects: beam forward, look at pairs, second pass, drop what became useless.

Training cost lets false effects in, so every decision rests on groups that the fit left out, and
one hypothesis replaces another only if it is better by more than the scatter between groups.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from erdctl.diagnose.companion_effects import companies, jointly
from erdctl.diagnose.comparison import LEAST, compare
from erdctl.diagnose.executor import Crew, Task
from erdctl.diagnose.forward_step import Seen, extension, grown, key_of
from erdctl.diagnose.hypothesis import Trial, attempt, fresh_start
from erdctl.diagnose.problem import Study
from erdctl.diagnose.residual.predictability import Remainder, examine
from erdctl.diagnose.screening import Screen
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters

BEAM = 3  # hypotheses that are extended side by side
WIDE = 3  # effects up to which they are; what comes fourth is seen beside any good three
TIE = 2.0  # below that many times their scatter two hypotheses cannot be told apart
CONFIRM = 12  # steps of a search from where another has ended


@dataclass(frozen=True, eq=False)
class Choice:
    """What the search found.

    base : the paper's model, or that of given parameters;  best : with the chosen effects
    singles : the base with every effect alone
    without : for each chosen effect, the best model that lacks it
    rivals : for each chosen effect, those that would do as well in its place, best first
    """

    base: Trial
    best: Trial
    singles: tuple[Trial, ...]
    without: Mapping[str, Trial]
    rivals: Mapping[str, tuple[tuple[str, Trial], ...]]

    @property
    def named(self) -> tuple[Effect, ...]:
        """The chosen effects."""
        return _beyond(self.base, self.best)


def confirm(study: Study, found: Choice, crew: Crew) -> Choice:
    """The same choice refitted on another study, usually all samples, from where it was found.

    What a part of the samples spoke for and all of them do not is dropped.
    """
    again = {key_of(t.effects): t for t in (found.base, found.best, *found.without.values())}
    tasks = [
        Task("all samples", t.effects, (t.values,), CONFIRM, scatter=t.scatter)
        for t in again.values()
    ]
    seen = Seen(_must(t) for t in crew.run(study, tasks))
    seen.descents.update((key, key_of(found.best.effects)) for key in again)
    base = seen[key_of(found.base.effects)]
    best = _prune(study, base, seen[key_of(found.best.effects)], seen, crew)
    names = [e.name for e in _beyond(base, best)]
    without = {n: seen[key_of(best.effects) - {n}] for n in names}
    rivals = {n: found.rivals[n] for n in names}
    return Choice(base, best, found.singles, without, rivals)


def choose(
    study: Study,
    candidates: Sequence[Effect],
    most: int,
    crew: Crew,
    seed: int = 0,
    given: Parameters | None = None,
) -> Choice:
    """Search for the effects, at most `most`, that the recording shows beside a given model."""
    base = _base(study, given, crew)
    seen = Seen([base])
    best, rest, singles = _climb(study, base, candidates, most, seen, crew, seed)
    if rest.real:
        alone = best
        joint = [jointly(study, base, together) for together in companies(candidates)]
        for trial in crew.run(study, joint):
            if trial is not None and _takes_over(study, best, trial):
                best = trial
                seen.keep(trial)
        if best is not alone:
            left = most - len(_beyond(base, best))
            best, _, _ = _climb(study, best, candidates, left, seen, crew, seed)
    best = _prune(study, base, best, seen, crew)
    best = _second_look(study, base, best, most, seen, crew)
    best = _as_good_as_seen(study, base, best, seen, crew)
    rivals: dict[str, tuple[tuple[str, Trial], ...]] = {}
    for effect in _beyond(base, best):
        found = _rivals(study, best, effect, candidates, singles, seen, crew)
        name = effect.name
        likelier = [f for f in found if _likelier(study, f[1], best)]
        if likelier:
            name, first = likelier[0]
            found = [(effect.name, best), *(f for f in found if f[1] is not first)]
            best = first
        rivals[name] = tuple(found[:2])
    lesser = _lesser(study, base, best, seen, crew)
    without = {e.name: trial for e, trial in zip(_beyond(base, best), lesser, strict=True)}
    return Choice(seen[key_of(base.effects)], best, tuple(singles), without, rivals)


def _climb(
    study: Study,
    best: Trial,
    candidates: Sequence[Effect],
    most: int,
    seen: Seen,
    crew: Crew,
    seed: int,
) -> tuple[Trial, Remainder, list[Trial]]:
    """Up to `most` effects beside those of a trial, one by one, in a beam.

    Returns the best hypothesis, what remains of it, and the trials of a single effect more.
    """
    pool, singles = [best], list[Trial]()
    rest: Remainder | None = None
    for depth in range(most):
        if depth or seen.keys() > {key_of(best.effects)}:
            rest = examine(best.study, best.residual, seed)
            if not rest.hint:
                break  # more effects would have nothing to explain
        stage = f"{depth + 1} effects" if depth else "each effect"
        more = grown(study, pool, candidates, stage, seen, crew)
        singles = singles if depth else more
        more.sort(key=lambda t: (t.score, len(t.model.shape)))
        better = [t for t in more if compare(study, best, t).real]
        if better:
            best, rest = better[0], None
        elif depth:
            break
        # Also hypotheses that gain nothing alone: one may be worth something beside another.
        pool = (better or more)[: BEAM if depth + 1 < WIDE else 1]
    return best, rest or examine(best.study, best.residual, seed), singles


def _base(study: Study, given: Parameters | None, crew: Crew) -> Trial:
    """The model before any effect is added, from fresh starts and from the given values."""
    crew.progress("base", "the paper's model" if given is None else "the given model")
    fresh = [fresh_start(0.05, 0.4), fresh_start(0.01, 1.0)]
    if given is None:
        return attempt(study, (), fresh)
    starts = [*({**given.values, **f} for f in fresh), given.values]
    return attempt(study, given.model.effects, starts)


def _beyond(base: Trial, trial: Trial) -> tuple[Effect, ...]:
    """The effects of a trial that the base does not have."""
    return tuple(e for e in trial.effects if e not in base.effects)


def _must(trial: Trial | None) -> Trial:
    assert trial is not None, "effects of a trial can act together"
    return trial


def _takes_over(study: Study, best: Trial, joint: Trial) -> bool:
    """Whether effects that come together replace what was found one by one."""
    return compare(study, best, joint).real or _likelier(study, joint, best)


def _likelier(study: Study, rival: Trial, best: Trial) -> bool:
    """Whether a rival should have the name: it is as good with less, or better with no more."""
    extra = len(rival.model.quantities) - len(best.model.quantities)
    if extra < 0:
        return not compare(study, rival, best).real
    return extra == 0 and compare(study, best, rival).gain > 0.0


def _lesser(study: Study, base: Trial, best: Trial, seen: Seen, crew: Crew) -> list[Trial]:
    """The best trial without each of its effects in turn, but for those of the base.

    Searched for from where the larger one ended, too: else an effect may owe its worth to a smaller
    hypothesis that was stuck, and not to what it adds.
    """
    rests = [tuple(e for e in best.effects if e is not out) for out in _beyond(base, best)]
    new = [rest for rest in rests if (key_of(rest), key_of(best.effects)) not in seen.descents]
    tasks = [Task("second pass", rest, (best.values,), scatter=best.scatter) for rest in new]
    for rest, trial in zip(new, crew.run(study, tasks), strict=True):
        seen.descents.add((key_of(rest), key_of(best.effects)))
        seen.keep(_must(trial))
    return [seen[key_of(rest)] for rest in rests]


def _prune(study: Study, base: Trial, best: Trial, seen: Seen, crew: Crew) -> Trial:
    """Remove effects that others have made useless, the one with the least evidence first.

    Losses that scatter hides one by one may be clear together: then the last of them stays.
    """
    top = min(seen.values(), key=lambda t: t.score)
    while _beyond(base, best):
        lesser = _lesser(study, base, best, seen, crew)
        worth = [(compare(study, t, best), t) for t in lesser]
        useless = [(c.clear, i, t) for i, (c, t) in enumerate(worth) if not c.real]
        missed = compare(study, best, top).real  # already: then it is no reason to keep anything
        idle = [t for *_, t in sorted(useless) if missed or not compare(study, t, top).real]
        if not idle:
            return best
        best = idle[0]
    return best


def _second_look(
    study: Study, base: Trial, best: Trial, most: int, seen: Seen, crew: Crew
) -> Trial:
    """What another effect had put in the shade may be worth its place once that one is gone."""
    key = key_of(best.effects)
    if len(_beyond(base, best)) >= most:
        return best
    more = [t for k, t in seen.items() if k > key and len(k) == len(key) + 1]
    better = [t for t in more if compare(study, best, t).real]
    return _prune(study, base, min(better, key=lambda t: t.score), seen, crew) if better else best


def _as_good_as_seen(study: Study, base: Trial, best: Trial, seen: Seen, crew: Crew) -> Trial:
    """Pruning goes one way down from one hypothesis; another of that size may have done better."""
    while True:
        size = len(key_of(best.effects))
        even = [t for k, t in seen.items() if len(k) == size and t.score < best.score]
        better = [t for t in even if _likelier(study, t, best)]
        if not better:
            return best
        best = _prune(study, base, min(better, key=lambda t: t.score), seen, crew)


def _rivals(
    study: Study,
    best: Trial,
    effect: Effect,
    candidates: Sequence[Effect],
    singles: Sequence[Trial],
    seen: Seen,
    crew: Crew,
) -> list[tuple[str, Trial]]:
    """Effects that explain as much in the place of one: no worse by more than scatter."""
    rest = tuple(e for e in best.effects if e is not effect)
    order = sorted(singles, key=lambda t: t.score)
    likely = [t.effects[-1] for t in order[:6]]
    likely += [c for c in candidates if c.name in effect.equivalents]
    names = key_of(best.effects)
    keys = {r.name: key_of(rest) | {r.name} for r in likely if r.name not in names}
    if key_of(rest) not in seen:
        task = Task("second pass", rest, (best.values,), scatter=best.scatter)
        (base,) = crew.run(study, [task])
        seen.keep(_must(base))
    new = [r for r in dict.fromkeys(likely) if r.name in keys and keys[r.name] not in seen]
    screen = Screen(study, seen[key_of(rest)]) if new else None
    prospects = [screen.look(rival) for rival in new] if screen else []
    tasks = [extension("look-alikes", seen[key_of(rest)], p) for p in prospects if p is not None]
    for trial in crew.run(study, tasks):
        if trial is not None:
            seen.keep(trial)
    found = []
    for name, key in keys.items():
        if key not in seen:
            continue
        against = compare(study, seen[key], best)
        if against.clear < TIE or against.gain < LEAST or _likelier(study, seen[key], best):
            found.append((name, seen[key]))
    found.sort(key=lambda f: f[1].score)
    return found

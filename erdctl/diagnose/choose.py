"""The search for effects: beam forward, look at pairs, second pass, drop what became useless.

Training cost lets false effects in, so every decision rests on groups that the fit left out, and
one hypothesis replaces another only if it is better by more than the scatter between groups.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from erdctl.diagnose.remains import examine
from erdctl.diagnose.screen import Prospect, Screen, starts
from erdctl.diagnose.study import Study
from erdctl.diagnose.trial import Trial, attempt, fresh_start, ranked
from erdctl.effect import Effect, Slot

BEAM = 3  # hypotheses that are extended side by side
CLEAR = 3.5  # how many times its scatter a gain must be, over stretches of a second
STEADY = 1.5  # the same, over groups left out
TIE = 2.0  # below that many times their scatter two hypotheses cannot be told apart
LEAST = 0.004  # relative gain in unseen mean square below which nothing is worth a name
FINEST = 2e-4  # of the range of the force: less may be the rounding of a simulation
HOPE = 0.4  # of the most promising effect's gain: worth a full trial
ALWAYS = 4  # effects that get one in any case
CONFIRM = 12  # steps of a search from where another has ended
FEW = 5  # starts of each of several effects that are tried together
DISTINCT = (Slot.SIGN, Slot.VISCOUS, Slot.GAS, Slot.SERIES)  # one effect at most in each

Progress = Callable[[str, str], None]


@dataclass(frozen=True)
class Comparison:
    """How much better one hypothesis is than another on what neither has seen.

    gain : relative reduction of the unseen mean square
    clear, steady : see `Study.clearly`, on errors of fits that have left the group out
    size : root of the reduction over the range of the force
    """

    gain: float
    clear: float
    steady: float
    size: float

    @property
    def real(self) -> bool:
        """Whether the gain is more than scatter, and worth a name."""
        worth = self.gain > LEAST and self.size > FINEST
        return worth and self.clear > CLEAR and self.steady > STEADY


def compare(study: Study, worse: Trial, better: Trial) -> Comparison:
    """The gain of one trial over another."""
    # Where a channel makes samples doubtful for one of them, both go without.
    common = worse.study if worse.study is not study else better.study
    clear, steady = common.clearly(worse.unseen, better.unseen)
    less = worse.score - better.score
    gain = less / worse.score if worse.score > 0.0 else 0.0
    size = float(np.sqrt(max(less, 0.0))) / float(np.ptp(study.block.force))
    return Comparison(gain, clear, steady, size)


@dataclass(frozen=True, eq=False)
class Choice:
    """What the search found.

    base : the paper's model;  best : with the chosen effects;  singles : every effect alone
    without : for each chosen effect, the best model that lacks it
    rivals : for each chosen effect, those that would do as well in its place, best first
    """

    base: Trial
    best: Trial
    singles: tuple[Trial, ...]
    without: Mapping[str, Trial]
    rivals: Mapping[str, tuple[tuple[str, Trial], ...]]


def confirm(study: Study, found: Choice, progress: Progress) -> Choice:
    """The same choice refitted on another study, usually all samples, from where it was found.

    What a part of the samples spoke for and all of them do not is dropped.
    """

    def again(trial: Trial) -> Trial:
        progress("all samples", ", ".join(e.name for e in trial.effects) or "the paper's model")
        return attempt(study, trial.effects, [trial.values], max_evaluations=CONFIRM)

    seen = {frozenset(e.name for e in t.effects): again(t) for t in (found.base, found.best)}
    without = {name: again(trial) for name, trial in found.without.items()}
    seen |= {frozenset(e.name for e in t.effects): t for t in without.values()}
    best = seen[frozenset(e.name for e in found.best.effects)]
    best = _prune(study, best, seen, progress)
    names = [e.name for e in best.effects]
    without = {n: seen[frozenset(names) - {n}] for n in names}
    rivals = {n: found.rivals[n] for n in names}
    return Choice(seen[frozenset()], best, found.singles, without, rivals)


def choose(
    study: Study, candidates: Sequence[Effect], most: int, progress: Progress, seed: int = 0
) -> Choice:
    """Search for the effects, at most `most`, that the recording shows."""
    base = attempt(study, (), [fresh_start(0.05, 0.4), fresh_start(0.01, 1.0)])
    best, pool = base, [base]
    seen: dict[frozenset[str], Trial] = {frozenset(): base}
    singles: list[Trial] = []
    for depth in range(most):
        if depth and not examine(best.study, best.residual, seed).hint:
            break  # more effects would have nothing to explain
        grown = []
        for parent in pool:
            taken = frozenset(e.name for e in parent.effects)
            for prospect in _prospects(study, parent, candidates, progress):
                key = taken | {prospect.effect.name}
                if key in seen:
                    continue
                progress(f"{depth + 1} effects" if depth else "each effect", prospect.effect.name)
                trial = _extend(study, parent, prospect)
                if trial is not None:
                    seen[key] = trial
                    grown.append(trial)
        if not depth:
            singles = grown
        grown.sort(key=lambda t: (t.score, len(t.model.shape)))
        better = [t for t in grown if compare(study, best, t).real]
        if better:
            best = better[0]
        elif depth:
            break
        # Also hypotheses that gain nothing alone: one may be worth something beside another.
        pool = (better or grown)[:BEAM]
    if examine(best.study, best.residual, seed).real:
        for together in _companies(candidates):
            progress("together", ", ".join(e.name for e in together))
            trial = _jointly(study, base, together)
            if trial is not None and compare(study, best, trial).real:
                best = trial
                seen[frozenset(e.name for e in together)] = trial
    best = _prune(study, best, seen, progress)
    rivals: dict[str, tuple[tuple[str, Trial], ...]] = {}
    for effect in best.effects:
        found = _rivals(study, best, effect, candidates, singles, seen, progress)
        name = effect.name
        likelier = [f for f in found if _likelier(study, f[1], best)]
        if likelier:
            name, first = likelier[0]
            found = [(effect.name, best), *(f for f in found if f[1] is not first)]
            best = first
        rivals[name] = tuple(found[:2])
    without = {}
    for effect in best.effects:
        rest = tuple(e for e in best.effects if e is not effect)
        without[effect.name] = _refit(study, best, rest, seen)
    return Choice(base, best, tuple(singles), without, rivals)


def _addable(parent: Trial, candidates: Sequence[Effect]) -> Iterator[Effect]:
    taken = {e.slot for e in parent.effects}
    names = {e.name for e in parent.effects}
    for effect in candidates:
        if effect.name not in names and not (effect.slot in DISTINCT and effect.slot in taken):
            yield effect


def _prospects(
    study: Study, parent: Trial, candidates: Sequence[Effect], progress: Progress
) -> list[Prospect]:
    """The effects worth a full trial beside the parent's, the most promising first."""
    screen = Screen(study, parent)
    found = []
    for effect in _addable(parent, candidates):
        progress("screening", effect.name)
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


def _extend(study: Study, parent: Trial, prospect: Prospect) -> Trial | None:
    starts = [{**parent.values, **guess} for guess in prospect.starts]
    if prospect.effect.slot is Slot.SERIES:
        # Without the lag that stands in for the compliance.
        starts.append({**parent.values, **fresh_start(0.005, 0.4), **prospect.starts[0]})
    return _try(study, (*parent.effects, prospect.effect), starts)


def _companies(candidates: Sequence[Effect]) -> Iterator[tuple[Effect, ...]]:
    """Effects with those that commonly come with them."""
    by_name = {e.name: e for e in candidates}
    for effect in candidates:
        others = [by_name[name] for name in effect.beside if name in by_name]
        if others:
            yield (effect, *others)


def _jointly(study: Study, base: Trial, effects: tuple[Effect, ...]) -> Trial | None:
    """A trial of effects that may be worth nothing one by one, from the best of many starts."""
    grids = []
    for effect in effects:
        guesses = starts(effect, study)
        few = guesses[:: -(-len(guesses) // FEW)]
        grids.append([{effect.key(s): v for s, v in g.items()} for g in few])
    points = [{**base.values, **_merged(point)} for point in product(*grids)]
    try:
        return attempt(study, effects, ranked(study, effects, points)[:BEAM])
    except ValueError:
        return None  # effects that cannot act together


def _merged(parts: Iterable[Mapping[str, float]]) -> dict[str, float]:
    return {name: value for part in parts for name, value in part.items()}


def _likelier(study: Study, rival: Trial, best: Trial) -> bool:
    """Whether a rival should have the name: it is as good with less, or better with no more."""
    extra = len(rival.model.quantities) - len(best.model.quantities)
    if extra < 0:
        return not compare(study, rival, best).real
    return extra == 0 and rival.score < best.score


def _try(
    study: Study, effects: Sequence[Effect], starts: Sequence[Mapping[str, float]]
) -> Trial | None:
    try:
        return attempt(study, effects, starts, max_evaluations=25)
    except ValueError:
        return None  # effects that cannot act together


def _refit(
    study: Study, parent: Trial, effects: tuple[Effect, ...], seen: dict[frozenset[str], Trial]
) -> Trial:
    key = frozenset(e.name for e in effects)
    if key not in seen:
        trial = _try(study, effects, [parent.values])
        assert trial is not None
        seen[key] = trial
    return seen[key]


def _prune(
    study: Study, best: Trial, seen: dict[frozenset[str], Trial], progress: Progress
) -> Trial:
    """Remove effects that others have made useless, the least useful first."""
    while best.effects:
        lesser = []
        for effect in best.effects:
            progress("second pass", effect.name)
            rest = tuple(e for e in best.effects if e is not effect)
            lesser.append(_refit(study, best, rest, seen))
        useless = [t for t in lesser if not compare(study, t, best).real]
        if not useless:
            return best
        best = min(useless, key=lambda t: t.score)
    return best


def _rivals(
    study: Study,
    best: Trial,
    effect: Effect,
    candidates: Sequence[Effect],
    singles: Sequence[Trial],
    seen: dict[frozenset[str], Trial],
    progress: Progress,
) -> list[tuple[str, Trial]]:
    """Effects that explain as much in the place of one: no worse by more than scatter."""
    rest = tuple(e for e in best.effects if e is not effect)
    order = sorted(singles, key=lambda t: t.score)
    likely = [t.effects[0] for t in order[:6]]
    likely += [c for c in candidates if c.name in effect.equivalents]
    names = {e.name for e in best.effects}
    base = _refit(study, best, rest, seen)
    found = []
    for rival in dict.fromkeys(likely):
        if rival.name in names:
            continue
        key = frozenset([*(e.name for e in rest), rival.name])
        if key not in seen:
            progress("look-alikes", rival.name)
            prospect = Screen(study, base).look(rival)
            trial = None if prospect is None else _extend(study, base, prospect)
            if trial is None:
                continue
            seen[key] = trial
        against = compare(study, seen[key], best)
        if against.clear < TIE or against.gain < LEAST or _likelier(study, seen[key], best):
            found.append((rival.name, seen[key]))
    found.sort(key=lambda f: f[1].score)
    return found

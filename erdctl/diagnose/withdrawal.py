"""Names that do not hold on records which neither fit nor search has seen.

One effect of several may fail there, a threshold of the field that the others' levels hardly tell,
say: then it goes, and those without which the kept records are predicted worse stay.
"""

from __future__ import annotations

from typing import NamedTuple

from erdctl.diagnose import thresholds
from erdctl.diagnose.executor import Executor
from erdctl.diagnose.on_all_samples import refit
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.search import Selection
from erdctl.diagnose.unseen import Unseen, on_kept, on_unseen
from erdctl.model.effect import Effect


class Withdrawal(NamedTuple):
    """A selection of effects that hold, those that did not, and errors on what was left out."""

    selection: Selection
    withdrawn: tuple[Effect, ...]
    unseen: tuple[Unseen, ...]


def that_hold(
    chosen: Selection, aside: Problem | None, seen: Problem, executor: Executor
) -> Withdrawal:
    """The effects of a selection without those that predict kept records the worse.

    aside : the records that were kept, if any were;  seen : those of the fits
    """
    found = Withdrawal(chosen, (), on_unseen(aside, chosen.base, chosen.best))
    if aside is None or not found.unseen[0].worse:
        return found
    while len(found.selection.named) > 1:
        left = found.selection
        errors = {e: on_kept(aside, left.base, left.without[e.name]).after for e in left.named}
        worst = min(errors, key=lambda e: errors[e])
        left = refit(seen, left, executor, worst)
        if not left.named:
            break
        unseen = on_unseen(aside, left.base, left.best)
        gone = tuple(e for e in chosen.named if e not in left.named)
        found = Withdrawal(left, gone, unseen)
        if unseen[0].after < thresholds.HOLDS * unseen[0].before:
            return found
    nothing = chosen.nothing
    return Withdrawal(nothing, chosen.named, on_unseen(aside, nothing.base, nothing.best))

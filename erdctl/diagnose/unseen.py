"""Data that a model has not seen, and how: kept from fit and search, or from the fit alone.

A search that chose among hundreds of hypotheses by what they predict of left-out groups has seen
these groups, though no fit has. So where there are records enough some are kept aside until all
has been decided, and predicted once. Of the others each kind of motion, and each level of control,
is left out of the fit in turn: what fits only the excitations at hand fails there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import unmet, untestable
from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.as_taken import as_taken
from erdctl.diagnose.carry_over import left_out_exactly
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.kinds_of_excitation import (
    duties_of_records,
    excitation,
    held_by_others,
    kinds_of_motion,
    levels_of_duty,
)
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.thin import thinned
from erdctl.model.effect import Effect


class Left(StrEnum):
    """What was left out."""

    ASIDE = "records kept aside"
    MOTIONS = "kinds of motion"
    DUTIES = "levels of duty"
    GROUPS = "groups"


@dataclass(frozen=True)
class Unseen:
    """Errors on what was left out of a fit.

    left : what;  parts : number of fits, each without one of them
    names : of the records that were kept aside, otherwise none
    before, after : NRMSE over the range of the force, of the model to answer for and corrected
    decided : whether these records have said which of the effects stay
    """

    left: Left
    parts: int
    names: tuple[str, ...]
    before: float
    after: float
    decided: bool = False

    @property
    def never_seen(self) -> bool:
        """Whether the choice of effects does not rest on these data, either."""
        return self.left is Left.ASIDE and not self.decided

    @property
    def worse(self) -> bool:
        """Whether the correction predicts them worse than the model that it corrects."""
        return self.after > self.before


def kept_aside(recording: Recording, candidates: Sequence[Effect]) -> tuple[int, ...]:
    """Numbers of records that neither fit nor search is to see; none where there are too few.

    The ones most like another record, so that the rest still holds every kind of excitation; none
    of the slowest, widest, longest or else extreme, none with duties between those of all others,
    and none if the rest could show less.
    """
    count = len(recording.names)
    if count < thresholds.ASIDE_FROM:
        return ()
    at, most = excitation(recording), count // thresholds.ASIDE_OF
    apart = np.abs(at[:, None] - at[None]).max(axis=2)
    np.fill_diagonal(apart, np.inf)
    extreme = _extreme(recording, at)
    duties = duties_of_records(recording)
    chosen: list[int] = []
    for r in np.argsort(apart.min(axis=1), kind="stable").tolist():
        others = apart[r].copy()
        others[chosen] = np.inf
        if r not in extreme and np.isfinite(others).any() and len(chosen) < most:
            alone = others.min() > apart[r].min()  # what it is most like is aside already
            held = [d for k, d in enumerate(duties) if k != r and k not in chosen]
            chosen += [] if alone or not held_by_others(duties[r], held) else [r]
    rest = recording.select([r for r in range(count) if r not in chosen])
    shows = [
        (set(unmet(log)), set(untestable(Survey.of(log), candidates))) for log in (recording, rest)
    ]
    return tuple(sorted(chosen)) if shows[0] == shows[1] else ()


def _extreme(recording: Recording, at: Array) -> set[int]:
    """Records at either end of a measure of the excitation, or at which a channel has its ends."""
    channels = [recording.x, recording.xdot, recording.duty, recording.t]
    channels += [] if recording.temperature is None else [recording.temperature]
    ends = [*at.T, *(-at.T)]
    for c in channels:
        ends += [np.array([float(c[s].max()) for s in recording.slices])]
        ends += [np.array([-float(c[s].min()) for s in recording.slices])]
    return {int(np.argmax(e)) for e in ends if np.ptp(e) > 0.0}


def on_unseen(aside: Problem | None, base: Hypothesis, best: Hypothesis) -> tuple[Unseen, ...]:
    """Errors of two models by what was left out, that which nothing has seen first.

    aside : the problem of the records that neither the fits nor the search has seen, if any are
    """
    found = list(_left_out(base, best))
    if aside is not None:
        found.insert(0, on_kept(aside, base, best))
    return tuple(found)


def on_kept(aside: Problem, base: Hypothesis, best: Hypothesis) -> Unseen:
    """Errors of two models on records that neither the fits nor the search has seen."""
    pair = (_on(aside, h) for h in (base, best))
    return _unseen(Left.ASIDE, 1, aside.recording.names, *pair)


def _on(problem: Problem, hypothesis: Hypothesis) -> Hypothesis:
    """A hypothesis on data of which no sample was in its fit."""
    model, values = hypothesis.model, hypothesis.values
    residual = problem.block.force - model.force(problem.block.signals, values)
    fitted = replace(hypothesis.fitted, residual=residual)
    return Hypothesis(as_taken(problem, model, values), fitted, residual)


def _left_out(base: Hypothesis, best: Hypothesis) -> Iterator[Unseen]:
    """Of all that is left out of the fit in turn; the search has seen it."""
    few = thinned(best.problem, thresholds.CARRY_SAMPLES)
    for left, kinds in (
        (Left.MOTIONS, kinds_of_motion(few.recording)),
        (Left.DUTIES, levels_of_duty(few.recording)),
    ):
        if kinds is not None:
            pair = (_without_each(few, kinds, h) for h in (base, best))
            yield _unseen(left, int(kinds.max()) + 1, (), *pair)
    yield _unseen(Left.GROUPS, best.problem.count, (), base, best)


def _without_each(problem: Problem, kinds: Index, hypothesis: Hypothesis) -> Hypothesis:
    """A hypothesis with the residuals of fits anew: one step from the whole fit promises too much.

    Of seven effects on a real damper it told 0.022 of the range where these fits give 0.465.
    """
    part = as_taken(problem, hypothesis.model, hypothesis.values)
    missed = left_out_exactly(part, kinds, hypothesis)
    fitted = replace(hypothesis.fitted, residual=missed)  # of as many samples as the part has
    return replace(hypothesis, problem=part, fitted=fitted, cross_validated=missed)


def _unseen(
    left: Left, parts: int, names: tuple[str, ...], before: Hypothesis, after: Hypothesis
) -> Unseen:
    found = compare(after.problem, before, after)
    scale = float(np.ptp(after.problem.block.force))
    first, last = (float(np.sqrt(square)) / scale for square in (found.before, found.after))
    return Unseen(left, parts, names, first, last)

"""Where to look for a misfit: which of the regions in which it gathers is told first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

from erdctl.core.messages import plain
from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.localisation import (
    Region,
    describe,
    excess,
    locate,
    points,
    record_region,
    said,
    shares,
    since_onset,
    variables,
)
from erdctl.model.effect import Effect, Variable
from erdctl.model.slots import Values

MISFIT, WITHOUT_IT = "of the misfit", "without it"
AGES = (Variable.TIME, Variable.ENERGY)  # what grows from the beginning of a record


def acting(
    problem: Problem, effect: Effect, values: Values, squares: Sequence[Array]
) -> list[Region]:
    """Where an effect acts: in the variable of its physics if it gathers there, else the sharpest.

    One region, or two of one variable.
    squares : (n,) each, squared forces of the effect [N^2], as it is first and then as far as the
        other parameters do not absorb it: what acts everywhere alike is seen by that alone, and
        what is said then is said of that
    """
    onset = since_onset(problem, [effect], values, squares[0])
    if onset:
        return onset
    gathered = [locate(problem, square) for square in squares]
    gathered[1:] = [[_without_it(r) for r in regions] for regions in gathered[1:]]
    own = [[r for r in regions if r.variable is effect.shows] for regions in gathered]
    sharpest = [[r for r in regions if r.variable is regions[0].variable] for regions in gathered]
    return next((regions for regions in own + sharpest if regions), [])


def _without_it(region: Region) -> Region:
    return replace(region, text=region.text.replace(MISFIT, f"{MISFIT} {WITHOUT_IT}", 1))


def places(
    problem: Problem,
    square: Array,
    effects: Sequence[tuple[Effect, Sequence[Region]]] = (),
    *,
    sure: bool = True,
) -> list[Region]:
    """Where to look for a misfit, the place most worth it first.

    That is where the effect that explains most of it shows by what physics says: from its onset on,
    or where misfit gathers in its variable, or where it acts if there is no less misfit there than
    elsewhere; unless the misfit gathers far more sharply elsewhere. Next where it gathers most
    sharply, then the same of the other effects. Where it gathers nowhere, where the first one acts.
    A single record in which it gathers comes last; first if it has all but a little of what is not
    explained, which is then to be looked for in that record, and not where that happens to lie.
    square : (n,) squared misfit [N^2];  effects : each with where it acts, the first one first
    sure : whether they explain it; if not, they come second
    """
    gathered = locate(problem, square)
    if sure and any(effect.sets_in for effect, _ in effects):
        # A fit to before and after misses the shorter of the two by more, whichever it is.
        gathered = [r for r in gathered if r.variable not in AGES]
    own = [_own(problem, square, gathered, effect, acts) for effect, acts in effects]
    sharpest = [r for r in gathered if r.variable is gathered[0].variable]
    least = thresholds.REGION_OWN * excess(sharpest)
    t = problem.block.signals.t
    since = bool(effects) and effects[0][0].sets_in and points(own[0], t)
    if not own or not sure or not (since or excess(own[0]) >= least):
        own.insert(0, sharpest)
    listed: list[Region] = []
    for region in chain(*own[:1], sharpest, *own[1:], gathered):
        if not any(_same(region, other) for other in listed):
            listed.append(region)
    if not listed and sure and effects:
        listed = [_of_effect(problem, square, effects[0][0], r) for r in effects[0][1]]
    listed = listed[: thresholds.REGIONS]
    if alone := record_region(problem, square):
        first = not sure and alone.share >= thresholds.RECORD_FIRST
        listed.insert(0 if first else len(listed), alone)
    return listed


def _own(
    problem: Problem,
    square: Array,
    gathered: Sequence[Region],
    effect: Effect,
    acts: Sequence[Region],
) -> list[Region]:
    """Where a misfit of an effect is to be seen by the effect's physics; [] if nowhere."""
    own = [r for r in gathered if r.variable is effect.shows]
    within = [_measured(problem, r, square) for r in acts if r.variable is effect.shows]
    if effect.sets_in:
        return [r if r.share >= r.time else _after_less(effect, r) for r in within]
    return own or [r for r in within if r.share >= r.time]


def _after_less(effect: Effect, region: Region) -> Region:
    """From an onset on, where a fit to before and after misses the less."""
    text = (
        f"{effect.name} acts from {plain(region.low, 4)} s to the end of the records, in"
        f" {100 * region.time:.0f} % of the time; a fit to before and after alike misses the"
        f" shorter by more, which has {100 * (1 - region.share):.0f} % of the misfit"
    )
    return replace(region, text=text)


def _of_effect(problem: Problem, square: Array, effect: Effect, region: Region) -> Region:
    """A region in which an effect acts, with its share of a misfit that gathers nowhere."""
    absorbed = f"{MISFIT} {WITHOUT_IT}"
    own = region.text.replace(absorbed, f"{MISFIT} without {effect.name}", 1)
    if absorbed not in region.text:
        own = region.text.replace(MISFIT, f"of the square of what {effect.name} adds", 1)
    text = f"{own}; the misfit itself gathers nowhere"
    return replace(_measured(problem, region, square), text=text)


def _same(a: Region, b: Region) -> bool:
    """Whether two regions are one place to a reader: of one variable, and mostly one interval."""
    inter = min(a.high, b.high) - max(a.low, b.low)
    union = max(a.high, b.high) - min(a.low, b.low)
    return a.variable is b.variable and inter > thresholds.REGION_SAME * union


def _measured(problem: Problem, region: Region, square: Array) -> Region:
    """The same region with its share of another misfit (n,) [N^2]."""
    value = variables(problem.block.signals, problem.block.force)[region.variable]
    inside = (value >= region.low) & (value <= region.high)
    share, time = shares(problem, inside, square)
    text = said(share, time, describe(region.variable, region.low, region.high))
    return Region(region.variable, region.low, region.high, share, time, text)

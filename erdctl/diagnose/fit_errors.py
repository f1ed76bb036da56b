"""The last step of a fit on all samples, and the errors of what it found."""

from __future__ import annotations

from dataclasses import replace

from erdctl.core.progress import Progress
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.record_effects import RecordEffects
from erdctl.diagnose.thin import thinned
from erdctl.estimate.covariance import Fit, estimates
from erdctl.estimate.held_lags import with_held_lags
from erdctl.estimate.last_step import assess
from erdctl.estimate.onsets import onset_intervals, placed
from erdctl.model.effect import Effect


def fit_errors(
    problem: Problem,
    hypothesis: Hypothesis,
    progress: Progress = lambda stage, what: None,
    threads: int = 1,
) -> tuple[Fit, RecordEffects | None]:
    """The last step on all samples and the errors of a hypothesis, and of its record effects."""
    model = hypothesis.model
    block, record_effects = hypothesis.problem.block, hypothesis.record_effects
    shared = block if record_effects is None else record_effects.shared(block)
    held = {*hypothesis.problem.held, *model.said_by_effects}
    onsets = set(placed(model))
    bounded = set(model.quantities).difference(hypothesis.free, held, onsets)
    levels = None if record_effects is None else record_effects.levels(problem.free)
    fit = assess(
        model, [shared], hypothesis.values, fixed=held | onsets,
        bounded=sorted(bounded), levels=levels, threads=threads, progress=progress,
    )  # fmt: skip
    part = thinned(hypothesis.problem, thresholds.SEARCH_SAMPLES)
    slight = [n for n, need in part.needs.items() if need.slight and n in part.held]
    few = part.block if record_effects is None else record_effects.shared(part.block)
    fit, _ = with_held_lags(fit, few, slight)
    if onsets:
        # Found by a search of all times: no curvature says how well.
        found = onset_intervals(model, shared, fit.values, hypothesis.problem.held)
        fit = replace(fit, intervals={**fit.intervals, **found})
    if record_effects is not None and fit.level_errors is not None:
        record_effects = record_effects.with_errors(problem.free, fit.level_errors)
    return fit, record_effects


def may_be_absent(effect: Effect, fit: Fit) -> bool:
    """Whether nothing of an effect is left, or of its one parameter not even the sign is told.

    Of several parameters each may be off in a law that is there. An interval that ends where the
    parameter has its bound is open to that side, and says nothing of what would be beyond.
    """
    off = effect.off
    if all(fit.values[name] == value for name, value in off.items()):
        return True
    if len(off) > 1:
        return False
    ((name, value),) = off.items()
    interval = estimates(fit, {})[name].interval
    return interval is not None and interval[0] < value < interval[1]

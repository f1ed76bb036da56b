"""The lag of Eq. 12 where no duty steps: held at 0, or free where the log clearly asks for it.

One state of F_ER serves both directions, so after a reversal it has to go from the yield force of
one to that of the other, though the duty is constant: a lag shows there, by as much as they differ.
Held at 0 it would be a misfit that gets the name of another effect; free in every log it would run
to values that no step of the duty ever showed, wherever something else is missing (1 s on a real
damper). So it is free only where with it nothing else is missing: beside the paper's model
(`freed`), or beside fewer effects than are named without it, or better ones (`earned_by_lags`).
"""

from __future__ import annotations

from dataclasses import replace

from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import lack_of_fit_of, misfit_is_left
from erdctl.diagnose.search import Selection
from erdctl.diagnose.thin import thinned
from erdctl.estimate.held_lags import LAGS
from erdctl.estimate.starts import fresh_start


def freed(problem: Problem) -> Problem:
    """The problem with lags free that are held at 0, if that predicts left-out data better.

    And if they are as short as lags of ER fluids are, and leave nothing but noise.
    """
    names = _slight(problem)
    if not names:
        return problem
    free = without_lags_held(problem)
    thin = thinned(problem, thresholds.SEARCH_SAMPLES)
    starts = [fresh_start(*thresholds.FRESH), fresh_start(*thresholds.FRESH_SECOND)]
    without = fit_hypothesis(thin, (), starts)
    lagging = fit_hypothesis(without_lags_held(thin), (), starts)
    clear = _short(names, lagging) and compare(thin, without, lagging).significant
    return free if clear and not _leaves_a_misfit(lagging) else problem


def without_lags_held(problem: Problem) -> Problem:
    """The same problem with lags free that it holds since no duty steps."""
    names = _slight(problem)
    return replace(problem, held={n: v for n, v in problem.held.items() if n not in names})


def to_be_searched_with_lags(problem: Problem, found: Selection) -> bool:
    """Whether what was found with lags held at 0 leaves little but noise if these are free.

    Effects may then stand in for the lag.
    """
    if not (found.named and _slight(problem)):
        return False
    free, best = without_lags_held(problem), found.best
    start = {**best.values, **dict.fromkeys(_slight(problem), thresholds.FRESH[0])}
    lagging = fit_hypothesis(free, best.effects, [start])
    left = lack_of_fit_of(lagging)
    return not left.significant or left.misfit_rms < thresholds.LITTLE_BUT_NOISE * left.noise_rms


def earned_by_lags(problem: Problem, held: Selection, free: Selection) -> bool:
    """Whether what was found with lags free stands in place of what was found with them at 0.

    With fewer effects, or with as many; and it must predict left-out data better, clearly so than
    the same without lags unless these are in place of an effect. They must be short, and nothing
    else missing.
    """
    names, best = _slight(problem), free.best
    fewer = len(free.named) < len(held.named)
    better = best.score < held.best.score
    if not (fewer or (better and len(free.named) == len(held.named))) or not _short(names, best):
        return False
    if _leaves_a_misfit(best):
        return False
    if fewer and better:
        return True
    start = {**best.values, **dict.fromkeys(names, 0.0)}
    without = fit_hypothesis(problem, best.effects, [start])
    return compare(problem, without, best).significant


def _slight(problem: Problem) -> list[str]:
    """Lags that are held at 0 though the data may hold something of them."""
    return [n for n in LAGS if n in problem.held and problem.needs[n].slight]


def _short(names: list[str], hypothesis: Hypothesis) -> bool:
    return all(hypothesis.values[n] < thresholds.LONGEST_LAG for n in names)


def _leaves_a_misfit(hypothesis: Hypothesis) -> bool:
    return misfit_is_left(hypothesis)

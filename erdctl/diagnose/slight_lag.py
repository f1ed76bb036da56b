"""The lag of Eq. 12 where no duty steps: held at 0, or free where the log clearly asks for it.

One state of F_ER serves both directions, so after a reversal it has to go from the yield force of
one to that of the other, though the duty is constant: a lag shows there, by as much as they differ.
Held at 0 it would be a misfit that gets the name of another effect; free in every log it would run
to values that no step of the duty ever showed, wherever something else is missing (1 s on a real
damper). So it is free only where with it nothing else is missing.
"""

from __future__ import annotations

from dataclasses import replace

from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.predictability import lack_of_fit_test
from erdctl.diagnose.thin import thinned
from erdctl.estimate.starts import fresh_start


def freed(problem: Problem) -> Problem:
    """The problem with lags free that are held at 0, if that predicts left-out data better.

    And if they are as short as lags of ER fluids are, and leave nothing but noise.
    """
    names = [n for n, need in problem.needs.items() if need.slight and n in problem.held]
    if not names:
        return problem
    held = {n: v for n, v in problem.held.items() if n not in names}
    thin = thinned(problem, thresholds.SEARCH_SAMPLES)
    starts = [fresh_start(*thresholds.FRESH), fresh_start(*thresholds.FRESH_SECOND)]
    without = fit_hypothesis(thin, (), starts)
    lagging = fit_hypothesis(replace(thin, held=held), (), starts)
    short = all(lagging.values[n] < thresholds.LONGEST_LAG for n in names)
    clear = short and compare(thin, without, lagging).significant
    clear = clear and not lack_of_fit_test(thin, lagging.residual).significant
    return replace(problem, held=held) if clear else problem

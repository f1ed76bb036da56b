"""The search on a part of the samples, with lags held where no duty steps, or free."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from erdctl.diagnose.executor import Executor
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.search import Selection, search
from erdctl.diagnose.slight_lag import (
    earned_by_lags,
    to_be_searched_with_lags,
    without_lags_held,
)
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters

Problems = tuple[Problem, Problem, Problem]


@dataclass(frozen=True, eq=False)
class Searched:
    """What a search has found, which another diagnosis of the same recording need not seek again.

    problems : the samples of the search, all that it may use, and those kept aside as well
    """

    problems: Problems
    selection: Selection


def searched(
    problems: Problems,
    candidates: Sequence[Effect],
    most: int,
    given_to: Callable[[Problems], Executor],
    seed: int,
    given: Parameters | None,
    untested: Sequence[Effect],
    *,
    once: bool,
    known: Searched | None,
) -> tuple[Searched, Executor]:
    """The search's result, and what fits hypotheses to its problems; for the rest see `search`.

    known : the result, if it is
    """
    if known is not None:
        return known, given_to(known.problems)
    workers = given_to(problems)
    found = search(problems[0], candidates, most, workers, seed, given, untested, once=once)
    if given is None and not found.ended and to_be_searched_with_lags(problems[0], found):
        thin, seen, problem = problems
        lagging = without_lags_held(thin), without_lags_held(seen), without_lags_held(problem)
        others = given_to(lagging)
        with_lags = search(lagging[0], candidates, most, others, seed, None, untested)
        if earned_by_lags(thin, found, with_lags):
            return Searched(lagging, with_lags), others
    return Searched(problems, found), workers

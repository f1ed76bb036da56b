"""Effects that commonly come together, and may be worth nothing one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from erdctl.diagnose.executor import Task
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import starts
from erdctl.model.effect import Effect

FEW = 5  # starts of each of several effects that are tried together
BEST = 3  # of their combinations that are searched to the end


def companion_sets(candidates: Sequence[Effect]) -> Iterator[tuple[Effect, ...]]:
    """Effects with those that commonly come with them."""
    by_name = {e.name: e for e in candidates}
    for effect in candidates:
        others = [by_name[name] for name in effect.companions if name in by_name]
        if others:
            yield (effect, *others)


def joint_task(problem: Problem, base: Hypothesis, effects: tuple[Effect, ...]) -> Task:
    """Effects that may be worth nothing one by one, from the best of many starts."""
    grids = []
    for effect in effects:
        guesses = starts(effect, problem)
        few = guesses[:: -(-len(guesses) // FEW)]
        grids.append([{effect.key(s): v for s, v in g.items()} for g in few])
    points = tuple({**base.values, **_merged(point)} for point in product(*grids))
    return Task("together", (*base.effects, *effects), points, 40, BEST, base.record_effects)


def _merged(parts: Iterable[Mapping[str, float]]) -> dict[str, float]:
    return {name: value for part in parts for name, value in part.items()}

"""Effects that commonly come together, and may be worth nothing one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from erdctl.diagnose import thresholds
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, related
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import starts
from erdctl.model.effect import Effect


def companion_sets(candidates: Sequence[Effect]) -> Iterator[tuple[Effect, ...]]:
    """Effects with those that commonly come with them."""
    by_name = {e.name: e for e in candidates}
    for effect in candidates:
        others = [by_name[name] for name in effect.companions if name in by_name]
        if others:
            yield (effect, *others)


def joint_tasks(
    x: Exploration, parents: Sequence[Hypothesis], candidates: Sequence[Effect], most: int
) -> list[Task]:
    """The fits of effects that commonly come together, beside those of each of some hypotheses.

    most : effects of one model
    """
    return [
        _joint_task(x.problem, parent, effects)
        for parent in parents
        for effects in companion_sets([e for e in candidates if _can_join(e, parent)])
        if len(x.added(parent)) + len(effects) <= most
    ]


def _can_join(effect: Effect, parent: Hypothesis) -> bool:
    """Whether a hypothesis has neither an effect nor another form of it."""
    return all(effect.name != e.name and not related(effect, e) for e in parent.effects)


def _joint_task(problem: Problem, base: Hypothesis, effects: tuple[Effect, ...]) -> Task:
    """The fit of effects that may be worth nothing one by one, from the best of many starts."""
    grids = []
    for effect in effects:
        grid = starts(effect, problem, base.residual)
        few = grid[:: -(-len(grid) // thresholds.COMPANION_STARTS)]
        grids.append([{effect.key(s): v for s, v in g.items()} for g in few])
    points = tuple({**base.values, **_merged(point)} for point in product(*grids))
    return Task(
        "together", (*base.effects, *effects), points,
        thresholds.STEPS_TOGETHER, thresholds.COMPANION_BEST, base.record_effects,
    )  # fmt: skip


def _merged(parts: Iterable[Mapping[str, float]]) -> dict[str, float]:
    return {name: value for part in parts for name, value in part.items()}

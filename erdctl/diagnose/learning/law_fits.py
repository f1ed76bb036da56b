"""Laws fitted beside a hypothesis, and what they take of its misfit."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence

import numpy as np

from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare, ranked
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, with_effect
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.screening import Candidate
from erdctl.model.learned.law import Law, LearnedEffect


def fitted(
    x: Exploration, parent: Hypothesis, candidates: Iterable[Candidate], stage: str
) -> list[Hypothesis]:
    """Some laws fitted beside a parent, the best first; what was fitted before is not again."""
    tasks = {_asked(t): t for t in (with_effect(stage, parent, c) for c in candidates)}
    known = x.explored.asked
    new = {key: task for key, task in tasks.items() if key not in known}
    known.update(zip(new, x.executor.fit(x.problem, list(new.values())), strict=True))
    found = [h for h in map(known.get, tasks) if h is not None]
    for h in found:
        x.explored.keep(h)
    return ranked(found)


def _asked(task: Task) -> Hashable:
    """What a task asks for."""
    effects = ((e.name, e.law) if isinstance(e, LearnedEffect) else e.name for e in task.effects)
    starts = (tuple(start.items()) for start in task.starts)
    return tuple(effects), tuple(starts)


def taken(problem: Problem, parent: Hypothesis, found: Hypothesis) -> float:
    """What a hypothesis takes of the cross-validated mean square of another [N^2]."""
    gain = compare(problem, parent, found)
    return gain.before - gain.after


def promised(parent: Hypothesis, tried: Sequence[Candidate]) -> float:
    """What some laws may take at most of the cross-validated mean square of a parent [N^2]."""
    most = max((c.gain for c in tried), default=0.0)
    return thresholds.PROMISED * most * _square(parent)


def _square(hypothesis: Hypothesis) -> float:
    """The cross-validated mean square [N^2]."""
    weight = hypothesis.problem.block.weight
    return float(np.average(hypothesis.cross_validated**2, weights=weight))


def law_of(hypothesis: Hypothesis) -> tuple[Law, dict[str, float]]:
    """The law that was added last, and its own values."""
    effect = hypothesis.effects[-1]
    assert isinstance(effect, LearnedEffect)
    return effect.law, effect.local(hypothesis.values)

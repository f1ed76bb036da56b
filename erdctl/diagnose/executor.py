"""Hypotheses, run here or in worker processes: the same results either way, in the order asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import NamedTuple

from erdctl.core.errors import ComputationProblem
from erdctl.core.recording import Array
from erdctl.core.workers import pool
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis, rank_starts
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.record_effects import RecordEffects
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

Progress = Callable[[str, str], None]


@dataclass(frozen=True, eq=False)
class Task:
    """One hypothesis to try.

    stage : for whoever watches;  effects, starts : see `fit_hypothesis`;  steps : of the search, at most
    best : how many starts are left after a glance at all of them, if not all are
    scatter : of the records to begin with, see `fit_hypothesis`
    """

    stage: str
    effects: tuple[Effect, ...]
    starts: tuple[Mapping[str, float], ...]
    steps: int = 25
    best: int | None = None
    record_effects: RecordEffects | None = None

    @property
    def name(self) -> str:
        """The effects, in words."""
        return ", ".join(e.name for e in self.effects) or "the paper's model"


class Answer(NamedTuple):
    """What a worker sends of a hypothesis: what it was asked is known, and the problem is long.

    weight : (n,) of the samples, where the hypothesis's channel makes some of them doubtful
    """

    values: dict[str, float]
    residual: Array
    cross_validated: Array
    evaluations: int
    weight: Array | None
    record_effects: RecordEffects | None


class Executor:
    """Tries hypotheses on some problems; see `executor`."""

    def __init__(
        self,
        problems: Sequence[Problem],
        jobs: int = 1,
        progress: Progress = lambda stage, what: None,
    ) -> None:
        self.problems, self.jobs, self.progress = tuple(problems), jobs, progress
        self._pool: ProcessPoolExecutor | None = None

    def run(self, problem: Problem, tasks: Sequence[Task]) -> list[Hypothesis | None]:
        """A hypothesis for each task; None for effects that cannot act together."""
        if self.jobs == 1 or len(tasks) < 2:
            return [self._here(problem, task) for task in tasks]
        if self._pool is None:
            # What a parameter would need is for people, and holds functions without a name.
            sent = [replace(s, needs={}) for s in self.problems]
            self._pool = pool(self.jobs, _prepare, *sent)
        number = next(i for i, s in enumerate(self.problems) if s is problem)
        futures = [self._pool.submit(_answer, number, task) for task in tasks]
        of = dict(zip(futures, tasks, strict=True))
        self.progress(tasks[0].stage, tasks[0].name)
        try:
            for done in as_completed(futures):
                self.progress(of[done].stage, of[done].name)
            return [_hypothesis_of(problem, t, f) for t, f in zip(tasks, futures, strict=True)]
        except BrokenProcessPool:
            raise ComputationProblem(
                "a worker process was killed, perhaps for want of memory; try --jobs 1"
            ) from None

    def _here(self, problem: Problem, task: Task) -> Hypothesis | None:
        self.progress(task.stage, task.name)
        return evaluate(problem, task)

    def leave(self) -> None:
        """End the workers."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)


@contextmanager
def executor(problems: Sequence[Problem], jobs: int, progress: Progress) -> Iterator[Executor]:
    """An executor of so many workers, which begin when there is work for two of them.

    jobs : 1 for none, all is then done in this process
    """
    # The field's lag takes another path, which rounds otherwise, once a compiler is loaded. With it
    # loaded from the beginning results are the same in every process.
    import erdctl.model.recurrences  # noqa: F401  # only to load the compiler

    found = Executor(problems, jobs, progress)
    try:
        yield found
    finally:
        found.leave()


def evaluate(problem: Problem, task: Task) -> Hypothesis | None:
    """The hypothesis of a task."""
    try:
        starts: Sequence[Mapping[str, float]] = task.starts
        if task.best is not None:
            starts = rank_starts(problem, task.effects, starts, task.record_effects)[: task.best]
        return fit_hypothesis(problem, task.effects, starts, task.steps, task.record_effects)
    except ValueError:
        return None  # effects that cannot act together


def _hypothesis_of(
    problem: Problem, task: Task, future: Future[Answer | None]
) -> Hypothesis | None:
    answer = future.result()
    if answer is None:
        return None
    values, residual, cross_validated, evaluations, weight, record_effects = answer
    part = problem
    if weight is not None:
        part = replace(problem, block=problem.block._replace(weight=weight))
    return Hypothesis(
        part, Model(task.effects), values, residual, cross_validated, evaluations, record_effects
    )


_problems: tuple[Problem, ...] = ()  # of this process, if it is a worker


def _prepare(*problems: Problem) -> None:
    global _problems
    import erdctl.model.recurrences  # noqa: F401  # see `executor`

    _problems = problems


def _answer(number: int, task: Task) -> Answer | None:
    problem = _problems[number]
    hypothesis = evaluate(problem, task)
    if hypothesis is None:
        return None
    weight = None if hypothesis.problem is problem else hypothesis.problem.block.weight
    t = hypothesis
    return Answer(t.values, t.residual, t.cross_validated, t.evaluations, weight, t.record_effects)

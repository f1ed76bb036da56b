"""Trials, run here or in worker processes: the same results either way, in the order asked for."""

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
from erdctl.diagnose.hypothesis import Trial, attempt, ranked
from erdctl.diagnose.problem import Study
from erdctl.diagnose.record_effects import Scatter
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

Progress = Callable[[str, str], None]


@dataclass(frozen=True, eq=False)
class Task:
    """One hypothesis to try.

    stage : for whoever watches;  effects, starts : see `attempt`;  steps : of the search, at most
    best : how many starts are left after a glance at all of them, if not all are
    scatter : of the records to begin with, see `attempt`
    """

    stage: str
    effects: tuple[Effect, ...]
    starts: tuple[Mapping[str, float], ...]
    steps: int = 25
    best: int | None = None
    scatter: Scatter | None = None

    @property
    def name(self) -> str:
        """The effects, in words."""
        return ", ".join(e.name for e in self.effects) or "the paper's model"


class Answer(NamedTuple):
    """What a worker sends of a trial: what it was asked is known, and the study is long.

    weight : (n,) of the samples, where the trial's channel makes some of them doubtful
    """

    values: dict[str, float]
    residual: Array
    unseen: Array
    evaluations: int
    weight: Array | None
    scatter: Scatter | None


class Crew:
    """Tries hypotheses on some studies; see `crew`."""

    def __init__(
        self, studies: Sequence[Study], jobs: int = 1, progress: Progress = lambda stage, what: None
    ) -> None:
        self.studies, self.jobs, self.progress = tuple(studies), jobs, progress
        self._pool: ProcessPoolExecutor | None = None

    def run(self, study: Study, tasks: Sequence[Task]) -> list[Trial | None]:
        """A trial for each task; None for effects that cannot act together."""
        if self.jobs == 1 or len(tasks) < 2:
            return [self._here(study, task) for task in tasks]
        if self._pool is None:
            # What a parameter would need is for people, and holds functions without a name.
            sent = [replace(s, needs={}) for s in self.studies]
            self._pool = pool(self.jobs, _prepare, *sent)
        number = next(i for i, s in enumerate(self.studies) if s is study)
        futures = [self._pool.submit(_answer, number, task) for task in tasks]
        of = dict(zip(futures, tasks, strict=True))
        self.progress(tasks[0].stage, tasks[0].name)
        try:
            for done in as_completed(futures):
                self.progress(of[done].stage, of[done].name)
            return [_trial(study, t, f) for t, f in zip(tasks, futures, strict=True)]
        except BrokenProcessPool:
            raise ComputationProblem(
                "a worker process was killed, perhaps for want of memory; try --jobs 1"
            ) from None

    def _here(self, study: Study, task: Task) -> Trial | None:
        self.progress(task.stage, task.name)
        return tried(study, task)

    def leave(self) -> None:
        """End the workers."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)


@contextmanager
def crew(studies: Sequence[Study], jobs: int, progress: Progress) -> Iterator[Crew]:
    """A crew of so many workers, which begin when there is work for two of them.

    jobs : 1 for none, all is then done in this process
    """
    # The field's lag takes another path, which rounds otherwise, once a compiler is loaded. With it
    # loaded from the beginning results are the same in every process.
    import erdctl.model.recurrences  # noqa: F401  # only to load the compiler

    found = Crew(studies, jobs, progress)
    try:
        yield found
    finally:
        found.leave()


def tried(study: Study, task: Task) -> Trial | None:
    """The trial of a task."""
    try:
        starts: Sequence[Mapping[str, float]] = task.starts
        if task.best is not None:
            starts = ranked(study, task.effects, starts, task.scatter)[: task.best]
        return attempt(study, task.effects, starts, task.steps, task.scatter)
    except ValueError:
        return None  # effects that cannot act together


def _trial(study: Study, task: Task, future: Future[Answer | None]) -> Trial | None:
    answer = future.result()
    if answer is None:
        return None
    values, residual, unseen, evaluations, weight, scatter = answer
    part = study
    if weight is not None:
        part = replace(study, block=study.block._replace(weight=weight))
    return Trial(part, Model(task.effects), values, residual, unseen, evaluations, scatter)


_studies: tuple[Study, ...] = ()  # of this process, if it is a worker


def _prepare(*studies: Study) -> None:
    global _studies
    import erdctl.model.recurrences  # noqa: F401  # see `crew`

    _studies = studies


def _answer(number: int, task: Task) -> Answer | None:
    study = _studies[number]
    trial = tried(study, task)
    if trial is None:
        return None
    weight = None if trial.study is study else trial.study.block.weight
    t = trial
    return Answer(t.values, t.residual, t.unseen, t.evaluations, weight, t.scatter)

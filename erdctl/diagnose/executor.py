"""Hypotheses fitted here, in worker processes or on a cluster: the same results, in order."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor as PoolExecutor
from concurrent.futures import Future, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TypeVar

from erdctl.core.cluster import Cluster
from erdctl.core.errors import ComputationProblem, EffectFailed, IncompatibleEffects
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import Array
from erdctl.core.workers import alone_with, leave, pool
from erdctl.diagnose import thresholds
from erdctl.diagnose.bounds import Bounds
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis, rank_starts
from erdctl.diagnose.of_steps import as_it_slips
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.record_effects import RecordEffects
from erdctl.estimate.least_squares import Fitted
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.slots import Values

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Task:
    """One hypothesis to fit.

    stage : for whoever watches;  effects, starts : see `fit_hypothesis`
    steps : of the search, at most
    best : how many starts are left after a look at all of them, if not all are
    record_effects : to begin with
    """

    stage: str
    effects: tuple[Effect, ...]
    starts: tuple[Mapping[str, float], ...]
    steps: int = thresholds.STEPS
    best: int | None = None
    record_effects: RecordEffects | None = None

    @property
    def name(self) -> str:
        """The effects, in words."""
        return ", ".join(e.name for e in self.effects) or "the paper's model"


class Answer(NamedTuple):
    """What processes send of a hypothesis: its effects are known there, and the problem is long.

    weight : (n,) of the samples, where the hypothesis's channel makes some of them doubtful
    told : what the problem holds and the hypothesis does not
    """

    fitted: Fitted
    cross_validated: Array
    weight: Array | None
    told: tuple[str, ...]
    record_effects: RecordEffects | None


class Executor:
    """Fits hypotheses to some problems; see `executor`."""

    def __init__(
        self,
        problems: Sequence[Problem],
        jobs: int = 1,
        progress: Progress = lambda stage, what: None,
        bounds: Bounds | None = None,
        cluster: Cluster | None = None,
    ) -> None:
        self.problems, self.jobs, self.progress = tuple(problems), jobs, progress
        self.cluster = cluster
        self.bounds = bounds or Bounds({}, {})
        self._submit: Callable[..., Future[Any]] | None = None
        self._pool: PoolExecutor | None = None
        self._sendable: set[str] = set()

    def fit(self, problem: Problem, tasks: Sequence[Task]) -> list[Hypothesis | None]:
        """A hypothesis for each task; None where no model can hold its effects, or no such log."""
        found = self._fits(problem, tasks)
        return [h if h and self.possible(h.values) else None for h in found]

    def possible(self, values: Values) -> bool:
        """Whether the log allows values of parameters."""
        least, most = self.bounds
        within = all(values.get(name, least[name]) >= least[name] for name in least)
        return within and all(values.get(name, most[name]) <= most[name] for name in most)

    @property
    def most(self) -> Values:
        """Values of parameters above which a hypothesis is none, by name."""
        return self.bounds.most

    def _fits(self, problem: Problem, tasks: Sequence[Task]) -> list[Hypothesis | None]:
        """A hypothesis for each task; None for effects that no model can hold together."""
        if self._alone or len(tasks) < 2:
            return [
                self._here(problem, task, number, len(tasks))
                for number, task in enumerate(tasks, start=1)
            ]
        for task in tasks:
            self._check_sendable(task.effects)
        with self._told_of_loss():
            futures = [self._there(problem, _answer_to, task) for task in tasks]
            of = dict(zip(futures, tasks, strict=True))
            self.progress(tasks[0].stage, part_of(tasks[0].name, 1, len(tasks)))
            for number, done in enumerate(as_completed(futures), start=1):
                # Of those that are computed at a time the one that ended; the next has its number.
                begun = min(number + 1, len(tasks))
                self.progress(of[done].stage, part_of(of[done].name, begun, len(tasks)))
            answers = [f.result() for f in futures]
        return [
            None if a is None else _as_here(problem, t.effects, a)
            for t, a in zip(tasks, answers, strict=True)
        ]

    def each(
        self,
        problem: Problem,
        work: Callable[[Problem, Hypothesis], T],
        hypotheses: Sequence[Hypothesis],
    ) -> list[T]:
        """What a function gives of each hypothesis on a problem; workers have to find it by name.

        The problem is that of the executor: all that a hypothesis does not hold back.
        """
        if self._alone or len(hypotheses) < 2:
            return [work(problem, h) for h in hypotheses]
        for h in hypotheses:
            self._check_sendable(h.effects)
        with self._told_of_loss():
            futures = [
                self._there(problem, _worked, work, h.effects, _as_sent(problem, h))
                for h in hypotheses
            ]
            return [f.result() for f in futures]

    @property
    def _alone(self) -> bool:
        return self.jobs == 1 and self.cluster is None

    @contextmanager
    def _told_of_loss(self) -> Iterator[None]:
        """Raise ComputationProblem where workers are lost."""
        lost = () if self.cluster is None else self.cluster.lost
        try:
            yield
        except BrokenProcessPool:
            raise ComputationProblem(
                "a worker process was killed, perhaps for want of memory; try --jobs 1"
            ) from None
        except lost:
            raise ComputationProblem(
                "the cluster has gone, or its workers were killed, perhaps for want of memory"
            ) from None

    def _there(self, problem: Problem, work: Callable[..., T], *given: object) -> Future[T]:
        """What a function will give, by a worker, of a problem that it has and of the rest."""
        submit = self._submit = self._submit or self._begun()
        number = next(i for i, p in enumerate(self.problems) if p is problem)
        return submit(work, number, *given)

    def _begun(self) -> Callable[..., Future[Any]]:
        """Workers that have the problems: what gives one of them work on one of these."""
        # What a parameter would need is for people, and holds functions without a name.
        sent = tuple(replace(p, needs={}) for p in self.problems)
        if self.cluster is not None:
            there, shared = self.cluster.executor(), self.cluster.shared(sent)
            self._pool = there
            return lambda *work: there.submit(alone_with, _on_one_of, shared, *work)
        here = self._pool = pool(self.jobs, _prepare, *sent)
        return lambda *work: here.submit(_here, *work)

    def fit_compatible(self, problem: Problem, tasks: Sequence[Task]) -> list[Hypothesis]:
        """The same for effects that have been together in one model before.

        One that asks for what the log does not allow, now that others have gone, predicts nothing.
        """
        found = [h for h in self._fits(problem, tasks) if h is not None]
        assert len(found) == len(tasks), "effects of a hypothesis can act together"
        nothing = problem.block.force
        return [
            h if self.possible(h.values) else replace(h, cross_validated=nothing) for h in found
        ]

    def _here(self, problem: Problem, task: Task, number: int, count: int) -> Hypothesis | None:
        self.progress(task.stage, part_of(task.name, number, count))
        return fitted(problem, task)

    def _check_sendable(self, effects: Sequence[Effect]) -> None:
        """Raise EffectFailed for an effect whose functions a worker process could not find."""
        for effect in effects:
            if effect.name in self._sendable:
                continue
            try:
                pickle.dumps(effect)
            except (pickle.PicklingError, AttributeError, TypeError) as error:
                raise EffectFailed(
                    f"effect {effect.name}",
                    f"cannot be sent to a worker process ({error}); define its functions at the"
                    " top level of its file, or use --jobs 1",
                ) from error
            self._sendable.add(effect.name)

    def leave(self) -> None:
        """End the workers."""
        if self._pool is not None:
            leave(self._pool)


@contextmanager
def executor(
    problems: Sequence[Problem],
    jobs: int,
    progress: Progress,
    bounds: Bounds | None = None,
    cluster: Cluster | None = None,
) -> Iterator[Executor]:
    """An executor with so many workers, which begin when there is work for two of them.

    jobs : 1 for none, all is then done in this process
    bounds : values of parameters between which a hypothesis is one
    cluster : whose workers do it, in place of this machine's
    """
    # The field's lag takes another path, which rounds otherwise, once a compiler is loaded. With it
    # loaded from the beginning results are the same in every process.
    import erdctl.model.recurrences  # noqa: F401  # only to load the compiler

    found = Executor(problems, jobs, progress, bounds, cluster)
    try:
        yield found
    finally:
        found.leave()


def fitted(problem: Problem, task: Task) -> Hypothesis | None:
    """The hypothesis of a task; None for effects that no model can hold together.

    Whatever else goes wrong in an effect ends the diagnosis: an effect that is left out because it
    is broken would look as if it were absent.
    """
    try:
        starts: Sequence[Mapping[str, float]] = task.starts
        if task.best is not None:
            starts = rank_starts(problem, task.effects, starts, task.record_effects)[: task.best]
        found = fit_hypothesis(problem, task.effects, starts, task.steps, task.record_effects)
        return as_it_slips(found)
    except IncompatibleEffects:
        return None


def _as_sent(problem: Problem, h: Hypothesis) -> Answer:
    """A hypothesis on a problem for another process that has this problem."""
    part = h.problem
    weight = None if part.block is problem.block else part.block.weight
    told = tuple(problem.held.keys() - part.held.keys())
    return Answer(h.fitted, h.cross_validated, weight, told, h.record_effects)


def _as_here(problem: Problem, effects: tuple[Effect, ...], answer: Answer) -> Hypothesis:
    """The hypothesis again, of this process's own effects."""
    part = problem.with_free(answer.told) if answer.told else problem
    if answer.weight is not None:
        part = replace(part, block=problem.block._replace(weight=answer.weight))
    here = replace(answer.fitted, model=Model(effects))
    return Hypothesis(part, here, answer.cross_validated, answer.record_effects)


_problems: tuple[Problem, ...] = ()  # of this process, if it is a worker


def _prepare(*problems: Problem) -> None:
    global _problems
    import erdctl.model.recurrences  # noqa: F401  # see `executor`

    _problems = problems


def _here(work: Callable[..., T], number: int, *given: object) -> T:
    return work(_problems[number], *given)


def _on_one_of(problems: Sequence[Problem], work: Callable[..., T], number: int, *given: Any) -> T:
    import erdctl.model.recurrences  # noqa: F401  # see `executor`

    return work(problems[number], *given)


def _answer_to(problem: Problem, task: Task) -> Answer | None:
    h = fitted(problem, task)
    return None if h is None else _as_sent(problem, h)


def _worked(
    problem: Problem,
    work: Callable[[Problem, Hypothesis], T],
    effects: tuple[Effect, ...],
    answer: Answer,
) -> T:
    return work(problem, _as_here(problem, effects, answer))

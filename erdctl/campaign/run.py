"""Jobs on whatever executor there is, each outcome kept as it comes."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from dataclasses import dataclass, replace

from erdctl.campaign.plan import Job
from erdctl.campaign.work import Done, done, failed, refused
from erdctl.core.cluster import GONE
from erdctl.core.errors import ComputationProblem, ExitCode
from erdctl.core.workers import leave, pool
from erdctl.io.campaign_journal import Entry, Journal

DIED = "its worker process was killed, perhaps for want of memory"


@dataclass(frozen=True)
class Crew:
    """Where jobs are done.

    executor : a new one, as often as it is called;  in_hand : how many jobs it has at a time
    """

    executor: Callable[[], Executor]
    in_hand: Callable[[], int]


def here(jobs: int) -> Crew:
    """So many worker processes on this machine; each has its next job at hand."""
    return Crew(lambda: pool(jobs), lambda: 2 * jobs)


def run(
    jobs: Sequence[Job],
    journal: Journal,
    crew: Crew,
    on_done: Callable[[Entry, bool], None] = lambda entry, new: None,
) -> None:
    """Do what is not done yet; all of it is then in the journal.

    on_done : called with each entry, and whether it is new, in the order in which they come
    Raises ComputationProblem if the cluster goes; what was done by then is kept.
    """
    asked = []
    for job in jobs:
        before = journal.read(job.key)
        asked.append(replace(job, known=before.hash) if before and _stands(before) else job)
    for job, outcome in _outcomes(asked, crew):
        if outcome is not None:
            journal.write(outcome.entry, outcome.documents)
            on_done(outcome.entry, True)
        else:
            before = journal.read(job.key)
            assert before is not None, "only what has an entry is known"
            on_done(before, False)


def entries(jobs: Sequence[Job], journal: Journal) -> Iterator[Entry]:
    """What was kept of jobs that are done, in their order."""
    for job in jobs:
        found = journal.read(job.key)
        if found is None:
            raise ComputationProblem(
                f"what was kept of {job.name} is gone from {journal.folder}; run it again"
            )
        yield found


def _stands(entry: Entry) -> bool:
    """Whether doing it again could only give the same: not what a machine lacked, or a user."""
    return entry.exit_code in (ExitCode.DONE, ExitCode.BAD_INPUT)


def _outcomes(jobs: Sequence[Job], crew: Crew) -> Iterator[tuple[Job, Done | None]]:
    """Outcomes as they come. What a worker may have died of is done again, one job at a time."""
    for job in jobs:
        if job.problem is not None:
            yield job, refused(job)
    waiting = deque(job for job in jobs if job.problem is None)
    suspects: deque[Job] = deque()
    while waiting or suspects:
        executor = crew.executor()
        try:
            if suspects:
                yield from _among(executor, suspects, lambda: 1)
            yield from _among(executor, waiting, crew.in_hand)
        except _Died as loss:
            if len(loss.jobs) == 1:
                yield loss.jobs[0], failed(loss.jobs[0], DIED)
            else:
                suspects.extend(loss.jobs)
        finally:
            leave(executor)


class _Died(Exception):
    """A worker process died; jobs : that were in hand, of one of which it died."""

    def __init__(self, jobs: list[Job]) -> None:
        super().__init__(DIED)
        self.jobs = jobs


def _among(
    executor: Executor, waiting: deque[Job], in_hand: Callable[[], int]
) -> Iterator[tuple[Job, Done | None]]:
    """Outcomes of the jobs that wait, each taken from them as it is begun."""
    running: dict[Future[Done | None], Job] = {}
    lost: list[Job] = []
    try:
        while waiting or running:
            most = in_hand()
            while waiting and len(running) < most:
                try:
                    future = executor.submit(done, waiting[0])
                except BrokenExecutor:
                    lost += running.values()
                    raise _Died(lost) from None
                running[future] = waiting.popleft()
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                job = running.pop(future)
                try:
                    outcome = future.result()
                except BrokenExecutor:
                    lost.append(job)
                except CancelledError:
                    raise ComputationProblem(
                        f"{GONE}; what was done is kept: run it again"
                    ) from None
                except Exception as error:  # noqa: BLE001  # of the cluster's own: a worker that cannot do it
                    yield job, failed(job, f"{type(error).__name__}: {error}")
                else:
                    yield job, outcome
            if lost:
                raise _Died([*lost, *running.values()])
    finally:
        for future in running:
            future.cancel()

"""Many cases in worker processes. A case's hash is handed out before its diagnosis is begun."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

from erdctl.core.cluster import Cluster
from erdctl.core.errors import ComputationProblem
from erdctl.core.workers import alone_with, leave
from erdctl.core.workers import pool as workers
from erdctl.prove.case import Sealed, Wish, seal
from erdctl.prove.judge import Failed, Result, judge
from erdctl.prove.kept import Kept

Outcome = Result | Failed


def prove(
    wish: Wish,
    seeds: Sequence[int],
    folder: Path,
    *,
    jobs: int,
    cluster: Cluster | None = None,
    on_sealed: Callable[[Sealed], None] = lambda sealed: None,
    on_outcome: Callable[[Outcome], None] = lambda outcome: None,
) -> tuple[Outcome, ...]:
    """Outcomes of the cases of some seeds, in their order; the same for any number of jobs.

    folder : empty, or of the same proof, whose outcomes are then not worked out again
    jobs : cases at a time;  cluster : where, if not here; its workers see the folder
    on_sealed : called with each case before its diagnosis starts
    on_outcome : called with each outcome, in the order of the seeds
    Raises ComputationProblem if a worker dies, or the cluster goes.
    """
    kept = Kept.of(folder, wish, seeds[0])
    found = {number: kept.read(number) for number in range(1, len(seeds) + 1)}
    done: dict[int, Outcome] = {n: r for n, r in found.items() if r is not None}
    left = [(n, seed) for n, seed in enumerate(seeds, start=1) if n not in done]
    reported = 0

    def report() -> None:
        nonlocal reported
        while reported + 1 in done:
            reported += 1
            on_outcome(done[reported])

    report()
    # Also for one job: linear algebra rounds otherwise with several threads.
    pool = workers(jobs) if cluster is None else cluster.executor()
    try:
        for outcome in _outcomes(pool, wish, left, folder, jobs, on_sealed):
            if isinstance(outcome, Result):
                kept.write(outcome)
            done[outcome.number] = outcome
            report()
    except BrokenProcessPool:
        raise ComputationProblem(
            "a worker process was killed, perhaps for want of memory; try --jobs 1"
        ) from None
    except CancelledError:  # what kills its worker is a case that failed, see `_error`
        raise ComputationProblem(
            "the cluster has gone; with --keep what was done is taken up again"
        ) from None
    finally:
        leave(pool)
    return tuple(done[number] for number in sorted(done))


def _outcomes(
    pool: Executor,
    wish: Wish,
    cases: Sequence[tuple[int, int]],
    folder: Path,
    jobs: int,
    on_sealed: Callable[[Sealed], None],
) -> Iterator[Outcome]:
    """Outcomes as they come: one case in hand for each job, sealed and then judged.

    cases : number and seed of each
    """
    waiting = iter(cases)
    sealing: dict[Future[Sealed], tuple[int, int]] = {}
    judging: dict[Future[Result], Sealed] = {}

    def begin() -> None:
        for number, seed in waiting:
            sealing[pool.submit(alone_with, seal, wish, seed, number, folder)] = (number, seed)
            return

    for _ in range(jobs):
        begin()
    while sealing or judging:
        pending: list[Future[Any]] = [*sealing, *judging]
        ready, _ = wait(pending, return_when=FIRST_COMPLETED)
        for future in [f for f in sealing if f in ready]:
            number, seed = sealing.pop(future)
            error = _error(future)
            if error is None:
                sealed = future.result()
                on_sealed(sealed)
                judging[pool.submit(alone_with, judge, sealed)] = sealed
            else:
                yield Failed(number, seed, error)
                begin()
        for finished in [f for f in judging if f in ready]:
            sealed = judging.pop(finished)
            error = _error(finished)
            yield Failed(sealed.number, sealed.seed, error) if error else finished.result()
            begin()


def _error(future: Future[Sealed] | Future[Result]) -> str | None:
    """What went wrong in a worker: one case must not cost the other hundred."""
    error = future.exception()
    if isinstance(error, BrokenProcessPool):
        raise error
    return None if error is None else f"{type(error).__name__}: {error}"

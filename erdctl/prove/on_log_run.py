"""Trials of a recording in worker processes, each kept on disk so that a run can be taken up."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from concurrent.futures import Future, as_completed
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import msgspec

from erdctl.core.errors import ComputationProblem
from erdctl.core.version import __version__
from erdctl.core.workers import pool
from erdctl.prove.on_log import Hiding, Host, Trial


def trials(
    host: Host,
    names: Sequence[str],
    sizes: Sequence[float],
    nulls: int,
    folder: Path,
    *,
    jobs: int,
    on_trials: Callable[[Sequence[Trial]], None] = lambda trials: None,
) -> list[Trial]:
    """Every trial, effects in their order and then the nulls; the same for any number of jobs.

    folder : where outcomes are kept; those of the same recording and wishes are not done again
    on_trials : called with the outcomes of each effect as they come
    """
    mark = _mark(host, sizes)
    keys = [*names, *(f"null-{i}" for i in range(nulls))]
    places = {key: folder / f"{key}-{mark}.json" for key in keys}
    done = {k: _read(p) for k, p in places.items() if p.exists()}
    for kept in done.values():
        on_trials(kept)
    waiting = [key for key in keys if key not in done]
    if waiting:
        workers = pool(min(jobs, len(waiting)), _begin, host)
        try:
            futures: dict[Future[list[Trial]], str] = {
                workers.submit(_trials, key, tuple(sizes)): key for key in waiting
            }
            for future in as_completed(futures):
                key, outcome = futures[future], future.result()
                places[key].write_bytes(msgspec.json.encode(outcome))
                done[key] = outcome
                on_trials(outcome)
        except BrokenProcessPool:
            raise ComputationProblem(
                "a worker process was killed, perhaps for want of memory; try --jobs 1"
            ) from None
        finally:
            workers.shutdown(cancel_futures=True)
    return [trial for key in keys for trial in done[key]]


def _mark(host: Host, sizes: Sequence[float]) -> str:
    """What an outcome depends on, in a few characters."""
    of = [
        __version__, *(s.sha256 for s in host.recording.sources), host.every, host.seed,
        *sizes, *host.anyway,
    ]  # fmt: skip
    return hashlib.sha256(repr(of).encode()).hexdigest()[:12]


def _read(path: Path) -> list[Trial]:
    return msgspec.json.decode(path.read_bytes(), type=list[Trial])


_hiding: Hiding | None = None  # of this process, a worker


def _begin(host: Host) -> None:
    global _hiding
    import erdctl.model.recurrences  # noqa: F401  # see `diagnose.executor`

    _hiding = Hiding(host)


def _trials(key: str, sizes: Sequence[float]) -> list[Trial]:
    assert _hiding is not None
    if key.startswith("null-"):
        return [_hiding.null(int(key.removeprefix("null-")))]
    return _hiding.trials(key, sizes)

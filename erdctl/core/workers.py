"""Worker processes: how many, and how they begin."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from threading import Lock, Thread
from typing import Any, TypeVar

S = TypeVar("S")
T = TypeVar("T")


def cores() -> int:
    """Cores that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def pool(jobs: int, begin: Callable[..., None] | None = None, *given: Any) -> ProcessPoolExecutor:
    """So many workers with one thread each, every one of which first calls `begin(*given)`.

    Fresh processes, not forks: a fork inherits locks of threads that it does not inherit.
    """
    return ProcessPoolExecutor(
        jobs, mp_context=get_context("spawn"), initializer=_begin, initargs=(begin, given)
    )


@contextmanager
def one_thread() -> Iterator[None]:
    """One thread for linear algebra, whose own would fight with ours for the same cores.

    The command line says so before NumPy loads; in a user's program it is loaded already.
    """
    import scipy.linalg  # noqa: F401  # a library can be limited only once it is loaded
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        yield


# Linear algebra is limited for a whole process, and a worker of a cluster may have several threads.
_ALONE = Lock()


@contextmanager
def alone() -> Iterator[None]:
    """One task at a time in this process, with one thread: the tasks are the parallelism."""
    with _ALONE, one_thread():
        yield


def alone_with(work: Callable[..., T], *given: Any) -> T:
    """What a task gives; for a worker that somebody else has started, as those of a cluster."""
    with alone():
        return work(*given)


def ahead(work: Callable[[S], T], items: Sequence[S], threads: int) -> Generator[T, None, None]:
    """Results in order, by so many threads that are ahead of whoever takes them.

    Nothing is begun before its result is asked for where there is one thread; where there are more,
    what has not begun once nobody takes any more is dropped. For work that leaves Python's lock.
    """
    if threads == 1:
        yield from map(work, items)
        return
    with ThreadPoolExecutor(threads) as pool:
        try:
            for future in [pool.submit(work, item) for item in items]:
                yield future.result()
        finally:
            pool.shutdown(cancel_futures=True)


def leave(executor: Executor) -> None:
    """Let the tasks that run end, and drop those that wait; a cluster drops all."""
    if isinstance(executor, ProcessPoolExecutor):
        executor.shutdown(cancel_futures=True)
    else:
        executor.shutdown(wait=False)


def _begin(begin: Callable[..., None] | None, given: tuple[Any, ...]) -> None:
    """The tasks are the parallelism; threads below them would fight for the same cores."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends a worker without a traceback
    Thread(target=_end_with_parent, daemon=True).start()
    import scipy.linalg  # noqa: F401  # a library can be limited only once it is loaded
    from threadpoolctl import threadpool_limits

    threadpool_limits(1)
    if begin is not None:
        begin(*given)


def _end_with_parent() -> None:
    """A command that is killed cannot end its workers, which would wait for tasks for ever."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)

"""Memory that this process may still take, and what a file claims of it before it is read."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from erdctl.core.errors import ComputationProblem, InputProblem

# The columns, those derived from them by a model, and one more while something is computed.
COPIES = 3
SMALL = 1 << 31  # bytes that are granted whatever the file looks like
# Measured channels have noise in every sample; no compression makes less than half a bit of 64.
DENSEST = 200
LIBRARIES = 760_000_000  # bytes of address space from which `validate` works, with two cores
# What pyarrow and Python say where a process may have no more threads, or no memory for one.
_NO_THREAD = ("launch worker", "start new thread")
_CGROUP = "/sys/fs/cgroup"


def check_claim(
    decoded: int,
    size: int,
    file: str,
    what: str,
    *,
    copies: int = COPIES,
    about: bool = False,
    held: bool = True,
) -> None:
    """Raise InputProblem if what a file holds will not fit into memory, or cannot be measured.

    decoded : bytes of `what` in memory, as the file states them;  size : bytes of the file
    copies : of `decoded` that will be in memory;  about : `decoded` is an estimate
    held : whether it will be there all at once
    """
    need, have = decoded * copies, available() if held else None
    if have is not None and need > have:
        raise InputProblem(
            f"too large: {what} need {'about ' if about else ''}{gigabytes(need)} of memory and"
            f" {gigabytes(have)} are free; split it into several logs",
            file=file,
        )
    if need > SMALL and decoded > DENSEST * size:
        raise InputProblem(
            f"{gigabytes(size)} that open to {gigabytes(decoded)} ({what}): no measured log is"
            f" more than {DENSEST} times its file; it is damaged, or made to fill the memory",
            file=file,
        )


@contextmanager
def while_reading(name: str) -> Iterator[None]:
    """Raise ComputationProblem where memory or threads do not suffice to open or read a file."""
    try:
        yield
    except MemoryError:
        raise ComputationProblem(f"out of memory while reading {name}; split it") from None
    except RuntimeError as error:
        check_threads(error, name)
        raise


def check_threads(error: Exception, name: str) -> None:
    """Raise ComputationProblem if an error is that no thread could be started to read a file."""
    if any(said in str(error) for said in _NO_THREAD):
        raise ComputationProblem(
            f"no thread can be started to read {name}: a limit of memory or processes is reached"
            " (ulimit -v, -u)"
        ) from None


def check_room() -> None:
    """Raise ComputationProblem where this process may have less memory than its libraries take.

    Their linear algebra would try again for ever, deaf to signals, or end the process with the exit
    code of a check that failed.
    """
    limit = _limit()
    if limit is not None and limit < LIBRARIES:
        raise ComputationProblem(
            f"out of memory: this process may have {gigabytes(limit)} of address space (ulimit -v),"
            f" and its libraries take {gigabytes(LIBRARIES)}"
        )


def gigabytes(size: int) -> str:
    """A number of bytes for a message."""
    return f"{size / 1e9:.3g} GB"


def available() -> int | None:
    """Bytes that this process may still take, or None if the system does not tell."""
    found = [
        b for b in (_of_the_machine(), _of_the_container(), _of_the_process()) if b is not None
    ]
    return max(min(found), 0) if found else None


def _of_the_machine() -> int | None:
    # sysconf knows free pages only; those that hold cached files can be had as well.
    for line in _lines("/proc/meminfo"):
        if line.startswith("MemAvailable:"):
            return int(line.split()[1]) * 1024
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None


def _of_the_container() -> int | None:
    own = next((line[3:] for line in _lines("/proc/self/cgroup") if line.startswith("0::")), "")
    folder = _CGROUP + own.rstrip("/")
    limit, used = (_lines(f"{folder}/memory.{n}")[:1] for n in ("max", "current"))
    if not limit or not used or not limit[0].isdigit():
        return None
    statistics = dict(line.split() for line in _lines(f"{folder}/memory.stat"))
    return int(limit[0]) - int(used[0]) + int(statistics.get("inactive_file", 0))


def _limit() -> int | None:
    """Bytes of address space that this process may have at most, None if as many as it likes."""
    try:
        import resource
    except ImportError:
        return None
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return None if limit == resource.RLIM_INFINITY else limit


def _of_the_process() -> int | None:
    limit = _limit()
    if limit is None or not (pages := _lines("/proc/self/statm")):
        return None
    return limit - int(pages[0].split()[0]) * os.sysconf("SC_PAGE_SIZE")


def _lines(path: str) -> list[str]:
    try:
        with open(path) as file:
            return file.read().splitlines()
    except OSError:
        return []

"""Limits on the time and the memory of the process that reads containers."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

_SECONDS = 25.0  # of computing, for any file; libraries import in two
_SPEED = 5e6  # bytes a second that every library reads
_BYTES = 1 << 30  # for any file, the libraries among them
_OF_FILE = 20  # times the file: bytes of the file, its records unpacked, samples as float64
_OF_COLUMNS = 6  # times the columns: samples as stored, as values, on one time base, as a table


def seconds_for(size: int) -> float:
    """Seconds of computing that reading a file of `size` bytes may take."""
    return _SECONDS + size / _SPEED


@contextmanager
def limited(size: int, columns: int = 0) -> Iterator[None]:
    """No more time and memory than a sound file of `size` bytes needs, where the system can.

    columns : bytes of the columns to be read
    Too much memory is a MemoryError; too much time ends the process.
    """
    try:
        import resource
    except ImportError:  # not a Unix: the time is limited by who waits for the table
        yield
        return
    used = resource.getrusage(resource.RUSAGE_SELF)
    seconds = used.ru_utime + used.ru_stime + seconds_for(size)
    limits = [(resource.RLIMIT_CPU, int(seconds) + 1)]
    taken = _data()
    if taken is not None:
        memory = taken + _BYTES + _OF_FILE * size + _OF_COLUMNS * columns
        limits.append((resource.RLIMIT_DATA, memory))
    before = [resource.getrlimit(kind) for kind, _ in limits]
    for (kind, value), (soft, hard) in zip(limits, before, strict=True):
        given = [v for v in (soft, hard) if v != resource.RLIM_INFINITY]
        resource.setrlimit(kind, (min([value, *given]), hard))
    try:
        yield
    finally:
        for (kind, _), limit in zip(limits, before, strict=True):
            resource.setrlimit(kind, limit)


def _data() -> int | None:
    """Bytes of memory that the process has for itself; None where the system does not tell."""
    if not os.path.exists("/proc/self/status"):
        return None
    with open("/proc/self/status") as file:
        found = [line for line in file if line.startswith("VmData:")]
    return int(found[0].split()[1]) * 1024 if found else None

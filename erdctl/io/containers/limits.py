"""Limits on the time and the memory of the process that reads containers."""

from __future__ import annotations

import os

from erdctl.core.memory import gigabytes
from erdctl.io.formats import Format

OUT_OF_MEMORY = 79  # exit code of a process that can no longer say so
_SECONDS = 10.0  # of computing, for any file; the libraries import in one or two
_SPEED = 5e6  # bytes a second that every library reads
_BYTES = 1 << 30  # for any file, the libraries among them
_OF_FILE = 20  # times the file: bytes of the file, its records unpacked, samples as float64
_OF_COLUMNS = 6  # times the columns: samples as stored, as values, on one time base, as a table


def seconds_for(size: int) -> float:
    """Seconds of computing that reading a file of `size` bytes may take."""
    return _SECONDS + size / _SPEED


def too_much(name: str, format: Format, size: int) -> str:
    """What to say where a file needs more memory than `limit` leaves."""
    return (
        f"{name}: reading its {gigabytes(size)} takes more memory than a sound {format.value} of"
        " that size needs; it is damaged, or has to be split"
    )


def limit(size: int, columns: int = 0) -> None:
    """From now on, no more time and memory than a sound file of `size` bytes needs.

    columns : bytes of the columns to be read
    Too much memory is a MemoryError; too much time ends the process. Nothing is limited where the
    system cannot: then the time is, by who waits for the table.
    """
    try:
        import resource
    except ImportError:  # not a Unix
        return
    used = resource.getrusage(resource.RUSAGE_SELF)
    _at_most(resource.RLIMIT_CPU, int(used.ru_utime + used.ru_stime + seconds_for(size)) + 1)
    taken = _data()
    if taken is not None:
        _at_most(resource.RLIMIT_DATA, taken + _BYTES + _OF_FILE * size + _OF_COLUMNS * columns)


def _at_most(kind: int, value: int) -> None:
    import resource

    _, hard = resource.getrlimit(kind)
    if hard != resource.RLIM_INFINITY:
        value = min(value, hard)
    resource.setrlimit(kind, (value, hard))


def _data() -> int | None:
    """Bytes of memory that the process has for itself; None where the system does not tell."""
    if not os.path.exists("/proc/self/status"):
        return None
    with open("/proc/self/status") as file:
        found = [line for line in file if line.startswith("VmData:")]
    return int(found[0].split()[1]) * 1024 if found else None

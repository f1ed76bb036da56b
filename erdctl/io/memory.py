"""Does a log fit into memory? Better a message before reading than the system's killer during."""

from __future__ import annotations

import os

from erdctl.errors import InputProblem
from erdctl.io.formats import Format
from erdctl.io.sources import TableSource

# The columns, those derived from them by a model, and one more while something is computed.
COPIES = 3
_SAMPLE = 1 << 16
_CGROUP = "/sys/fs/cgroup"


def check_fits(source: TableSource, columns: int) -> None:
    """Raise InputProblem if that many columns of a log will not fit into memory."""
    need = expected_rows(source) * columns * 8 * COPIES
    have = available()
    if have is not None and need > have:
        raise InputProblem(
            f"too large: its {columns} columns need about {_gigabytes(need)} of memory and"
            f" {_gigabytes(have)} are free; split it into several logs",
            file=source.name,
        )


def expected_rows(source: TableSource) -> int:
    """Number of rows, without reading them; an estimate unless the format states it."""
    if source.format is Format.CSV:
        if isinstance(source.data, str):
            with open(source.data, "rb") as file:
                head = file.read(_SAMPLE)
        else:
            head = bytes(source.data[:_SAMPLE])
        return source.size * max(head.count(b"\n"), 1) // len(head)
    if source.format is Format.PARQUET and isinstance(source.data, str):
        import pyarrow.parquet as pq

        return int(pq.read_metadata(source.data).num_rows)
    return source.size // (8 * len(source.columns))


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


def _of_the_process() -> int | None:
    try:
        import resource
    except ImportError:
        return None
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    pages = _lines("/proc/self/statm")
    if limit == resource.RLIM_INFINITY or not pages:
        return None
    return limit - int(pages[0].split()[0]) * os.sysconf("SC_PAGE_SIZE")


def _lines(path: str) -> list[str]:
    try:
        with open(path) as file:
            return file.read().splitlines()
    except OSError:
        return []


def _gigabytes(size: int) -> str:
    return f"{size / 1e9:.3g} GB"

"""Whether two names lead to the same file, before anything is written to either."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Sequence
from typing import NamedTuple, TextIO

STDIN = STDOUT = "-"
Identity = tuple[object, ...]


class Named(NamedTuple):
    """A file of a run: its path as given ("-" is a standard stream), and what names it there.

    label : `LOG`, `--manifest`, or "" for a name that the program has made
    reads : whether the run reads it; else it writes it
    """

    path: str
    label: str
    reads: bool

    def __str__(self) -> str:
        return f"{self.label} {self.path}".strip()


def clash(others: Sequence[Named], new: Named) -> str | None:
    """What is wrong with a file beside the others of its run; None if nothing is.

    Files may be read twice; none may be written that is read, or written twice.
    """
    mine = identity(new)
    if mine is None:
        return None
    for other in others:
        if (other.reads and new.reads) or identity(other) != mine:
            continue
        if not other.reads and not new.reads:
            where = "standard output" if other.path == new.path == STDOUT else "the same file"
            return f"{other} and {new} would both be written to {where}; name another for one"
        read, written = (other, new) if other.reads else (new, other)
        return f"{written} would be written over {read}, which is read here; name another file"
    return None


def identity(name: Named) -> Identity | None:
    """The same for two names of one file: relative, through links, in another case.

    None for what can be read and written by many at once: pipes, terminals, devices, directories.
    """
    try:
        if name.path == STDIN:
            return _of_stream(sys.stdin if name.reads else sys.stdout, writes=not name.reads)
        path = os.path.realpath(name.path)
        if os.path.exists(path):
            return _of_status(os.stat(path))
        folder, base = os.path.split(path)
        if not os.path.isdir(folder):
            return (path,)
        where = os.stat(folder)
        return where.st_dev, where.st_ino, base.casefold() if _ignores_case(folder) else base
    except (OSError, ValueError):  # what cannot be looked at is refused when it is opened
        return None


def _of_stream(stream: TextIO | None, *, writes: bool) -> Identity | None:
    """A redirected file; of standard output, which holds one thing at a time, always something."""
    found = None
    try:
        if stream is not None:
            found = _of_status(os.fstat(stream.fileno()))
    except (OSError, ValueError):  # in memory, or closed
        pass
    return found or ((STDOUT,) if writes else None)


def _of_status(status: os.stat_result) -> Identity | None:
    return (status.st_dev, status.st_ino) if stat.S_ISREG(status.st_mode) else None


def _ignores_case(folder: str) -> bool:
    """Whether `A` and `a` are one file in a folder, found by the folder's own name."""
    other = os.path.join(os.path.dirname(folder), os.path.basename(folder).swapcase())
    try:
        return other != folder and os.path.samefile(folder, other)
    except OSError:
        return False

"""Output that appears whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import BinaryIO

from erdctl.core.errors import ComputationProblem, UsageProblem

STDOUT = "-"

# EFBIG: to the user, a limit on the size of files (`ulimit -f`) is a full disk.
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}

# Names of open descriptors. A renamed file must never take their place, even where the
# descriptor leads to a regular file (`erdctl ... -o /dev/stdout >> all.csv`).
_DESCRIPTORS = ("/dev/std", "/dev/fd/", "/proc/")


@contextmanager
def output(path: str) -> Iterator[BinaryIO]:
    """Binary stream into `path` ("-": standard output), whole or not at all as `replacing`.

    Raises what `replacing` raises, and BrokenPipeError if the reader of a pipe has gone.
    """
    if path == STDOUT:
        with _explained("standard output", "the output is incomplete"), _stdout() as stream:
            yield stream
        return
    # Appending is right for pipes and for `>>`; a temporary file is empty anyway.
    with replacing(path) as name, open(name, "ab") as stream:
        yield stream


@contextmanager
def replacing(path: str) -> Iterator[str]:
    """Name of an empty temporary file that takes the place of `path` when the block ends well.

    On any failure it is removed and `path` stays as it was. A target that exists and is not a
    regular file (pipe, device) is handed out itself, to be written directly.

    The block should do nothing but write: an OSError in it counts as a failure to write.
    Raises UsageProblem if nothing can be created there, ComputationProblem if writing fails.
    """
    if _is_special(path):
        with _explained(path, "the output is incomplete"):
            yield path
        return
    # A link keeps pointing where it points: what it leads to is replaced.
    target = os.path.realpath(path)
    if not path or os.path.isdir(target):
        raise UsageProblem(f"cannot write to '{path}': not the name of a file")
    temporary = os.path.join(os.path.dirname(target), f".erdctl-{os.urandom(8).hex()}.tmp")
    try:
        with _explained(path, "nothing was written"):
            _create(temporary, path, target)
            yield temporary
            os.replace(temporary, target)
    finally:
        # After the rename nothing is left under this name.
        with suppress(FileNotFoundError, NotADirectoryError):
            os.unlink(temporary)


def _create(temporary: str, path: str, target: str) -> None:
    # Not tempfile: its files are private (0600), while this one becomes an ordinary file.
    try:
        descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    except OSError as error:
        if error.errno in _FULL:
            raise
        folder = os.path.dirname(path) or "."
        hint = f"'{folder}' does not exist; make it first"
        if not isinstance(error, FileNotFoundError):
            hint = f"{_reason(error)}; choose another place"
        raise UsageProblem(f"cannot write to '{path}': {hint}") from None
    os.close(descriptor)
    with suppress(OSError):  # a new file has no mode to take over
        os.chmod(temporary, stat.S_IMODE(os.stat(target).st_mode))


@contextmanager
def _stdout() -> Iterator[BinaryIO]:
    sys.stdout.flush()
    try:
        descriptor = sys.stdout.fileno()
    except OSError:  # replaced by an object in memory
        yield sys.stdout.buffer
        return
    # A buffer of our own: after a failed write nothing stays behind in sys.stdout that the
    # interpreter would try, and fail, to flush at exit.
    with open(descriptor, "wb", closefd=False) as stream:
        yield stream


@contextmanager
def _explained(name: str, outcome: str) -> Iterator[None]:
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        what = f"could not write {name}: {_reason(error)}"
        if error.errno in _FULL:
            what = f"disk full while writing {name}"
        raise ComputationProblem(f"{what}; {outcome}") from error


def _reason(error: OSError) -> str:
    return (error.strerror or str(error)).lower()


def _is_special(path: str) -> bool:
    if path.startswith(_DESCRIPTORS):
        return True
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))

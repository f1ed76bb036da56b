"""Output that appears whole or not at all: one file, and all files of one run."""

from __future__ import annotations

import errno
import os
import stat
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import BinaryIO

from erdctl.core import leftovers
from erdctl.core.errors import ComputationProblem, ErdctlError, UsageProblem
from erdctl.io.identity import STDOUT, Named, clash

# EFBIG: to the user, a limit on the size of files (`ulimit -f`) is a full disk.
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}

# Names of open descriptors. A renamed file must never take their place, even where the
# descriptor leads to a regular file (`erdctl ... -o /dev/stdout >> all.csv`).
_DESCRIPTORS = ("/dev/std", "/dev/fd/", "/proc/")


@dataclass
class _File:
    """A file that waits to take its place; backup : what stood there before, under another name."""

    path: str
    target: str
    temporary: str
    backup: str | None = None


@dataclass
class _Run:
    """What one run reads and writes; see `together`."""

    taken: list[Named]
    promised: int
    waiting: list[_File] = field(default_factory=list)
    streamed: bool = False

    @property
    def outcome(self) -> str:
        """What a failure leaves behind, for messages."""
        return "no file was written" if self.streamed else "nothing was written"

    def claim(self, path: str) -> None:
        """Raise UsageProblem if a file that is about to be written is another of this run.

        Options are looked at before the work begins. This finds the names that are made from
        others (`OUT.manifest.json`).
        """
        new = Named(path, "", reads=False)
        # An option names itself, so only what is read and what was written before it counts.
        written = [Named(f.path, "", reads=False) for f in self.waiting]
        problem = clash([n for n in self.taken if n.reads] + written, new)
        if problem is not None:
            raise UsageProblem(problem)

    def commit(self) -> None:
        """Let all files take their places; if one cannot, none does."""
        placed: list[_File] = []
        with leftovers.undisturbed():
            try:
                for file in self.waiting:
                    with _explained(file.path, self.outcome):
                        _place(file, alone=len(self.waiting) == 1)
                    placed.append(file)
            except ComputationProblem as problem:
                stuck = [f.path for f in reversed(placed) if not _put_back(f)]
                if stuck:
                    raise ComputationProblem(
                        f"{str(problem).rpartition(';')[0]}; {', '.join(stuck)} was written already"
                    ) from problem
                raise
            finally:
                self.discard()

    def discard(self) -> None:
        """Remove all temporary files."""
        for file in self.waiting:
            _remove(file.temporary)
            if file.backup is not None:
                _remove(file.backup)
        self.waiting.clear()


_RUN: ContextVar[_Run | None] = ContextVar("run", default=None)


@contextmanager
def together(names: Sequence[Named] = ()) -> Iterator[None]:
    """Files that `output` writes in the block appear all at its end, or none of them.

    names : the files that the run reads, and those that it will write
    If the block fails nothing is written, except after an error that says that it comes after the
    work (`ErdctlError.after_the_work`: a check that failed). Standard output, pipes and devices
    are written at once.
    Raises UsageProblem, before anything is done, if two of the names lead to the same file and one
    of them is written; ComputationProblem if a file cannot take its place, or if the reader of
    standard output has gone before the files were written.
    """
    writes = 0
    for i, name in enumerate(names):
        writes += not name.reads
        # Of thousands of logs, which are read, each would be held against each.
        problem = clash(names[:i], name) if writes else None
        if problem is not None:
            raise UsageProblem(problem)
    run = _Run([*names], sum(not n.reads and n.path != STDOUT for n in names))
    token = _RUN.set(run)
    try:
        yield
        run.commit()
    except BrokenPipeError:
        if run.promised:
            raise ComputationProblem(
                f"the reader of standard output has gone; {run.outcome}"
            ) from None
        raise
    except ErdctlError as error:
        if error.after_the_work:
            run.commit()
        raise
    finally:
        run.discard()
        _RUN.reset(token)


@contextmanager
def output(path: str) -> Iterator[BinaryIO]:
    """Binary stream into `path` ("-": standard output), whole or not at all as `replacing`.

    Raises what `replacing` raises, and BrokenPipeError if the reader of a pipe has gone.
    """
    if path == STDOUT:
        _streams()
        with _explained("standard output", "the output is incomplete"), _stdout() as stream:
            yield stream
        return
    # Appending is right for pipes and for `>>`; a temporary file is empty anyway.
    with replacing(path) as name, open(name, "ab") as stream:
        yield stream


@contextmanager
def replacing(path: str) -> Iterator[str]:
    """Name of an empty temporary file that takes the place of `path` when the block ends well.

    Within `together` it does so when that ends. On any failure, and on a signal that ends the
    program, it is removed and `path` stays as it was. A target that exists and is not a regular
    file (pipe, device) is handed out itself, to be written directly.

    The block should do nothing but write: an OSError in it counts as a failure to write.
    Raises UsageProblem if nothing can be created there, ComputationProblem if writing fails.
    """
    if _is_special(path):
        _streams()
        with _explained(path, "the output is incomplete"):
            yield path
        return
    run = _RUN.get()
    # A link keeps pointing where it points: what it leads to is replaced.
    target = _target(path)
    if run is not None:
        run.claim(path)
    temporary = _beside(target)
    file = _File(path, target, temporary)
    outcome = "nothing was written" if run is None else run.outcome
    try:
        with _explained(path, outcome):
            _create(temporary, path, target)
            yield temporary
    except BaseException:
        _remove(temporary)
        raise
    if run is None:
        run = _Run([], 0, [file])
        run.commit()
    else:
        run.waiting.append(file)


def _streams() -> None:
    run = _RUN.get()
    if run is not None:
        run.streamed = True


def _target(path: str) -> str:
    try:
        target = os.path.realpath(path)
        usable = bool(path) and not os.path.isdir(target)
    except ValueError:  # a NUL in it
        usable = False
    if not usable:
        raise UsageProblem(f"cannot write to '{path}': not the name of a file")
    return target


def _beside(target: str) -> str:
    """A new name in the folder of a file, so that renaming is one step."""
    name = os.path.join(os.path.dirname(target), f".erdctl-{os.urandom(8).hex()}.tmp")
    leftovers.remember(name)
    return name


def _remove(temporary: str) -> None:
    # After the rename nothing is left under this name.
    with suppress(FileNotFoundError, NotADirectoryError):
        os.unlink(temporary)
    leftovers.forget(temporary)


def _place(file: _File, *, alone: bool) -> None:
    """Let a file take its place; of several, what stood there is kept until all have theirs."""
    if not alone:
        _set_aside(file)
    try:
        os.replace(file.temporary, file.target)
    except OSError:
        if file.backup is not None and not os.path.lexists(file.target):
            os.rename(file.backup, file.target)
        raise


def _set_aside(file: _File) -> None:
    backup = os.path.join(os.path.dirname(file.target), f".erdctl-{os.urandom(8).hex()}.tmp")
    try:
        os.link(file.target, backup)
    except FileNotFoundError:
        return
    except OSError:  # a file system without hard links
        os.rename(file.target, backup)
    file.backup = backup


def _put_back(file: _File) -> bool:
    """Whether all is as before this file took its place."""
    try:
        if file.backup is None:
            os.unlink(file.target)
        else:
            os.replace(file.backup, file.target)
    except OSError:
        return False
    return True


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
    if error.errno == errno.EBADF:
        return "it is closed"
    return (error.strerror or str(error)).lower()


def _is_special(path: str) -> bool:
    if path.startswith(_DESCRIPTORS):
        return True
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))

"""Temporary files and directories that must not outlive the program when a signal ends it."""

from __future__ import annotations

import os
import shutil
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

from erdctl.core.messages import tell

# Ctrl-C, `kill`, and the end of the terminal. The last is not known to Windows.
SIGNALS = tuple(getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n))
_paths: set[str] = set()
_held: list[int] = []  # signals that came while none may end the program
_holding = 0


def remember(path: str) -> None:
    """A path to remove if a signal ends the program."""
    _paths.add(path)


def forget(path: str) -> None:
    """A path that is in its place, or gone."""
    _paths.discard(path)


def remove_all() -> None:
    """Remove what is left; nothing is said of what is gone already."""
    for path in sorted(_paths):
        if os.path.isdir(path) and not os.path.islink(path):
            shutil.rmtree(path, ignore_errors=True)
        else:
            with suppress(OSError):
                os.unlink(path)
    _paths.clear()


def end_cleanly() -> None:
    """From here on SIGINT, SIGTERM and SIGHUP remove what is temporary, then end the program.

    It dies of the signal itself, so that a shell sees 130, 143 or 129 and ends its loop, too. A
    signal that is ignored stays so (`nohup`).
    """
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _end)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Signals wait until the block is over: several files take their places, or none."""
    global _holding
    _holding += 1
    try:
        yield
    finally:
        _holding -= 1
        if _held and not _holding:
            _end(_held[0], None)


def _end(number: int, frame: FrameType | None) -> None:
    if _holding:
        _held.append(number)
        return
    for each in SIGNALS:  # a second one ends the program wherever it is
        signal.signal(each, signal.SIG_DFL)
    _end_workers()
    outcome = "; no file was written" if _paths else ""
    remove_all()
    if sys.stderr is not None and sys.stderr.isatty():
        tell("\x1b[?25h")  # the cursor, which a progress line hides
    tell(f"erdctl: error: stopped by {signal.Signals(number).name}{outcome}")
    os.kill(os.getpid(), number)


def _end_workers() -> None:
    """Worker processes write into temporary directories, and hold semaphores."""
    processes = sys.modules.get("multiprocessing.process")
    if processes is None:
        return
    for child in processes.active_children():
        child.kill()
        child.join(1.0)
    # Otherwise a process that watches over semaphores complains of them when this one has gone.
    from multiprocessing import util

    util._run_finalizers(0)  # type: ignore[attr-defined]  # what its own exit calls

"""Standard streams that are closed when the program begins."""

from __future__ import annotations

import io
import os
import sys


def open_streams() -> None:
    """Give closed standard streams (`>&-`) something to stand for them.

    Otherwise the first file that is opened would become standard output. Writing to the closed
    output fails; what is said to a closed stderr is heard by nobody; a closed input is empty.
    """
    for number, flags in ((0, os.O_RDONLY), (1, os.O_RDONLY), (2, os.O_WRONLY)):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, flags)  # takes the lowest number that is free: this one
    sys.stdin = sys.stdin or os.fdopen(0, closefd=False)
    sys.stdout = sys.stdout or os.fdopen(1, "w", closefd=False)
    sys.stderr = sys.stderr or os.fdopen(2, "w", closefd=False, errors="backslashreplace")
    # A name that is no text in this locale must not end a command.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")

"""Tables and remarks on stderr: Rich on a terminal, plain aligned text elsewhere."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TextIO

from erdctl.core.messages import CELL, counted, shown, tell
from erdctl.report.layout import BOX, boxed, lines, wrapped

QUIET = ContextVar("quiet", default=False)  # set for the time of one command by `--quiet`
SERIOUS = ("warning", "error")
BAR = 20  # characters of a bar, and the fewest that still show something
SHORT = 6
CLOCK = 12  # characters of the sign of life and the time beside a line of progress
ROWS = 200  # of a table for eyes; documents have all


def say(text: str, kind: str = "note") -> None:
    """One remark for the user; of a quiet program only warnings and errors."""
    if not QUIET.get() or kind in SERIOUS:
        line = shown(f"erdctl: {kind}: {text}")
        # Lines in a file stay whole, for whoever searches it; on a terminal a number may not break.
        tell(wrapped(line, width()) if terminal() else line)


def show(text: str) -> None:
    """One line of a command's answer on stdout; broken between words on a terminal."""
    line = shown(text)
    print(wrapped(line, _columns(sys.stdout)) if sys.stdout.isatty() else line)


def terminal() -> bool:
    """Whether stderr can show more than lines of plain text."""
    return sys.stderr.isatty() and os.environ.get("TERM") != "dumb"


def width() -> int | None:
    """Columns to write in: what COLUMNS says, or what the terminal has; None for no limit."""
    said = os.environ.get("COLUMNS", "")
    if said.isdecimal() and int(said) > 0:
        return int(said)
    return _columns(sys.stderr) if sys.stderr.isatty() else None


def _columns(stream: TextIO) -> int | None:
    """Columns of the terminal behind a stream; None where it does not say."""
    try:
        return os.get_terminal_size(stream.fileno()).columns or None
    except (OSError, ValueError):
        return None


def table(
    title: str,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    bars: Mapping[int, Sequence[float]] | None = None,
) -> None:
    """A table whose first column is text and whose other columns are numbers.

    One that is too wide is folded (see `layout`), without rules and bars: nothing in it is cut.

    bars : values of columns to draw as bars on a terminal, all to one scale; one a row, and NaN
        for a row without
    """
    if QUIET.get():
        return
    title, header = shown(title), [shown(cell, CELL) for cell in header]
    left_out = len(rows) - ROWS
    rows = [[shown(cell, CELL) for cell in row] for row in rows[:ROWS]]
    _table(title, header, rows, bars or {})
    if left_out > 0:
        tell(f"  and {counted(left_out, 'more row')}")


def listing(title: str, parts: Mapping[str, Sequence[str]]) -> None:
    """Sentences under headings, broken between words on a narrow screen; of each `ROWS` parts."""
    if QUIET.get():
        return
    room = width()
    inner = None if room is None else room - 4
    tell(wrapped(shown(title), room))
    for heading, sentences in list(parts.items())[:ROWS]:
        tell(f"  {wrapped(shown(heading), inner)}")
        for sentence in sentences:
            tell(f"    {wrapped(shown(sentence), inner, 6)}")
    if len(parts) > ROWS:
        tell(f"  and {len(parts) - ROWS} more")


def _table(
    title: str,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    bars: Mapping[int, Sequence[float]],
) -> None:
    room = width()
    spare = math.inf if room is None else room - boxed(header, rows)
    if terminal() and spare >= 0:
        # Bars take what the columns leave.
        most = BAR if math.isinf(spare) else int(spare) // max(len(bars), 1) - BOX
        _rich(title, header, rows, bars if most >= SHORT else {}, min(BAR, most))
        return
    tell(wrapped(title, room))
    for line in lines(header, rows, room):
        tell(line)


def _rich(
    title: str,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    bars: Mapping[int, Sequence[float]],
    length: int,
) -> None:
    # Imported here: it costs a third of the time of a whole run in a batch script.
    from rich.bar import Bar
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    values = [v for column in bars.values() for v in column if 0.0 < v < math.inf]
    top = max(values, default=1.0)
    console = Console(stderr=True)
    print(wrapped(title, width()), file=sys.stderr)
    out = Table()
    for i, name in enumerate(header):
        out.add_column(Text(name), justify="left" if i == 0 else "right", no_wrap=True)
        if i in bars:
            out.add_column("", width=length)
    for k, row in enumerate(rows):
        cells: list[Bar | Text] = []
        for i, cell in enumerate(row):
            cells.append(Text(cell))
            if i in bars:
                value = bars[i][k]
                # Infinite is full, unknown is empty.
                filled = min(value, top) if value > 0.0 else 0.0
                cells.append(Bar(top, 0.0, filled, width=length, color="cyan"))
        out.add_row(*cells)
    console.print(out)


@contextmanager
def progress() -> Iterator[Callable[[str, str], None]]:
    """A line on stderr that shows stage, item, fraction and time, on a terminal only."""
    if QUIET.get() or not terminal():
        yield lambda stage, what: None
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    columns = SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn()
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("")
        # Drawn at once: a stage may be over before the next of ten pictures a second.
        yield lambda stage, what: bar.update(
            task,
            description=_fitting(shown(f"{stage}: {what}"), console.width - CLOCK),
            refresh=True,
        )


@contextmanager
def counting(stage: str, count: int) -> Iterator[Callable[[str], None]]:
    """A bar on stderr with how many of `count` are done and an estimate of the time left.

    Called with what is done, for each. On a terminal only.
    """
    if QUIET.get() or not terminal():
        yield lambda what: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("{task.description}", markup=False), BarColumn(20), MofNCompleteColumn(),
        TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn(),
    )  # fmt: skip
    console = Console(stderr=True)
    # What logs take differs by a hundred; the estimate is a mean over the last ten minutes.
    with Progress(*columns, console=console, transient=True, speed_estimate_period=600.0) as bar:
        task = bar.add_task(stage, total=count)
        room = max(console.width // 3, SHORT)
        yield lambda what: bar.update(
            task, advance=1, description=_fitting(shown(f"{stage}: {what}"), room), refresh=True
        )


def _fitting(text: str, room: int) -> str:
    """A line of progress in so many characters; what gives way is the middle, not the fraction."""
    if len(text) > room:
        tail = text[-room // 2 :]
        text = f"{text[: max(room - len(tail) - 1, 0)]}\u2026{tail}"
    return text

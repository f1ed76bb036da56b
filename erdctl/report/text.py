"""Tables and remarks on stderr: Rich on a terminal, plain aligned text elsewhere."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar

from erdctl.core.messages import CELL, shown, tell

QUIET = ContextVar("quiet", default=False)  # set for the time of one command by `--quiet`
SERIOUS = ("warning", "error")
BAR = 20  # characters
ROWS = 200  # of a table for eyes; documents have all


def say(text: str, kind: str = "note") -> None:
    """One remark for the user; of a quiet program only warnings and errors."""
    if not QUIET.get() or kind in SERIOUS:
        tell(shown(f"erdctl: {kind}: {text}"))


def terminal() -> bool:
    """Whether stderr can show more than lines of plain text."""
    return sys.stderr.isatty() and os.environ.get("TERM") != "dumb"


def table(
    title: str,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    bars: Mapping[int, Sequence[float]] | None = None,
) -> None:
    """A table whose first column is text and whose other columns are numbers.

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
        tell(f"  and {left_out} more rows")


def _table(
    title: str,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    bars: Mapping[int, Sequence[float]],
) -> None:
    if terminal():
        _rich(title, header, rows, bars)
        return
    widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
    tell(title)
    for row in [header, *rows]:
        first = row[0].ljust(widths[0])
        rest = [cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True)]
        tell("  " + "  ".join([first, *rest]).rstrip())


def _rich(
    title: str,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    bars: Mapping[int, Sequence[float]],
) -> None:
    # Imported here: it costs a third of the time of a whole run in a batch script.
    from rich.bar import Bar
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    values = [v for column in bars.values() for v in column if 0.0 < v < math.inf]
    top = max(values, default=1.0)
    console = Console(stderr=True)
    out = Table(title=Text(title), title_justify="left", title_style="bold")
    for i, name in enumerate(header):
        out.add_column(Text(name), justify="left" if i == 0 else "right")
        if i in bars:
            out.add_column("", width=BAR)
    for k, row in enumerate(rows):
        cells: list[Bar | Text] = []
        for i, cell in enumerate(row):
            cells.append(Text(cell))
            if i in bars:
                value = bars[i][k]
                # Infinite is full, unknown is empty.
                length = min(value, top) if value > 0.0 else 0.0
                cells.append(Bar(top, 0.0, length, width=BAR, color="cyan"))
        out.add_row(*cells)
    console.print(out)


def number(value: float | None, digits: int = 4) -> str:
    """A number with so many significant digits, or a dash."""
    return "-" if value is None else f"{value:.{digits}g}"


@contextmanager
def progress() -> Iterator[Callable[[str, str], None]]:
    """A line on stderr that shows stage, item and time, on a terminal only."""
    if QUIET.get() or not terminal():
        yield lambda stage, what: None
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("")
        # Drawn at once: a stage may be over before the next of ten pictures a second.
        yield lambda stage, what: bar.update(
            task, description=shown(f"{stage}: {what}", CELL), refresh=True
        )

"""Tables and remarks on stderr: Rich on a terminal, plain aligned text elsewhere."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager


def say(text: str, kind: str = "note") -> None:
    """One remark for the user."""
    print(f"erdctl: {kind}: {text}", file=sys.stderr)


def table(title: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """A table whose first column is text and whose other columns are numbers."""
    if sys.stderr.isatty() and os.environ.get("TERM") != "dumb":
        _rich(title, header, rows)
        return
    widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
    print(title, file=sys.stderr)
    for row in [header, *rows]:
        first = row[0].ljust(widths[0])
        rest = [cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True)]
        print("  " + "  ".join([first, *rest]).rstrip(), file=sys.stderr)


def _rich(title: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    # Imported here: it costs a third of the time of a whole run in a batch script.
    from rich.console import Console
    from rich.table import Table

    out = Table(title=title, title_justify="left", title_style="bold")
    for i, name in enumerate(header):
        out.add_column(name, justify="left" if i == 0 else "right")
    for row in rows:
        out.add_row(*row)
    Console(stderr=True).print(out)


def number(value: float | None, digits: int = 4) -> str:
    """A number with so many significant digits, or a dash."""
    return "-" if value is None else f"{value:.{digits}g}"


@contextmanager
def progress() -> Iterator[Callable[[str, str], None]]:
    """A line on stderr that shows stage, item and time, on a terminal only."""
    if not sys.stderr.isatty() or os.environ.get("TERM") == "dumb":
        yield lambda stage, what: None
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("")
        yield lambda stage, what: bar.update(task, description=f"{stage}: {what}")

"""A table as lines of a given width: no number and no key is ever cut.

A table that is too wide is folded: the columns that fit come first, the others below, each part
with the first column again. Where not even two columns fit side by side, every row becomes a list
`key: value`. A single word longer than the width stands whole, whatever the terminal makes of it.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence

INDENT, GAP = 2, 2  # characters before a row, and between two columns
BOX = 3  # of a column of a drawn table: its rule and the blanks beside its text

Rows = Sequence[Sequence[str]]


def cells(text: str) -> int:
    """Columns of a terminal that a text takes: Chinese characters take two, accents none.

    Check: "sigma" takes 5, two Chinese characters 4, "é" as a letter and its accent 1.
    >>> cells("sigma"), cells("阻尼"), cells("e\u0301")
    (5, 4, 1)
    """
    if text.isascii():
        return len(text)
    wide = sum(unicodedata.east_asian_width(c) in "WF" for c in text)
    return len(text) + wide - sum(unicodedata.combining(c) > 0 for c in text)


def widths(header: Sequence[str], rows: Rows) -> list[int]:
    """Columns that each column of a table takes."""
    return [max(cells(row[i]) for row in [header, *rows]) for i in range(len(header))]


def boxed(header: Sequence[str], rows: Rows) -> int:
    """Columns of a terminal that a table takes with rules around its cells."""
    return sum(w + BOX for w in widths(header, rows)) + 1


def lines(header: Sequence[str], rows: Rows, width: int | None = None) -> list[str]:
    """A table as lines of at most `width` columns of a terminal; None for no limit.

    The first column stands at the left, the others at the right.
    Check: at 12 columns the names a and b and one column of 4 fit beside each other, and the other,
    with 22 and 3, comes below that with 1 and 10.
    >>> print("\\n".join(lines(["", "mean", "high"], [["a", "1", "22"], ["b", "10", "3"]], 12)))
         mean
      a     1
      b    10
         high
      a    22
      b     3
    """
    size = widths(header, rows)
    parts = _folded(size, width)
    if parts is None:
        return _listed(header, rows)
    out = []
    for part in parts:
        for row in [header, *rows]:
            cell = [_left(row[0], size[0]), *(_right(row[i], size[i]) for i in part)]
            out.append((" " * INDENT + (" " * GAP).join(cell)).rstrip())
    return out


def wrapped(text: str, width: int | None, indent: int = 4) -> str:
    """A remark broken between words, which stay whole, with further lines indented."""
    if width is None or cells(text) <= width:
        return text
    out, line = [], ""
    for word in text.split(" "):
        joined = f"{line} {word}" if line.strip() else line + word
        if cells(joined) > width and line.strip():
            out.append(line)
            joined = " " * indent + word
        line = joined
    return "\n".join([*out, line])


def _folded(size: Sequence[int], width: int | None) -> list[list[int]] | None:
    """Columns beside the first, part by part; None where one does not fit beside it."""
    rest = list(range(1, len(size)))
    if width is None or not rest:
        return [rest]
    parts: list[list[int]] = []
    room = 0
    for i in rest:
        need = GAP + size[i]
        if not parts or need > room:
            parts.append([])
            room = width - INDENT - size[0]
            if need > room:
                return None
        parts[-1].append(i)
        room -= need
    return parts


def _listed(header: Sequence[str], rows: Rows) -> list[str]:
    """Every row as its first cell, and `key: value` below it."""
    out = []
    for row in rows:
        out.append(f"{' ' * INDENT}{f'{header[0]}: ' if header[0] else ''}{row[0]}")
        for key, value in zip(header[1:], row[1:], strict=True):
            out.append(f"{' ' * 2 * INDENT}{f'{key}: ' if key else ''}{value}")
    return out


def _left(text: str, width: int) -> str:
    return text + " " * (width - cells(text))


def _right(text: str, width: int) -> str:
    return " " * (width - cells(text)) + text

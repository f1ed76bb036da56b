"""A file that ends within its last cell: what is left of a number is a number, too."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from erdctl.io.text.cells import NUMBER, Dialect, cells_of, kind_of
from erdctl.io.text.encoding import LINE_END, UTF8

if TYPE_CHECKING:
    from erdctl.io.text.layout import TextLayout

_TAIL = 1 << 16  # bytes looked at; a multiple of the four that a letter may take
FEWEST = 20  # rows that show how the last column is written
MOST = 400


def cut_off(data: str | bytearray, layout: TextLayout | None) -> list[str]:
    """What to say of a last line that ends within its last cell, as far as it shows.

    layout : how the text is written, None for plain CSV

    Many sound files have no line end at their end, so that alone says nothing. The cell must be
    unlike all above it: shorter behind the decimal sign where they are all as long, or the
    beginning of what they all are.
    """
    tail, whole = _tail(data)
    text = tail.decode(layout.encoding if layout else UTF8, errors="replace")
    if not text.rstrip(" \t") or text[-1] in "\r\n":
        return []
    dialect = layout.dialect if layout else Dialect()
    lines = LINE_END.split(text)[0 if whole else 1 :]
    rows = [cells_of(line, dialect.separator) for line in lines[-MOST:]]
    last = rows[-1][-1]
    above = [r[-1] for r in rows[:-1] if len(r) == len(rows[-1]) and kind_of(r[-1]) == NUMBER]
    if len(above) < FEWEST or kind_of(last) != NUMBER:
        return []
    decimals = {len(cell.partition(dialect.decimal)[2]) for cell in above}
    shorter = len(last.partition(dialect.decimal)[2]) < min(decimals) and len(decimals) == 1
    if shorter or (len(set(above)) == 1 and above[0].startswith(last) and above[0] != last):
        return [
            f"the last line has no line end, and its last cell '{last}' is shorter than all others"
            f" of its column, as '{above[-1]}': the file has probably been cut off there; copy it"
            " again, or remove that line"
        ]
    return []


def _tail(data: str | bytearray) -> tuple[bytes, bool]:
    """The end of a file, and whether it is all of it."""
    if not isinstance(data, str):
        begin = max(0, len(data) - _TAIL) // 4 * 4
        return bytes(data[begin:]), not begin
    begin = max(0, os.path.getsize(data) - _TAIL) // 4 * 4
    with open(data, "rb") as file:
        file.seek(begin)
        return file.read(), not begin

"""Where the samples are: the sign between cells, and the first row of numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from erdctl.core.errors import InputProblem
from erdctl.io.text.cells import (
    EMPTY,
    NUMBER,
    STAMP,
    TEXT,
    cells_of,
    comment_of,
    kind_of,
    stands_alone,
)
from erdctl.io.text.options import SEPARATORS

ROWS = 400  # looked at to tell what a column holds
FEWEST = 0.5  # of the cells of a sample are numbers or stamps


@dataclass(frozen=True)
class Row:
    """A line that is neither blank nor a comment.

    line : in the file, from 1
    """

    line: int
    cells: tuple[str, ...]
    kinds: tuple[str, ...]

    @property
    def is_sample(self) -> bool:
        """Whether it holds numbers rather than names."""
        values = sum(kind in (NUMBER, STAMP) for kind in self.kinds)
        filled = sum(kind != EMPTY for kind in self.kinds)
        return values >= 2 and values >= FEWEST * filled


@dataclass(frozen=True)
class Structure:
    """Samples as they were found.

    samples : the first of them;  width : the cells of the longest
    kinds : of every column;  shortest : cells that every sample has
    comment : the sign of comment lines, if there are any
    """

    separator: str
    samples: tuple[Row, ...]
    kinds: tuple[str, ...]
    width: int
    shortest: int
    comment: str | None

    @property
    def start(self) -> int:
        """Line of the first sample."""
        return self.samples[0].line


def structure_of(
    lines: Sequence[str], after: int, separator: str | None, file: str
) -> Structure | None:
    """The samples among the first lines of a file, or None if there are none.

    after : they begin below this line;  separator : if it is given
    """
    tried = [separator] if separator is not None else ["\t", ";", "|", ",", " "]
    numbered = [
        (number, line)
        for number, line in enumerate(lines, 1)
        if number > after and line.strip() and comment_of(line) is None
    ]
    # What a file is shows in its last lines as in its first, but no block of a header is there.
    numbered = numbered[: 3 * ROWS]
    best: tuple[float, list[Row]] | None = None
    chosen = ""
    for sign in tried:
        rows = [_row(number, line, sign) for number, line in numbered]
        score = _score(rows)
        # Blanks stand within dates and beside other separators, too.
        more = 1.2 if sign == " " else 1.0
        if score > 0.0 and (best is None or score > more * best[0] + 1e-9):
            best, chosen = (score, rows), sign
    if best is None:
        return None
    samples = _samples(best[1])
    usual, _ = Counter(len(row.cells) for row in samples).most_common(1)[0]
    width = max(len(row.cells) for row in samples if _texts_beyond(row, usual))
    columns = [[row.kinds[j] for row in samples if j < len(row.kinds)] for j in range(width)]
    # `%;mm;kN` are units, and used; only what is left out is said to be.
    signs = (comment_of(line) for line in lines if not stands_alone(line))
    comment = next((sign for sign in signs if sign is not None), None)
    return Structure(
        chosen,
        tuple(samples),
        tuple(_kind(kinds) for kinds in columns),
        width,
        min(len(row.cells) for row in samples),
        comment,
    )


def _row(number: int, line: str, separator: str) -> Row:
    cells = tuple(cells_of(line, separator))
    kinds = [kind_of(cell) for cell in cells]
    if separator == "," and '"' not in line:
        # `0,001 295,79` is two numbers with decimal commas, not three with one of 1 295.
        kinds = [TEXT if k == NUMBER and " " in c else k for c, k in zip(cells, kinds, strict=True)]
    return Row(number, cells, tuple(kinds))


def _score(rows: Sequence[Row]) -> float:
    """How well the samples come apart: their share of cells that are values, times their number."""
    samples = [row for row in rows if row.is_sample]
    if not samples:
        return 0.0
    width, _ = Counter(len(row.cells) for row in samples).most_common(1)[0]
    score = 0.0
    for row in samples:
        if len(row.cells) < width - 1 or not _texts_beyond(row, width):
            continue
        filled = sum(kind != EMPTY for kind in row.kinds)
        broken = sum(
            kind == TEXT and _mangled(c) for c, kind in zip(row.cells, row.kinds, strict=True)
        )
        score += (filled - broken) / filled if not broken else 0.2 / filled
    return score


def _texts_beyond(row: Row, width: int) -> bool:
    """Whether the cells that a row has more than others are texts: events, mostly absent."""
    return all(kind in (TEXT, EMPTY) for kind in row.kinds[width:])


def _mangled(cell: str) -> bool:
    """Whether a text has numbers and one of the signs that separate cells."""
    return any(sign in cell for sign in SEPARATORS.values()) and any(c.isdigit() for c in cell)


def _samples(rows: Sequence[Row]) -> list[Row]:
    """From the first sample on; lines of a header block may look like samples, too."""
    likely = [row for row in rows if row.is_sample]
    width, _ = Counter(len(row.cells) for row in likely).most_common(1)[0]
    late = [row for row in likely[len(likely) // 2 :] if abs(len(row.cells) - width) <= 1] or likely
    kinds = [
        _kind([row.kinds[j] for row in late if j < len(row.kinds)])
        for j in range(max(len(row.cells) for row in late))
    ]

    def fits(row: Row) -> bool:
        pairs = zip(row.kinds, kinds, strict=False)
        alike = all(k in (known, EMPTY) or known in (TEXT, EMPTY) for k, known in pairs)
        return row.is_sample and alike and _texts_beyond(row, len(kinds))

    first = next((i for i, row in enumerate(rows) if fits(row)), 0)
    # A first sample with a bad cell is a sample all the same: the reader will name the cell.
    while first > 0 and rows[first - 1].is_sample and len(rows[first - 1].cells) == width:
        if rows[first - 1].line != rows[first].line - 1 or not _numbers_where(
            rows[first - 1], kinds
        ):
            break
        first -= 1
    return [row for row in rows[first:] if row.is_sample][:ROWS]


def _numbers_where(row: Row, kinds: Sequence[str]) -> bool:
    """Whether most of the values of a row stand where values stand below."""
    at = [
        k in (NUMBER, STAMP)
        for k, known in zip(row.kinds, kinds, strict=False)
        if known in (NUMBER, STAMP)
    ]
    return sum(at) > len(at) / 2


def _kind(kinds: Sequence[str]) -> str:
    """What a column holds: what most of its cells hold that are not empty."""
    filled = Counter(kind for kind in kinds if kind != EMPTY)
    if not filled:
        return EMPTY
    return filled.most_common(1)[0][0]


def refuse_none(lines: Sequence[str], file: str) -> InputProblem:
    """There are no samples."""
    shown = next((line.strip() for line in lines if line.strip()), "")[:40]
    return InputProblem(
        f"no table of numbers in it; it begins '{shown}'. Expected a header row and rows of at"
        " least two numbers; say how it is written with --text, e.g. --text separator=semicolon",
        file=file,
    )

"""Lines as cells, and what a cell looks like: a number, a date or time, text, nothing."""

from __future__ import annotations

import csv
import re
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

from erdctl.io.text.options import FORMS_OF
from erdctl.io.text.stamps import is_stamp

NUMBER, STAMP, TEXT, EMPTY = "N", "D", "T", ""

# A number in any dialect, for recognition only.
_BLANKS, _MARKS = FORMS_OF[" "], FORMS_OF["'"]
_ANY_NUMBER = re.compile(
    rf"[+-]?(?:(?=[.,]?\d)(?:[1-9]\d{{0,2}}(?:[{_BLANKS}]\d{{3}})+"
    rf"|[1-9]\d{{0,2}}(?:[{_MARKS}]\d{{3}})+|[\d.,]*)"
    r"(?:[.,]\d*)?(?:[eE][+-]?\d+)?|inf(?:inity)?|nan)",
    re.IGNORECASE | re.ASCII,
)
# A comment, unless its sign is a cell of its own behind an empty first one (tabs, a unit of %), or
# it begins with an error or a cell too narrow of a spreadsheet (#N/A, #DIV/0!, #WERT!, ####): that
# is a sample.
COMMENT = (
    r"(?![ ]*\t[ \t]*(?:[#%][ ]*\t|%[ ]*$))[ \t]*"
    r"(?!#(?:N/A|NV|GETTING_DATA|[^\sa-z;,|#]+[!?]|##+)"
    r"(?:[ ]*[;,|\t][;,|\t ]*[^;,|\t\s]|[ ]+[-+.0-9]))"
    r"(#|%|//)"
)
_COMMENT = re.compile(COMMENT)
_ALONE = re.compile(r"[ \t]*(?:[#%])[ ]*[;,|\t]")
# A cell in quotes that its line leaves open, and the end of one; lines that it may go over.
_OPEN = re.compile(r'(?:^|.*[,;\t| ])"(?:[^"]|"")*')
_CLOSE = re.compile(r'(?:[^"]|"")*"[ ]*(?:[,;\t|].*)?')
LONGEST = 100


@dataclass(frozen=True)
class Dialect:
    """How cells are separated and numbers written.

    separator : " " stands for runs of blanks;  thousands : "" if none is used
    """

    separator: str = ","
    decimal: str = "."
    thousands: str = ""

    @property
    def number(self) -> re.Pattern[str]:
        """What a number must look like, blanks around it removed. Works in RE2, too."""
        point = re.escape(self.decimal)
        whole = "[0-9]+"
        if self.thousands:
            sign = between_thousands(self.thousands)
            whole = f"(?:[0-9]{{1,3}}(?:{sign}[0-9]{{3}})+|[0-9]+)"
        return re.compile(
            rf"^[+-]?(?:(?:{whole}(?:{point}[0-9]*)?|{point}[0-9]+)(?:[eE][+-]?[0-9]+)?"
            r"|[iI][nN][fF](?:[iI][nN][iI][tT][yY])?|[nN][aA][nN])$"
        )


def between_thousands(sign: str) -> str:
    """A pattern of the sign between thousands, in all its forms."""
    return f"[{re.escape(FORMS_OF.get(sign, sign))}]"


def cells_of(line: str, separator: str) -> list[str]:
    """The cells of a line, without blanks around them."""
    if separator == " ":
        line = re.sub(r"[ \t]+", " ", line.strip())
        if not line:
            return []
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)] if line else []
    try:
        rows = list(csv.reader([line], delimiter=separator, skipinitialspace=True))
    except csv.Error:
        return [line]
    return [cell.strip() for cell in rows[0]] if rows else []


def whole_lines(lines: Iterable[str]) -> Iterator[tuple[int, str]]:
    """Lines and their numbers from 1; a cell in quotes that goes over several makes them one.

    >>> list(whole_lines(['0,"a', 'b",1', '2,c,3']))
    [(1, '0,"a\\nb",1'), (3, '2,c,3')]
    """
    source, ahead, number = iter(lines), deque[str](), 1
    while ahead or (ahead := deque(islice(source, 1))):
        line, taken = ahead.popleft(), 1
        if line.count('"') % 2 and _OPEN.fullmatch(line):
            ahead.extend(islice(source, max(0, LONGEST - 1 - len(ahead))))
            last = next((k for k, other in enumerate(ahead, 1) if other.count('"') % 2), 0)
            if last and _CLOSE.fullmatch(ahead[last - 1]):
                line = "\n".join([line, *[ahead.popleft() for _ in range(last)]])
                taken += last
        yield number, line
        number += taken


def unbroken(lines: Sequence[str]) -> list[str]:
    """Lines (n,) with each cell in quotes that goes over several of them in its first one.

    The others are blank, so that lines keep their numbers.
    >>> unbroken(['0,"a', 'b",1', '2,c,3'])
    ['0,"a\\nb",1', '', '2,c,3']
    """
    out = [""] * len(lines)
    for number, line in whole_lines(lines):
        out[number - 1] = line
    return out


def kind_of(cell: str) -> str:
    """NUMBER, STAMP, TEXT or EMPTY."""
    if not cell:
        return EMPTY
    if _ANY_NUMBER.fullmatch(cell) and any(c.isdigit() or c in "nN" for c in cell):
        # 29.04.22 is a date: no number has two points with two digits between.
        return STAMP if is_stamp(cell) else NUMBER
    return STAMP if is_stamp(cell) else TEXT


def comment_of(line: str) -> str | None:
    """The sign that makes a line a comment.

    >>> [comment_of(line) for line in ("# a", "#N/A;1;2", "\\t%\\tN")]
    ['#', None, None]
    """
    found = _COMMENT.match(line)
    return found[1] if found else None


def stands_alone(line: str) -> bool:
    """Whether the sign of a comment is a cell of its own: a unit of %, a column called #."""
    return _ALONE.match(line) is not None

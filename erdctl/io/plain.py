"""Is a text a log as the contract writes CSV, or one for `erdctl.io.text` to recognise?"""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Sequence
from itertools import chain, islice

HEAD = 1 << 16  # bytes that tell
ROWS = 50  # of them

# What pyarrow takes for a number. Python's float() takes more ("1_0", Arabic digits).
NUMBER = re.compile(
    r"[ \t]*(?:[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|inf(?:inity)?|nan))?[ \t]*",
    re.IGNORECASE,
)
_COMMENTS = ("#", "%", "//")
# A decimal comma, a date or a time of day: text cells that may be more than text.
_FOREIGN = re.compile(
    r"[0-9],[0-9]|[0-9][-/.][0-9]{1,2}[-/.][0-9]|[0-9]:[0-9]{2}|[0-9]{8}T[0-9]{6}|[0-9] ?d(ays?)?\b"
)


def is_plain(data: str | bytearray) -> bool:
    """Whether a log begins as the contract writes CSV: names and numbers, and commas between.

    Anything else is for `erdctl.io.text` to recognise. It costs less than a millisecond.
    """
    if isinstance(data, str):
        with open(data, "rb") as file:
            head = file.read(HEAD)
    else:
        head = bytes(data[:HEAD])
    try:
        text = codecs.getincrementaldecoder("utf-8-sig")().decode(head, final=len(head) < HEAD)
        rows = [cells for cells in islice(csv.reader(io.StringIO(text, newline="")), ROWS) if cells]
    except UnicodeDecodeError:
        return False
    except csv.Error:
        return True  # a quote left open: found and explained by the reader
    if len(head) == HEAD and len(rows) < ROWS:
        rows = rows[:-1]  # cut
    if not rows or "\0" in text:
        return False
    names, samples = rows[0], rows[1:]
    if len(names) < 2 and not all(NUMBER.fullmatch(cell) for cells in samples for cell in cells):
        return False
    if any(NUMBER.fullmatch(name) for name in names) or names[0].lstrip().startswith(_COMMENTS):
        return False
    if any(cell[:1] in " \t" and cell.lstrip()[:1] == '"' for cell in chain(names, *samples[:1])):
        return False
    if any(len(cells) != len(names) for cells in samples):
        return False
    if samples and not any(map(_is_value, samples[0])) and any(map(_is_value, chain(*samples))):
        return False  # a row of units
    columns = zip(names, zip(*samples, strict=True), strict=False)
    return not any(name != "record" and _is_foreign(cells) for name, cells in columns)


def _is_value(cell: str) -> bool:
    return cell != "" and NUMBER.fullmatch(cell) is not None


def _is_foreign(column: Sequence[str]) -> bool:
    """Whether most texts of a column are numbers with a decimal comma, or dates and times.

    Not all: a word among clock times is an error of its row, not the times of theirs.
    """
    texts = [cell for cell in column if cell and not _is_value(cell)]
    foreign = sum(bool(_FOREIGN.search(cell)) and "\n" not in cell for cell in texts)
    return 2 * foreign > len(texts)

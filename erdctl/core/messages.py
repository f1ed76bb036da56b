"""Text for eyes: what stands in files reaches a terminal as characters, never as commands to it."""

from __future__ import annotations

import sys
from contextlib import suppress

LONGEST = 2_000  # characters of one message; a cell of a file may hold a megabyte
CELL = 200  # characters of one cell of a table
_CUT = " [... {} characters ...] "


def shown(text: str, most: int = LONGEST) -> str:
    r"""One line that any terminal takes: control characters escaped, no longer than `most`.

    A file can hold sequences that clear the screen, set its title or turn the direction of
    writing; they are shown as what they are (`\x1b[2J`). Of a long text the beginning and the end
    stay, since a message begins with the place and ends with what to do.
    Check: an ESC and a right-to-left mark become \x1b and \u202e, and µ stays; of 5000 characters
    in a message of 300, 300 are shown.
    >>> print(shown("\x1b \u202e µ"))
    \x1b \u202e µ
    >>> len(shown("x" * 5000, 300))
    300
    """
    if len(text) > most:
        room = max(most - len(_CUT.format(len(text))), 2)
        head, tail = room - room // 6, room // 6
        text = text[:head] + _CUT.format(len(text) - head - tail) + text[len(text) - tail :]
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in _SPACES else _escaped(c) for c in text)


def counted(count: int, noun: str) -> str:
    """How many of something there are, one or several.

    >>> counted(1, "record"), counted(0, "empty row")
    ('1 record', '0 empty rows')
    """
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def plain(value: float, digits: int = 3) -> str:
    """A number with so many significant digits, and no exponent below a million.

    >>> plain(1234.5), plain(0.29649), plain(-148.8), plain(-0.0)
    ('1230', '0.296', '-149', '0')
    """
    return f"{float(f'{value:.{digits}g}') + 0.0:g}"


def duration(seconds: float, digits: int = 3) -> str:
    """A time as a sentence has it: in ms, or in s from 1 s on.

    >>> duration(0.296), duration(1.2345), duration(0.99996), duration(0.01, 2)
    ('296 ms', '1.23 s', '1 s', '10 ms')
    """
    if abs(float(f"{seconds:.{digits}g}")) >= 1.0:
        return f"{plain(seconds, digits)} s"
    return f"{plain(1e3 * seconds, digits)} ms"


# No-break and thin spaces stand in units and numbers, and harm nobody.
_SPACES = "\u00a0\u2009\u202f"


def as_text(name: str) -> str:
    r"""The name of a file as text that can be stored: bytes that are no UTF-8 as `\udcff`."""
    return name.encode(errors="backslashreplace").decode()


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def tell(line: str) -> None:
    """A line on stderr. Nobody need be reading: a remark that has no reader is not worth the work.

    Closed and full streams are passed over on purpose: there is no place left to say so, and a
    result must not be lost because of a remark.
    """
    with suppress(OSError, ValueError):
        sys.stderr.write(line + "\n")
        sys.stderr.flush()

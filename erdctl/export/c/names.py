"""Names and numbers of C."""

from __future__ import annotations

import math
import re
from functools import cache
from importlib.resources import files

# Of C and C++, as a header may be read by either, and the type `real`.
_RESERVED = """
auto break case char const continue default do double else enum extern float for goto if inline
int long register restrict return short signed sizeof static struct switch typedef union unsigned
void volatile while and bitand bitor bool catch class compl delete explicit export false friend
mutable namespace new not operator or private protected public real template this throw true try
typeid typename using virtual xor
"""
KEYWORDS = frozenset(_RESERVED.split())


def identifier(name: str) -> str:
    """A name as C takes it; the same for the same name. It begins with a letter: what begins with
    an underscore is the compiler's own.

    >>> identifier("front left.2"), identifier("2nd"), identifier("double"), identifier("é")
    ('front_left_2', 'n2nd', 'double_', 'n')
    """
    plain = re.sub(r"[^A-Za-z0-9_]", "_", name).lstrip("_")
    if not plain[:1].isalpha():
        plain = f"n{plain}"
    return f"{plain}_" if plain in KEYWORDS else plain


def literal(value: float) -> str:
    """A number in the source, with all its digits.

    >>> literal(0.1), literal(-2.0)
    ('K(0.1)', 'K(-2.0)')
    """
    if not math.isfinite(value):
        raise ValueError(f"{value} is no number that C could begin with")
    return f"K({float(value)!r})"


def comment(text: str) -> str:
    """Text that may stand within a comment of C, on one line."""
    return " ".join(text.split()).replace("*/", "* /").replace("/*", "/ *")


@cache
def part(name: str) -> str:
    """A fixed part of the source; PREFIX stands for the block's name."""
    return (files("erdctl.export.c") / "parts" / name).read_text(encoding="utf-8")


def helpers(text: str) -> str:
    """The helper functions that a source calls, and those that these call, in their order.

    One that nothing calls would be a warning.
    """
    pieces = part("helpers.c").strip().split("\n\n")
    blocks: list[str] = []
    for piece in pieces:
        if re.match(r"(/\*|static )", piece):
            blocks.append(piece)
        else:  # the rest of a function, behind its variables
            blocks[-1] += f"\n\n{piece}"
    out: list[str] = []
    for block in reversed(blocks):
        found = re.search(r"static [\w ]*?(\w+)\(", block)
        assert found is not None, block
        if re.search(rf"\b{found[1]}\(", text + "\n".join(out)):
            out.insert(0, block)
    return "\n\n".join(out)

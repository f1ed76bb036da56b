"""Bytes as text: UTF-8, UTF-16 with or without its mark, else Latin-1."""

from __future__ import annotations

import codecs
import re

from erdctl.core.errors import InputProblem

UTF8, LATIN1, WINDOWS = "utf-8", "latin-1", "cp1252"
_MARKS = {
    codecs.BOM_UTF8: UTF8,
    codecs.BOM_UTF32_LE: "utf-32-le",  # before UTF-16, whose mark it begins with
    codecs.BOM_UTF32_BE: "utf-32-be",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
CALLED = {UTF8: "UTF-8", LATIN1: "Latin-1", WINDOWS: "Latin-1", "utf-16-le": "UTF-16",
          "utf-16-be": "UTF-16", "utf-32-le": "UTF-32", "utf-32-be": "UTF-32"}  # fmt: skip
# Line ends as pyarrow sees them. str.splitlines() would see more (form feeds, 0x85, ...).
LINE_END = re.compile(r"\r\n|\n|\r")


def encoding_of(head: bytes, file: str, *, whole: bool, given: bool = False) -> tuple[str, int]:
    """The encoding that a file begins in, and the length of its mark.

    head : its first bytes;  whole : they are all;  given : the encoding is, but not the mark
    Raises InputProblem for what is no text, and for UTF-8 with single bytes of something else.
    """
    for mark, name in _MARKS.items():
        if head.startswith(mark):
            return name, len(mark)
    if b"\0" in head:
        # Digits in UTF-16 are a byte of text and a byte 0.
        even, odd = head[0::2].count(0), head[1::2].count(0)
        if max(even, odd) > 0.8 * (len(head) // 2) and min(even, odd) == 0:
            return ("utf-16-be" if even else "utf-16-le"), 0
        raise InputProblem("neither text nor a format that is known: it has bytes 0", file=file)
    try:
        codecs.getincrementaldecoder(UTF8)().decode(head, final=whole)
    except UnicodeDecodeError:
        text = head.decode(UTF8, errors="surrogateescape")
        bad = len(re.findall("[\udc80-\udcff]", text))
        if not given and sum(not letter.isascii() for letter in text) >= 2 * bad:
            decoded(head, UTF8, file, whole=whole)  # most letters are UTF-8: says which is not
        return (LATIN1 if re.search(rb"[\x81\x8d\x8f\x90\x9d]", head) else WINDOWS), 0
    return UTF8, 0


def decoded(data: bytes, encoding: str, file: str, *, whole: bool = True) -> str:
    """The text; of a part that may end within a letter, what is whole of it.

    Raises InputProblem with the line of a byte that is not of the encoding.
    """
    try:
        return codecs.getincrementaldecoder(encoding)().decode(data, final=whole)
    except UnicodeDecodeError as error:
        before = data[: error.start].decode(encoding, errors="replace")
        raise InputProblem(
            f"not {CALLED.get(encoding, encoding)}: byte 0x{data[error.start]:02x} near"
            f" '{LINE_END.split(before)[-1][-20:]}'; say what it is, e.g. --text encoding=latin-1",
            file=file,
            row=len(LINE_END.split(before)),
        ) from None

"""`--text "decimal=comma,date=dmy"`: what a user says about how a text file is written."""

from __future__ import annotations

import codecs
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from erdctl.core.errors import UsageProblem

TextSpec: TypeAlias = Mapping[str, object] | Sequence[str] | str | None

SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t", "bar": "|", "space": " "}
DECIMALS = {"point": ".", "comma": ","}
THOUSANDS = {"none": "", "point": ".", "comma": ",", "space": " ", "apostrophe": "'"}
# Signs between thousands, in all their forms: blanks that do not break, printed apostrophes.
FORMS_OF = {" ": " \u00a0\u202f", "'": "'\u2019", ".": ".", ",": ","}
DATES = ("dmy", "mdy", "ymd")
_EXAMPLE = '--text "separator=semicolon,decimal=comma,date=dmy"'


@dataclass(frozen=True)
class TextOptions:
    """What is given; None is to be recognised.

    separator, decimal, thousands : the signs themselves ("" : no thousands separator)
    date : dmy, mdy or ymd;  header, units : line in the file, 0 for none
    interval : time between samples [s], where stamps are too coarse or missing
    """

    encoding: str | None = None
    separator: str | None = None
    decimal: str | None = None
    thousands: str | None = None
    date: str | None = None
    header: int | None = None
    units: int | None = None
    interval: float | None = None


def parse_text_options(given: TextSpec) -> TextOptions:
    """Options as the command line and Python give them.

    Raises UsageProblem for unknown keys and values, with those there are.
    """
    out = TextOptions()
    for key, value in pairs_of(given):
        if key in ("separator", "decimal", "thousands"):
            known = {"separator": SEPARATORS, "decimal": DECIMALS, "thousands": THOUSANDS}[key]
            changes: dict[str, Any] = {key: _sign(key, value, known)}
            out = replace(out, **changes)
        elif key == "date":
            if value not in DATES:
                raise _wrong(key, value, ", ".join(DATES))
            out = replace(out, date=value)
        elif key in ("header", "units"):
            if value != "none" and not (value.isascii() and value.isdigit() and int(value) > 0):
                raise _wrong(key, value, "the number of a line, or none")
            changes = {key: 0 if value == "none" else int(value)}
            out = replace(out, **changes)
        elif key == "encoding":
            out = replace(out, encoding=_encoding(value))
        elif key == "interval":
            out = replace(out, interval=_interval(value))
        else:
            known_keys = ", ".join(TextOptions.__dataclass_fields__)
            raise UsageProblem(f"--text: unknown '{key}'; known are {known_keys}; e.g. {_EXAMPLE}")
    if out.decimal is not None and out.decimal == out.thousands:
        raise UsageProblem("--text: decimal and thousands are the same sign")
    return out


def pairs_of(given: TextSpec) -> list[tuple[str, str]]:
    """Keys and values as they are given."""
    if given is None:
        return []
    if isinstance(given, Mapping):
        return [(str(key), str(value)) for key, value in given.items()]
    specs = [given] if isinstance(given, str) else given
    pairs: list[tuple[str, str]] = []
    for part in (part.strip() for spec in specs for part in spec.split(",")):
        if not part:
            continue
        key, equals, value = (piece.strip() for piece in part.partition("="))
        if not (key and equals and value):
            raise UsageProblem(f'--text "{part}": write KEY=VALUE, e.g. {_EXAMPLE}')
        pairs.append((key, value))
    return pairs


def _sign(key: str, value: str, known: Mapping[str, str]) -> str:
    if value in known:
        return known[value]
    if value and value in known.values():
        return value
    raise _wrong(key, value, ", ".join(known))


def _encoding(value: str) -> str:
    try:
        name = codecs.lookup(value).name
        "a".encode(name)  # `rot13` and the like are codecs of something else
    except (LookupError, TypeError, ValueError):
        raise _wrong("encoding", value, "a name like utf-8, utf-16-le, latin-1, gbk") from None
    return name


def _interval(value: str) -> float:
    try:
        seconds = float(value)
    except ValueError:
        seconds = 0.0
    if not 0.0 < seconds < 1e6:
        raise _wrong("interval", value, "seconds between samples, e.g. 0.005")
    return seconds


def _wrong(key: str, value: str, known: str) -> UsageProblem:
    return UsageProblem(f'--text "{key}={value}": expected {known}')

"""The interval between samples that the block above a header states, as a rate or as a time."""

from __future__ import annotations

import re
from collections.abc import Sequence

from erdctl.io.text.numerals import COMMA, POINT, evidence_of

_RATE = re.compile(
    r"(?:sampl\w*|scan|abtast\w*|acquisition)[ _-]?(?:(?P<of>interval\w*|period|time|rate|freq\w*)|"
    r"(?<=intervall)|(?<=rate)|(?<=frequenz))?(?:[ _]*[(\[](?P<unit>[A-Za-zµ]+)[)\]])?"
    r"\s*[:=;,\t ]\s*"
    r"(?P<value>[0-9](?:[0-9.,'\u2019 \u00a0\u202f]*[0-9])?(?:[eE][+-]?[0-9]+)?)\s*"
    r"(?P<after>[A-Za-zµ]*)(?![0-9A-Za-zµ:-]|[/.,][0-9])",  # `Sampling time: 12:30:05` is none
    re.IGNORECASE,
)
_SCALES = {"": 1.0, "hz": 1.0, "khz": 1e3, "s": 1.0, "sec": 1.0, "ms": 1e-3}


def stated_interval(lines: Sequence[str], decimal: str) -> float | None:
    """Seconds between samples, None if the lines do not say so clearly.

    decimal : sign of the numbers in the samples
    Check: above decimal points 200 Hz are 0.005 s, 1,000 Hz are 1000 Hz or, elsewhere, 1 Hz,
    1'000 Hz are 0.001 s, 0,5 kHz are 0.002 s, and 1.000 Hz is 1.0 s.
    >>> rates = ("200 Hz", "1,000 Hz", "1'000 Hz", "0,5 kHz", "1.000 Hz")
    >>> [stated_interval([f"Sample rate: {rate}"], ".") for rate in rates]
    [0.005, None, 0.001, 0.002, 1.0]
    """
    found = set()
    for line in lines:
        said = _RATE.match(line.strip().lstrip("#%/ "))
        if said is None or said["of"] is None:
            continue
        value = _value(said["value"], decimal)
        unit = (said["unit"] or said["after"] or "").lower()
        rate = said["of"].lower().startswith(("rate", "freq"))
        scale = _SCALES.get(unit)
        if value is None:
            return None
        if value > 0.0 and scale is not None and (unit in ("", "hz", "khz")) == (rate or not unit):
            found.add(round(1.0 / (value * scale), 12) if rate else value * scale)
    return found.pop() if len(found) == 1 else None


def _value(text: str, decimal: str) -> float | None:
    """A number in whatever notation, None where two readings are possible."""
    if re.search(r"\s", text):  # 1 000, or the rates of two channels
        return None
    proven = evidence_of([(text, 0)])
    sign = next(iter(proven.decimal), "")
    if proven.either and decimal not in proven.either:
        return None
    if proven.either:
        sign = decimal
    for other in {POINT, COMMA, "'", "\u2019"} - {sign}:
        text = text.replace(other, "")
    try:
        return float(text.replace(sign, POINT) if sign else text)
    except ValueError:
        return None

"""The temperature guard of mimic: which column it reads, and which it would overlook.

A hot damper is not the one that was identified (Sec. 5.4), so a log with a temperature must not
pass unseen because its column is called `Oil [degC]`. Names and units decide what looks like one:
too often rather than too seldom, since a false alarm costs one option.
"""

from __future__ import annotations

import re
import shlex
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Recording
from erdctl.io.identity import STDIN
from erdctl.io.logs import Log
from erdctl.io.units import WrongUnit, between, listed, name_and_unit

TARGET = "temperature"
COLDEST = -273.0  # degC, of a limit
UNITS_OF_IT = ("degC", "degF", "K", "degR")

# Parts of words that mean a temperature in any place, without accents and in lower case.
_WORDS = ("temperat", "температур", "温度", "celsius", "fahrenheit", "thermocouple", "thermistor")
_NO_TEMP = ("templ", "tempo", "temper", "tempes", "tempt", "tempi")  # words that begin like it
_FLUIDS = {
    "oil", "oel", "ol", "huile", "fluid", "liquid", "coolant", "water", "air", "amb", "ambient",
    "room", "body", "housing", "case", "cyl", "cylinder", "wall", "skin", "surface", "tank", "gas",
    "erf", "motor",
}  # fmt: skip
_PLACES = _FLUIDS | {
    "damper", "fl", "fr", "rl", "rr", "front", "rear", "left", "right", "in", "out", "inlet",
    "outlet", "hot", "cold", "rod", "seal", "er", "top", "bottom", "mean", "max", "min", "avg",
}  # fmt: skip
_OF_TIME = {
    "s", "ms", "us", "ns", "sec", "min", "rel", "abs", "stamp", "step", "start", "end", "rec",
    "sample", "time", "d",
}  # fmt: skip
# Of quantities whose symbol is a letter that is a unit of temperature too: `Force (F)`.
_LETTERS = {"F": ("force", "kraft", "effort", "load", "capac"), "C": ("capac", "charge", "damping"),
            "K": ("gain", "stiff", "spring")}  # fmt: skip
_NO_UNIT = (None, "", "-", "1", "?", "deg", "°")  # or none that tells anything
_UNIT = re.compile(
    r"(?P<degree>â?°|deg(?:ree)?s?|grad)?(?P<of>c|cel|celsius|centigrade|f|fahrenheit|k|kelvin|r|rankine)"
)
_WRITTEN = re.compile(
    r"(?:°|(?i:deg))[ ._]?(?P<of>[CFK])(?![A-Za-z])|(?i:deg)(?P<low>[cfk])(?![a-z])"
)
_BEHIND = re.compile(r"(?P<name>.*\S)\s*\((?P<unit>[^()]*)\)\s*", re.DOTALL)
_OTHERS = ("m", "s", "m/s", "m/s^2", "N", "kg", "Pa", "Hz", "J", "W", "K/s", "K/m")


@dataclass(frozen=True)
class LikelyTemperature:
    """A column that looks like a temperature.

    unit : degC, degF, K or degR where it states one;  other : what it states in place of one
    """

    column: str
    unit: str | None
    other: str | None = None

    @property
    def as_map(self) -> str:
        """What --map takes to read it as `temperature`; NAME[UNIT] where its unit is not known."""
        bracket = name_and_unit(self.column)[1]
        if bracket is not None and _convertible(bracket):
            return f"{TARGET}={self.column}"
        return f"{TARGET}={self.column}[{self.unit or 'UNIT'}]"


@dataclass(frozen=True)
class TemperatureGuard:
    """What held the limit on the temperature of the damper.

    state : `read` from a column, `declined` by an option, or `none` in the log
    column, unit : of the log's own, if one is read;  hottest, limit : [degC]
    unread : further columns that look like temperatures
    """

    state: Literal["read", "declined", "none"]
    column: str | None
    unit: str | None
    hottest: float | None
    limit: float | None
    unread: tuple[str, ...]

    def lines(self) -> list[str]:
        """What there is to say about it."""
        if not self.unread:
            return []
        columns = listed([f"'{c}'" for c in self.unread])
        if self.state == "read":
            return [f"the temperature is read from '{self.column}' only, not from {columns}"]
        return [f"the temperature in {columns} is not looked at, as asked for"]

    def document(self) -> dict[str, Any]:
        """Its part of the manifest."""

        def degrees(value: float | None) -> dict[str, Any] | None:
            return None if value is None else {"value": value, "unit": "degC"}

        return {
            "guard": self.state,
            "column": self.column,
            "unit": self.unit,
            "hottest": degrees(self.hottest),
            "limit": degrees(self.limit),
            "not_read": list(self.unread),
        }


def guarded(
    log: Log, limit: float, *, declined: bool, say_map: str, say_decline: str
) -> TemperatureGuard:
    """Which column holds the limit [degC] on the temperature; inf declines it.

    say_map, say_decline : how a caller writes these options, `{}` for what is mapped

    Raises UsageProblem for what is no temperature, whether or not the log has one, and if only a
    column that is not read looks like one.
    """
    if not limit >= COLDEST:
        raise UsageProblem(f"the highest temperature is in degC, not {limit:g}")
    declined = declined or limit == float("inf")
    recording = log.recording
    found = looks_like_temperatures(log.unread, log.units)
    mapped = next((c for c in log.channels if c.name == TARGET), None)
    name = files_of(recording)
    if mapped is not None and recording.temperature is None and not declined:
        raise UsageProblem(
            f"{name}: only some of the logs have a column '{mapped.column}', so that the others may"
            f" be too hot (Sec. 5.4): give them one at a time, or {say_decline}"
        )
    if mapped is None and found and not declined:
        raise UsageProblem(f"{name}: {_overlooked(found, say_map, say_decline)}")
    hottest = None if recording.temperature is None else float(recording.temperature.max())
    read = mapped is not None and hottest is not None
    return TemperatureGuard(
        # An option that declines what is not there declines nothing.
        state="declined" if declined and (read or found) else "read" if read else "none",
        column=mapped.column if mapped is not None and read else None,
        unit=_unit_of(mapped.factor, mapped.offset) if mapped is not None and read else None,
        hottest=hottest,
        limit=None if declined else limit,
        unread=tuple(f.column for f in found),
    )


def _overlooked(found: list[LikelyTemperature], say_map: str, say_decline: str) -> str:
    first = found[0]
    also = f" (and {listed([f.column for f in found[1:]], 5)})" if len(found) > 1 else ""
    spec = first.as_map
    quoted = f'"{spec}"' if not re.search(r'["$`\\!]', spec) else shlex.quote(spec)
    remedy = f"give {say_map.format(quoted)}"
    if first.other is not None:
        remedy = f"make a temperature of its '{first.other}' and map that"
    elif first.unit is None:
        remedy += ", with degC, degF or K for its UNIT"
    return (
        f"column '{first.column}'{also} looks like a temperature, which is not read, so that a hot"
        f" damper would pass unseen (Sec. 5.4): {remedy}, or {say_decline}"
    )


def files_of(recording: Recording) -> str:
    """The files that a log came from, in words."""
    names = ["stdin" if s.name == STDIN else s.name for s in recording.sources]
    return listed(names, 3) if names else "the log"


def looks_like_temperatures(
    columns: Iterable[str], units: Mapping[str, str]
) -> list[LikelyTemperature]:
    """Those of some columns that look like temperatures; units : as a file states them."""
    out = []
    for column in columns:
        stated = _stated(column, units)
        unit = temperature_unit(stated) if stated else None
        if unit is not None and _is_symbol(column, stated):
            unit = None
        written = _WRITTEN.search(_plain(column))
        if unit is None and written:
            unit = temperature_unit("deg" + (written["of"] or written["low"]).upper())
        if unit is not None or _named_like_one(column, stated):
            out.append(
                LikelyTemperature(column, unit, None if unit or stated in _NO_UNIT else stated)
            )
    return out


def temperature_unit(text: str) -> str | None:
    """degC, degF, K or degR for a unit of temperature as people write it, else None.

    Check: "°C", "deg. C" and "Celsius" are degC; "K/s", "c" and "N" are none.
    >>> [temperature_unit(u) for u in ("°C", "deg. C", "Celsius", "F", "K/s", "c", "N")]
    ['degC', 'degC', 'degC', 'degF', None, None, None]
    """
    plain = re.sub(r"[\s._]", "", _plain(text))
    found = _UNIT.fullmatch(plain.casefold())
    if not found or (len(plain) == 1 and plain not in ("C", "F", "K")):
        return None
    if found["of"] == "r" and not found["degree"]:
        return None
    return {"c": "degC", "f": "degF", "k": "K", "r": "degR"}[found["of"][0]]


def _plain(text: str) -> str:
    """Text with one sign for the degree, and none for what compatibility spells apart."""
    return text.replace("º", "°").replace("℃", "°C").replace("℉", "°F")


def _stated(column: str, units: Mapping[str, str]) -> str | None:
    """The unit that a file or a name states, in any brackets, or None."""
    if column in units:
        return units[column]
    bracket = name_and_unit(column)[1]
    if bracket is not None:
        return bracket
    behind = _BEHIND.fullmatch(column)
    return behind["unit"].strip() if behind else None


def _is_symbol(column: str, unit: str | None) -> bool:
    """Whether a letter in brackets stands for the quantity itself: `Force (F)`."""
    return any(word in column.casefold() for word in _LETTERS.get(unit or "", ()))


def _named_like_one(column: str, stated: str | None) -> bool:
    bare = name_and_unit(column)[0]
    folded = "".join(c for c in unicodedata.normalize("NFKD", bare) if not unicodedata.combining(c))
    tokens = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", folded)
    oily = any(t.casefold() in _FLUIDS for t in tokens)
    french = "temps" in map(str.casefold, tokens)  # the time, but that of no oil
    words = any(word in folded.casefold() for word in _WORDS) or any(map(_is_word, tokens))
    if words or (french and oily):
        return not _of_another_kind(stated)
    # A symbol alone proves little: any stated unit but one of temperature speaks against it.
    return _is_temperature_symbol(tokens) and stated in _NO_UNIT


def _is_word(token: str) -> bool:
    t = token.casefold()
    if t in ("temp", "tmp", "rtd", "ntc") or (t.endswith("temp") and len(t) > 4):
        return True
    if not t.startswith("temp"):
        return False
    return t[4:] in _PLACES or (t != "temps" and not t.startswith(_NO_TEMP))


def _is_temperature_symbol(tokens: list[str]) -> bool:
    """T, T1, T_oil, Toil, t_oil, oil_C, Pt100, TC1; not t, t_ms, T_d."""
    if not tokens:
        return False
    first, *rest = tokens
    lower = [t.casefold() for t in tokens]
    if first == "T":
        return not rest or lower[1] not in _OF_TIME
    if first == "t" and rest:
        return lower[1] in _FLUIDS
    if first[0] == "T" and lower[0][1:] in _PLACES:
        return True
    if tokens[-1] == "C" and len(tokens) > 1:
        return lower[-2] in _FLUIDS
    return any(
        (a == "pt" and b in ("100", "500", "1000")) or (a == "tc" and b.isdigit())
        for a, b in pairwise(lower)
    )


def _of_another_kind(stated: str | None) -> bool:
    """Whether a unit is that of something that no sensor of temperature gives."""
    if not stated or temperature_unit(stated):
        return False
    return any(_convertible(stated, other) for other in _OTHERS)


def _convertible(unit: str, wanted: str = "degC") -> bool:
    try:
        between(unit, wanted)
    except WrongUnit:
        return False
    return True


def _unit_of(factor: float, offset: float) -> str | None:
    """The unit whose values become degC by this factor and offset."""
    for unit in UNITS_OF_IT:
        found = between(unit, "degC")
        if (float(found.factor), float(found.offset)) == (factor, offset):
            return unit
    return None

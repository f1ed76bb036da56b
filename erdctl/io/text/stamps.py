"""Dates, times of day and durations as seconds, exact to the nanosecond."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Integers = npt.NDArray[np.int64]

_CLOCK = (
    r"(?P<h>[0-9]{1,2}):(?P<m>[0-9]{2}):(?P<s>[0-9]{2})(?:[.,](?P<f>[0-9]{1,9})|:(?P<ms>[0-9]{3}))?"
    r"(?:[ ]*(?P<ap>[AaPp])\.?[Mm]\.?)?"
)
_ZONE = r"(?:[ ]*(?P<zone>Z|UTC|[+-][0-9]{2}:?[0-9]{2}))?"
_TIME = rf"(?:(?:T|[ ,]+){_CLOCK}{_ZONE})?"
_MONTHS = {
    "jan": 1, "feb": 2, "mar": 3, "mär": 3, "apr": 4, "may": 5, "mai": 5, "jun": 6, "jul": 7,
    "aug": 8, "sep": 9, "oct": 10, "okt": 10, "nov": 11, "dec": 12, "dez": 12,
}  # fmt: skip
DAY = 86_400 * 10**9
_NONE = 10**18  # no limit

YEAR_FIRST, YEAR_LAST, NAMED = "year first", "year last", "month by name"
CLOCK, MINUTES, DURATION, COMPACT = "time of day", "minutes", "duration", "compact"

# In order: a cell is of the first form that it fits as a whole.
FORMS = {
    YEAR_FIRST: rf"(?P<y>[0-9]{{4}})[-/.](?P<b>[0-9]{{1,2}})[-/.](?P<c>[0-9]{{1,2}}){_TIME}",
    YEAR_LAST: rf"(?P<a>[0-9]{{1,2}})(?P<sep>[-/.])(?P<b>[0-9]{{1,2}})[-/.]"
    rf"(?P<y>[0-9]{{4}}|[0-9]{{2}}){_TIME}",
    NAMED: r"(?P<a>[0-9]{1,2})[-/. ]+(?P<mon>[A-Za-zä]{3})[a-z]*[-/., ]+(?P<y>[0-9]{4})" + _TIME,
    COMPACT: r"(?P<y>[0-9]{4})(?P<b>[0-9]{2})(?P<c>[0-9]{2})T"
    r"(?P<h>[0-9]{2})(?P<m>[0-9]{2})(?P<s>[0-9]{2})(?:[.,](?P<f>[0-9]{1,9}))?" + _ZONE,
    DURATION: r"(?P<d>-?[0-9]+)[ ]*d(?:ays?)?,?(?:[ ]+[+]?(?P<h>[0-9]{1,2}):(?P<m>[0-9]{2}):"
    r"(?P<s>[0-9]{2})(?:[.,](?P<f>[0-9]{1,9}))?)?",
    CLOCK: _CLOCK.replace("<h>[0-9]{1,2}", "<h>[0-9]{1,4}"),
    MINUTES: r"(?P<m>[0-9]{1,3}):(?P<s>[0-9]{2})[.,](?P<f>[0-9]{1,9})",
}
_COMPILED = {name: re.compile(form) for name, form in FORMS.items()}


def is_stamp(cell: str) -> bool:
    """Whether a cell is a date, a time or a duration."""
    return form_of(cell) is not None


def form_of(cell: str) -> str | None:
    """The form of FORMS that a cell has."""
    if ":" not in cell and not cell[:1].isdigit() and not cell.startswith("-"):
        return None
    return next((name for name, form in _COMPILED.items() if form.fullmatch(cell)), None)


def has_time(form: str, cell: str) -> bool:
    """Whether a cell has a time of day beside its date."""
    found = _COMPILED[form].fullmatch(cell)
    return found is not None and found.groupdict().get("h") is not None


class NoStamp(Exception):
    """Says what is wrong with a sample; `sample` is None where it is the column."""

    def __init__(self, reason: str, sample: int | None = None) -> None:
        super().__init__(reason)
        self.sample = sample


@dataclass(frozen=True)
class Read:
    """Stamps as nanoseconds from an origin of their own, and what was assumed.

    resolution : of the stamps as they are printed [ns]
    """

    ns: Integers
    form: str
    notes: tuple[str, ...]
    resolution: int


def nanoseconds(cells: Any, form: str, order: str | None) -> Read:
    """A column of stamps of one form.

    cells : pyarrow text, blanks around it removed;  order : dmy, mdy or ymd if it was given
    Raises NoStamp for a cell that is none, and where two orders of day and month are possible.
    """
    import pyarrow as pa
    import pyarrow.compute as pc

    # RE2 knows no fullmatch, and wants (?P<name>.
    parts = pc.extract_regex(cells, "^(?:" + FORMS[form] + ")$")
    parts = parts.combine_chunks() if isinstance(parts, pa.ChunkedArray) else parts
    if parts.null_count:
        at = pc.index(pc.is_null(parts), True).as_py()
        raise NoStamp(f"found '{str(cells[at].as_py())[:40]}', expected a {kind(form)}", at)
    texts = {parts.type.field(i).name: parts.field(i) for i in range(parts.type.num_fields)}
    notes: list[str] = []
    days, called = _days(texts, form, order)
    hours = _whole(texts, "h")
    if "ap" in texts:
        hours = _of_24(hours, texts["ap"], notes)
    minutes, seconds = _whole(texts, "m"), _whole(texts, "s")
    elapsed = form == CLOCK and not pc.any(pc.not_equal(texts["ap"], "")).as_py()
    for values, most, what in (
        (hours, _NONE if elapsed else 24, "hours"),
        (minutes, _NONE if form == MINUTES else 60, "minutes"),
        (seconds, 60, "seconds"),
    ):
        bad = values >= most
        if bad.any():
            at = int(bad.argmax())
            raise NoStamp(f"found '{cells[at].as_py()[:40]}', which has {values[at]} {what}", at)
    fraction, digits = _fraction(texts)
    ns = days * DAY + ((hours * 60 + minutes) * 60 + seconds) * 10**9 + fraction
    ns -= _zones(texts) * 60 * 10**9
    if form == CLOCK:
        ns = _past_midnight(ns, notes)
    return Read(ns, called, tuple(notes), 10 ** (9 - digits))


def kind(form: str) -> str:
    """What a form is, for messages."""
    return {CLOCK: "time h:mm:ss", MINUTES: "time m:ss.f", DURATION: "duration"}.get(form, "date")


def _whole(texts: dict[str, Any], name: str) -> Integers:
    """Group of digits; 0 where it is empty or not in the form."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if name not in texts:
        length = len(next(iter(texts.values())))
        return np.zeros(length, dtype=np.int64)
    column = texts[name]
    filled = pc.if_else(pc.equal(column, ""), "0", column)
    return np.asarray(filled.cast(pa.int64()))


def _fraction(texts: dict[str, Any]) -> tuple[Integers, int]:
    import pyarrow as pa
    import pyarrow.compute as pc

    length = len(next(iter(texts.values())))
    out, digits = np.zeros(length, dtype=np.int64), 0
    for name in ("f", "ms"):
        if name not in texts:
            continue
        padded = pc.utf8_rpad(texts[name], 9, "0")
        out = out + np.asarray(padded.cast(pa.int64()))
        longest = pc.max(pc.utf8_length(texts[name])).as_py()
        digits = max(digits, longest or 0)
    return out, digits


def _days(texts: dict[str, Any], form: str, order: str | None) -> tuple[Integers, str]:
    """Days since 1970, and how the date was read."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if form == DURATION:
        return np.asarray(texts["d"].cast(pa.int64())), "durations"
    if form in (CLOCK, MINUTES):
        return np.zeros(len(texts["s"]), dtype=np.int64), kind(form)
    year = _whole(texts, "y")
    year = np.where(year < 100, year + 2000, year)
    if form == NAMED:
        names = pc.utf8_slice_codeunits(pc.utf8_lower(texts["mon"]), 0, 3)
        known = pc.index_in(names, value_set=pa.array(list(_MONTHS)))
        if known.null_count:
            at = pc.index(pc.is_null(known), True).as_py()
            raise NoStamp(f"'{texts['mon'][at]}' is no month", at)
        month = np.array(list(_MONTHS.values()), dtype=np.int64)[np.asarray(known)]
        return _civil(year, month, _whole(texts, "a")), "dd-mmm-yyyy"
    if form in (YEAR_FIRST, COMPACT):
        return _civil(year, _whole(texts, "b"), _whole(texts, "c")), "yyyy-mm-dd"
    first, second = _whole(texts, "a"), _whole(texts, "b")
    sign = str(texts["sep"][0].as_py())
    short = pc.min(pc.utf8_length(texts["y"])).as_py() == 2
    chosen = order or _order(first, second, year, sign, short=short)
    if chosen == "ymd" and not short:
        raise NoStamp("these dates end in the year; say --text date=dmy or --text date=mdy", 0)
    if chosen == "ymd":
        return _civil(first + 2000, second, year - 2000), sign.join(("yy", "mm", "dd"))
    day, month = (first, second) if chosen == "dmy" else (second, first)
    shown = sign.join(("dd", "mm") if chosen == "dmy" else ("mm", "dd"))
    return _civil(year, month, day), shown + sign + ("yy" if short else "yyyy")


def _order(first: Integers, second: Integers, year: Integers, sign: str, *, short: bool) -> str:
    """Day first or month first; points are written day first."""
    changed = (first != first[0]) | (second != second[0]) | (year != year[0])
    if short and changed.any():
        raise NoStamp(
            "a date with a year of two digits may be read in three ways; say which: --text"
            " date=dmy, date=mdy or date=ymd",
            int(changed.argmax()),
        )
    if short and (first > 31).any():
        return "ymd"
    if (first > 12).any() or sign == ".":
        return "dmy"
    if (second > 12).any():
        return "mdy"
    if not changed.any():  # one day: the seconds from the first sample are the same either way
        return "mdy" if sign == "/" else "dmy"
    at = int(changed.argmax())
    raise NoStamp(
        "the date may be day/month or month/day, and no day is above 12; say which: --text"
        " date=dmy or --text date=mdy",
        at,
    )


def _civil(year: Integers, month: Integers, day: Integers) -> Integers:
    bad = (month < 1) | (month > 12)
    months = (year - 1970) * 12 + np.where(bad, 1, month) - 1
    begin = months.astype("datetime64[M]").astype("datetime64[D]").astype(np.int64)
    after = (months + 1).astype("datetime64[M]").astype("datetime64[D]").astype(np.int64)
    bad |= (day < 1) | (day > after - begin)
    if bad.any():
        at = int(bad.argmax())
        raise NoStamp(
            f"there is no day {day[at]} of month {month[at]}; if day and month are exchanged, say"
            " so: --text date=dmy or --text date=mdy",
            at,
        )
    return np.asarray(begin + day - 1, dtype=np.int64)


def _of_24(hours: Integers, suffix: Any, notes: list[str]) -> Integers:
    """Hours of the 24 h clock out of AM/PM; some loggers write 24 h and AM/PM behind it."""
    import pyarrow.compute as pc

    letters = pc.utf8_lower(suffix)
    given = np.asarray(pc.not_equal(letters, "").to_numpy(zero_copy_only=False))
    if not given.any():
        return hours
    pm = np.asarray(pc.equal(letters, "p").to_numpy(zero_copy_only=False))
    if not given.all():
        raise NoStamp("some times have AM or PM and others have not", int((~given).argmax()))
    beyond = (hours > 12) | (hours == 0)
    if beyond.any():
        late = hours >= 12
        wrong = late != pm
        if wrong.any():
            at = int(wrong.argmax())
            raise NoStamp(
                f"{hours[at]} h with {'PM' if pm[at] else 'AM'}: neither a 12 h nor a 24 h clock",
                at,
            )
        notes.append("hours of a 24 h clock, AM and PM without meaning")
        return hours
    out: Integers = hours % 12 + 12 * pm
    return out


def _zones(texts: dict[str, Any]) -> Integers:
    """Minutes ahead of UTC."""
    length = len(next(iter(texts.values())))
    if "zone" not in texts:
        return np.zeros(length, dtype=np.int64)
    zones = texts["zone"].dictionary_encode()
    minutes = []
    for zone in zones.dictionary.to_pylist():
        digits = (zone or "").replace(":", "")
        known = len(digits) == 5
        value = int(digits[1:3]) * 60 + int(digits[3:5]) if known else 0
        minutes.append(-value if digits.startswith("-") else value)
    return np.take(np.array(minutes, dtype=np.int64), np.asarray(zones.indices))


def _past_midnight(ns: Integers, notes: list[str]) -> Integers:
    """Times of day go on after midnight: a fall by all but a minute of a day is one."""
    falls = np.flatnonzero(np.diff(ns) < -(DAY - 60 * 10**9)) + 1
    if not len(falls) or ns.max() >= DAY:
        return ns
    days = np.zeros(len(ns), dtype=np.int64)
    days[falls] = 1
    notes.append("the clock passes midnight")
    out: Integers = ns + np.cumsum(days) * DAY
    return out


def combined(date: Read, time: Read) -> Read:
    """A date in one column and the time of day in another."""
    days = date.ns - date.ns % DAY
    called = f"{date.form} and {time.form}"
    if (days == days[0]).all():  # the day on which it began
        return Read(days + time.ns, called, (*date.notes, *time.notes), time.resolution)
    return Read(days + time.ns % DAY, called, date.notes, time.resolution)


def seconds_from_first(ns: Integers) -> npt.NDArray[np.float64]:
    """(n,) seconds from the first sample.

    Check: 5,000,000 ns after it is 0.005 s.
    >>> seconds_from_first(np.array([10**18, 10**18 + 5_000_000])).tolist()
    [0.0, 0.005]
    """
    out: npt.NDArray[np.float64] = (ns - ns[0]) / 1e9
    return out

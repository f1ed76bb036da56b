"""Tolerance bands: whether a damper holds them, judged with the error of what is known of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from math import inf, isfinite, nan

import numpy as np

from erdctl.compare.history import MONTH, History
from erdctl.compare.pair import told_by
from erdctl.compare.trend import Trend

AHEAD = 120  # months in which a trend may reach the end of its band


class Holds(Enum):
    """Whether a value lies within its band."""

    PASS = "pass"
    FAIL = "fail"
    UNKNOWN = "cannot tell"


@dataclass(frozen=True, kw_only=True)
class Band:
    """Lowest and highest value that is allowed [SI]; infinite where there is no such end."""

    low: float = -inf
    high: float = inf


@dataclass(frozen=True, kw_only=True)
class Judged:
    """One band of one damper.

    value, low, high : and the ends of its 95 % interval, NaN where not known
    of : what was judged: a log, or the trend at the last date;  why : where it cannot be told
    reached : when the trend reaches an end of the band, with the first and the last date at 95 %
    [days since 1970]; the last is infinite where it may never
    """

    name: str
    unit: str
    band: Band
    holds: Holds
    value: float
    low: float
    high: float
    of: str
    why: str = ""
    reached: tuple[float, float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class Rule:
    """A band of one parameter or score.

    off : of an effect's, the value at which it is absent;  bounds : what it can be at all
    """

    name: str
    unit: str
    band: Band
    off: float | None = None
    bounds: tuple[float, float] = (-inf, inf)


@dataclass(frozen=True, kw_only=True)
class _Found:
    """What there is to judge: value, ends of its interval, of what, or why there is none."""

    value: float = nan
    low: float = nan
    high: float = nan
    of: str = ""
    why: str = ""


def judge(history: History, trends: Mapping[str, Trend], rules: Sequence[Rule]) -> list[Judged]:
    """All bands of one damper: by the trend at its last date, or else by its last log.

    A score has no error, and its value counts.  An effect that is not named has its off value, and
    may be as large as the size from which it would have been named.
    """
    return [_judged(history, trends.get(rule.name), rule) for rule in rules]


def _judged(history: History, trend: Trend | None, rule: Rule) -> Judged:
    if trend is not None and not trend.absent_after:
        value, error = trend.now
        half = 1.96 * error
        found = _Found(value=value, low=value - half, high=value + half, of="its trend, now")
    else:
        found = _last(history, rule)
    holds, why = Holds.UNKNOWN, found.why
    if not why:
        holds = within(rule.band, found.low, found.high)
        why = "an end of the band lies within its error" if holds is Holds.UNKNOWN else ""
    ahead = trend is not None and holds is not Holds.FAIL
    return Judged(
        name=rule.name, unit=rule.unit, band=rule.band, holds=holds, value=found.value,
        low=found.low, high=found.high, of=found.of, why=why,
        reached=reach(trend, rule.band) if trend is not None and ahead else None,
    )  # fmt: skip


def _last(history: History, rule: Rule) -> _Found:
    """By the last log."""
    if not history.logs:
        return _Found(why="no log of it could be used")
    last = len(history.logs) - 1
    of, told = history.logs[last], told_by(history, last).get(rule.name)
    if told is not None and told.named:
        low, high = told.interval
        if not isfinite(low) and "." in rule.name:
            return _Found(value=told.value, of=of, why="it has no standard error")
        return _Found(
            value=told.value, low=low if isfinite(low) else told.value,
            high=high if isfinite(high) else told.value, of=of,
        )  # fmt: skip
    if rule.off is None:
        return _Found(of=of, why="the log does not tell it")
    if not (history.searched and history.searched[last]):
        return _Found(of=of, why="no diagnosis has looked for it")
    limit = told.limit if told is not None else nan
    if isfinite(limit):
        # From that size on it would have been named, to either side where it has two.
        size, (least, most) = abs(limit - rule.off), rule.bounds
        low = max(rule.off - size, min(least, rule.off))
        high = min(rule.off + size, max(most, rule.off))
        return _Found(value=rule.off, low=low, high=high, of=of)
    if not history.settled[last]:
        return _Found(of=of, why="a misfit is left that no effect explains")
    return _Found(value=rule.off, low=rule.off, high=rule.off, of=of)


def within(band: Band, low: float, high: float) -> Holds:
    """Whether an interval lies in a band.

    Check: 1 to 2 is within 0 to 2, out of 3 to 4, and neither of 1.5 to 4.
    >>> [within(Band(low=a, high=b), 1.0, 2.0).value for a, b in ((0, 2), (3, 4), (1.5, 4))]
    ['pass', 'fail', 'cannot tell']
    """
    if low >= band.low and high <= band.high:
        return Holds.PASS
    if high < band.low or low > band.high:
        return Holds.FAIL
    return Holds.UNKNOWN


def reach(trend: Trend, band: Band) -> tuple[float, float, float] | None:
    """When a line or a ramp leaves the band; None if not within `AHEAD` months.

    The trend itself and the ends of its 95 % interval, each followed month by month, up to the end
    of the band that it goes towards: what comes back into a band from without leaves none.
    """
    if trend.rate is None:
        return None
    end = float(trend.series.t[-1])
    t = end + MONTH * np.arange(0.0, AHEAD + 0.5, 0.25)
    f, error = trend.at(t)
    # The end of the interval that is ahead of the trend crosses first.
    ahead = np.sign(trend.rate[0]) * 1.96 * error
    dates = []
    for line in (f, f + ahead, f - ahead):
        out = np.flatnonzero(line > band.high if trend.rate[0] > 0.0 else line < band.low)
        dates.append(float(t[out[0]]) if len(out) else inf)
    return (dates[0], dates[1], dates[2]) if isfinite(dates[0]) else None

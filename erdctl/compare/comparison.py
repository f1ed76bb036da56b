"""Dampers over time and side by side, sorted by what needs attention."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import IntEnum
from math import isfinite

from erdctl.compare.history import History
from erdctl.compare.pair import Pair, pair
from erdctl.compare.tolerance import Holds, Judged, Rule, judge
from erdctl.compare.trend import Trend, trend

FALSE_ALARMS = 0.02  # chance that a whole comparison tells any change where there is none
SIDE_BY_SIDE = 12  # dampers of one log each that are compared with the first of them


class Attention(IntEnum):
    """Why somebody should look at a damper; the first that applies."""

    FAILS = 0
    WILL_FAIL = 1
    CHANGED = 2
    UNKNOWN = 3
    BROKEN = 4
    QUIET = 5
    ALONE = 6

    @property
    def words(self) -> str:
        """As a table says it."""
        return {
            Attention.FAILS: "out of tolerance",
            Attention.WILL_FAIL: "will be out of tolerance",
            Attention.CHANGED: "changed",
            Attention.UNKNOWN: "cannot tell",
            Attention.BROKEN: "logs with errors",
            Attention.QUIET: "unchanged",
            Attention.ALONE: "no earlier log",
        }[self]


@dataclass(frozen=True, eq=False, kw_only=True)
class Damper:
    """One damper.

    trends : by parameter or score, of those that enough dated logs tell
    pairs : logs against an earlier one, where there are too few of them for trends
    judged : against tolerance bands
    """

    history: History
    trends: Mapping[str, Trend]
    pairs: Sequence[Pair] = ()
    judged: Sequence[Judged] = ()

    @property
    def changes(self) -> list[Trend]:
        """The trends that are no constant, the surest first."""
        found = [t for t in self.trends.values() if t.changed]
        return sorted(found, key=lambda t: (t.scan.p, -t.size))

    @property
    def attention(self) -> Attention:
        """What needs it most."""
        holds = [j.holds for j in self.judged]
        if Holds.FAIL in holds:
            return Attention.FAILS
        if any(j.reached is not None for j in self.judged):
            return Attention.WILL_FAIL
        if self.changes or any(p.changes or p.together for p in self.pairs):
            return Attention.CHANGED
        if Holds.UNKNOWN in holds or any(not p.told for p in self.pairs):
            return Attention.UNKNOWN
        if self.history.failed:
            return Attention.BROKEN
        return Attention.QUIET if self.compared else Attention.ALONE

    @property
    def compared(self) -> bool:
        """Whether it was held against an earlier log, or another damper."""
        return bool(self.trends or self.pairs)

    @property
    def urgency(self) -> tuple[float, ...]:
        """By which dampers are sorted, the most urgent first."""
        dates = [j.reached[0] for j in self.judged if j.reached is not None]
        return (
            float(self.attention),
            min(dates, default=0.0) if self.attention is Attention.WILL_FAIL else 0.0,
            min((t.scan.p for t in self.changes), default=1.0),
            min((d.p for p in self.pairs for d in p.changes), default=1.0),
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Compared:
    """All dampers, the most urgent first.

    tests : parameters that were looked at for a change over time
    false_alarms : chance of any told change over time where there is none
    """

    dampers: Sequence[Damper]
    tests: int
    false_alarms: float

    @property
    def logs(self) -> int:
        """Of all dampers."""
        return sum(len(d.history.logs) for d in self.dampers)

    def count(self, holds: Holds) -> int:
        """Bands that hold, fail, or of which it cannot be told."""
        return sum(j.holds is holds for d in self.dampers for j in d.judged)


def compare(
    histories: Sequence[History],
    *,
    rules: Sequence[Rule] = (),
    across: bool = False,
    false_alarms: float = FALSE_ALARMS,
    progress: Callable[[], None] = lambda: None,
) -> Compared:
    """Trends where there are enough dated logs, differences where there are two or a few.

    across : whether dampers of one log each are compared with the first of them
    """
    tests = sum(len(h.series) for h in histories if h.dated)
    single = [h for h in histories if len(h.logs) == 1]
    side = across and 2 <= len(single) == len(histories) <= SIDE_BY_SIDE
    out = []
    for history in histories:
        found: dict[str, Trend] = {}
        for name, series in history.series.items() if history.dated else ():
            one = trend(series, false_alarms / tests)
            if one is not None:
                found[name] = one
        pairs = [] if found else _pairs(history)
        if side and history is not histories[0]:
            pairs = [pair((histories[0], 0), (history, 0))]
        judged = judge(history, found, rules)
        out.append(Damper(history=history, trends=found, pairs=pairs, judged=judged))
        progress()
    return Compared(
        dampers=sorted(out, key=lambda d: d.urgency), tests=tests, false_alarms=false_alarms
    )


def _pairs(history: History) -> list[Pair]:
    """The last log against the first one."""
    if len(history.logs) < 2:
        return []
    return [pair((history, 0), (history, len(history.logs) - 1))]


def iso(days: float) -> str | None:
    """A date of so many days since 1970; None for none, and for one beyond the calendar.

    Check: 31 days after 1970-01-01 is 1970-02-01.
    >>> iso(31.0)
    '1970-02-01'
    """
    if not isfinite(days) or not 0 <= days + 719162 < 3652059:
        return None
    return (datetime(1970, 1, 1) + timedelta(days=days)).date().isoformat()

"""Dampers over time and side by side: every trend, with the whole family of tests in view."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from erdctl.compare.history import History
from erdctl.compare.trend import Trend, trend

FALSE_ALARMS = 0.02  # chance that a whole comparison tells any change where there is none


@dataclass(frozen=True, eq=False, kw_only=True)
class DamperTrends:
    """One damper.  trends : by parameter or score, of those that enough dated logs tell"""

    history: History
    trends: Mapping[str, Trend]

    @property
    def changes(self) -> list[Trend]:
        """What changed, the surest first."""
        found = [t for t in self.trends.values() if t.changed]
        return sorted(found, key=lambda t: (t.scan.p, -t.size))


def over_time(
    histories: Sequence[History],
    false_alarms: float = FALSE_ALARMS,
    progress: Callable[[], None] = lambda: None,
) -> list[DamperTrends]:
    """The trends of all dampers.

    false_alarms : chance of any change told of all dampers and parameters where none changes
    """
    tests = sum(len(h.series) for h in histories if h.dated)
    out = []
    for history in histories:
        found: dict[str, Trend] = {}
        for name, series in history.series.items() if history.dated else ():
            one = trend(series, false_alarms / tests)
            if one is not None:
                found[name] = one
        out.append(DamperTrends(history=history, trends=found))
        progress()
    return out

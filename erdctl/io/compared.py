"""A comparison as JSON, `"schema": "erdctl.comparison/1"`, and its published shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any, Final, Literal, TypedDict

import msgspec
import numpy as np

from erdctl.compare.comparison import Compared, Damper, iso
from erdctl.compare.pair import Difference, Pair, ToldValue
from erdctl.compare.tolerance import Holds, Judged
from erdctl.compare.trend import Trend
from erdctl.core.version import __version__

SCHEMA: Final = "erdctl.comparison/1"


class WithError(TypedDict):
    """A value with its standard error, null where there is none."""

    value: float | None
    stderr: float | None


class Since(TypedDict):
    """When a change set in: the date, and the first and the last one at 95 %."""

    date: str | None
    first: str | None
    last: str | None


class ForecastDocument(TypedDict):
    """Where 95 % of single logs will lie at a date if all goes on so."""

    date: str | None
    value: float
    low: float
    high: float


class TrendDocument(TypedDict):
    """One parameter over time; form : constant, linear, step or ramp (constant, then a line).

    start, now : at the first and the last date;  rate : change a year
    appeared, vanished : of an effect that is not named before, or after
    p : that a constant looks so changed, all places of a change counted;  tests : see the document
    spread : standard deviation of single logs around the form
    """

    parameter: str
    unit: str
    form: str
    logs: int
    start: WithError
    now: WithError
    since: Since | None
    rate: WithError | None
    appeared: bool
    vanished: bool
    p: float
    spread: float
    forecast: ForecastDocument
    text: str


class DifferenceDocument(TypedDict):
    """One parameter of two logs; verdict : changed, within its error, cannot tell, appeared or
    vanished.  p : that it is chance, all parameters of the pair counted"""

    parameter: str
    unit: str
    before: WithError
    after: WithError
    change: WithError
    p: float | None
    verdict: str
    text: str


class JointDocument(TypedDict):
    """All parameters together, with the covariance of both fits: chi2 and its degrees of freedom.

    told_by : the fewest parameters whose change alone explains the differences
    """

    chi2: float
    dof: int
    p: float
    told_by: list[str]


class PairDocument(TypedDict):
    """Two logs."""

    before: str
    after: str
    joint: JointDocument | None
    differences: list[DifferenceDocument]
    remarks: list[str]


class JudgedDocument(TypedDict):
    """A tolerance band; verdict : pass, fail or cannot tell.

    interval : 95 %, of what is judged;  of : which log, or the trend
    reached : when the trend leaves the band
    """

    parameter: str
    unit: str
    low: float | None
    high: float | None
    value: float | None
    interval: tuple[float, float] | None
    of: str
    verdict: str
    why: str
    reached: Since | None


class FailedLog(TypedDict):
    """A log that could not be used."""

    log: str
    error: str


class DamperDocument(TypedDict):
    """One damper; attention : why somebody should look at it;  said : that in sentences."""

    damper: str
    corner: str | None
    logs: int
    first: str | None
    last: str | None
    attention: str
    said: list[str]
    trends: list[TrendDocument]
    pairs: list[PairDocument]
    limits: list[JudgedDocument]
    failed: list[FailedLog]
    rig: dict[str, int]


class Checks(TypedDict):
    """How many bands hold, fail, or cannot be told."""

    passed: int
    failed: int
    cannot_tell: int


class ComparisonFile(TypedDict):
    """Dampers over time and side by side, those that need attention first.

    tests : parameters that were looked at for a change over time;  false_alarms : chance that any
    of them is told to change where none does
    """

    schema: Literal["erdctl.comparison/1"]
    erdctl: str
    logs: int
    tests: int
    false_alarms: float
    checks: Checks
    dampers: list[DamperDocument]


class Words:
    """What is said of a trend, a difference and a damper, and to know of a pair."""

    def __init__(
        self,
        trend: Callable[[Trend], str],
        difference: Callable[[Difference], str],
        damper: Callable[[Damper], Sequence[str]],
        remarks: Callable[[Pair], Sequence[str]],
    ) -> None:
        self.trend, self.difference, self.damper, self.remarks = trend, difference, damper, remarks


def to_json(found: Compared, words: Words) -> ComparisonFile:
    """The document of a comparison."""
    return {
        "schema": SCHEMA,
        "erdctl": __version__,
        "logs": found.logs,
        "tests": found.tests,
        "false_alarms": found.false_alarms,
        "checks": {
            "passed": found.count(Holds.PASS),
            "failed": found.count(Holds.FAIL),
            "cannot_tell": found.count(Holds.UNKNOWN),
        },
        "dampers": [_damper(d, words) for d in found.dampers],
    }


def _damper(d: Damper, words: Words) -> DamperDocument:
    h = d.history
    return {
        "damper": h.damper,
        "corner": h.corner,
        "logs": len(h.logs),
        "first": iso(float(np.nanmin(h.t))) if np.isfinite(h.t).any() else None,
        "last": iso(float(np.nanmax(h.t))) if np.isfinite(h.t).any() else None,
        "attention": d.attention.words,
        "said": list(words.damper(d)),
        "trends": [_trend(t, words.trend(t)) for t in d.trends.values()],
        "pairs": [_pair(p, words) for p in d.pairs],
        "limits": [_judged(j) for j in d.judged],
        "failed": [{"log": log, "error": error} for log, error in h.failed],
        "rig": dict(h.rig),
    }


def _trend(t: Trend, text: str) -> TrendDocument:
    return {
        "parameter": t.series.name,
        "unit": t.series.unit,
        "form": t.form.value,
        "logs": int(t.series.named.sum()),
        "start": _value(*t.start),
        "now": _value(*t.now),
        "since": None if t.since is None else _since(t.since),
        "rate": None if t.rate is None else _value(*t.rate),
        "appeared": t.absent_before,
        "vanished": t.absent_after,
        "p": t.scan.p,
        "spread": t.spread,
        "forecast": forecast(t),
        "text": text,
    }


def forecast(t: Trend) -> ForecastDocument:
    """One log to come."""
    at = np.array([float(t.series.t[-1]) + t.ahead])
    low, high = t.band(at)
    value = float(t.at(at)[0][0])
    return {"date": iso(float(at[0])), "value": value, "low": float(low[0]), "high": float(high[0])}


def _pair(p: Pair, words: Words) -> PairDocument:
    joint: JointDocument | None = None
    if p.joint is not None:
        j = p.joint
        joint = {"chi2": j.statistic, "dof": j.dof, "p": j.p, "told_by": list(j.told_by)}
    return {
        "before": p.before[0].logs[p.before[1]],
        "after": p.after[0].logs[p.after[1]],
        "joint": joint,
        "differences": [
            {
                "parameter": d.name,
                "unit": d.unit,
                "before": _told(d.before),
                "after": _told(d.after),
                "change": _value(d.change, d.error),
                "p": _number(d.p),
                "verdict": d.verdict.value,
                "text": words.difference(d),
            }
            for d in p.differences
        ],
        "remarks": list(words.remarks(p)),
    }


def _judged(j: Judged) -> JudgedDocument:
    return {
        "parameter": j.name,
        "unit": j.unit,
        "low": _number(j.band.low),
        "high": _number(j.band.high),
        "value": _number(j.value),
        "interval": (j.low, j.high) if isfinite(j.low) and isfinite(j.high) else None,
        "of": j.of,
        "verdict": j.holds.value,
        "why": j.why,
        "reached": None if j.reached is None else _since(j.reached),
    }


def _since(dates: tuple[float, float, float]) -> Since:
    at, first, last = (iso(d) for d in dates)
    return {"date": at, "first": first, "last": last}


def _told(t: ToldValue) -> WithError:
    return _value(t.value, t.stderr)


def _value(value: float, stderr: float) -> WithError:
    return {"value": _number(value), "stderr": _number(stderr)}


def _number(value: float) -> float | None:
    return value if isfinite(value) else None


def json_schema() -> dict[str, Any]:
    """The published JSON Schema of a comparison."""
    return msgspec.json.schema(ComparisonFile)

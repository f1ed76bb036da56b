"""Bands: pass and fail only where the interval says so, and when a trend will leave them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from erdctl.compare.history import History, Series
from erdctl.compare.tolerance import Band, Holds, Judged, Rule, judge
from erdctl.compare.trend import trend
from erdctl.io.limits_file import read_limits

NONE = np.array([np.nan])
DAMPER = "backlash.g"


def one(
    value: float, stderr: float, off: float | None = None, limit: float = np.nan, **said: bool
) -> History:
    s = Series(
        name=DAMPER, unit="m", at=np.array([0]), t=NONE, value=np.array([value]),
        stderr=np.array([stderr]), low=NONE, high=NONE, off=off, limit=np.array([limit]),
    )  # fmt: skip
    return History(
        damper="D", logs=("a.json",), t=NONE, series={DAMPER: s},
        searched=(said.get("searched", True),), settled=(said.get("settled", True),),
    )  # fmt: skip


def judged(history: History, low: float = -np.inf, high: float = np.inf) -> Judged:
    return judge(
        history, {}, [Rule(name=DAMPER, unit="m", band=Band(low=low, high=high), off=0.0)]
    )[0]


@pytest.mark.parametrize(
    ("value", "holds"),
    [(0.2, Holds.PASS), (0.49, Holds.UNKNOWN), (0.51, Holds.UNKNOWN), (0.7, Holds.FAIL)],
)
def test_by_the_interval(value: float, holds: Holds) -> None:
    assert judged(one(value, 0.05), high=0.5).holds is holds


def test_without_an_error_it_cannot_be_told() -> None:
    found = judged(one(0.2, np.nan), high=0.5)
    assert found.holds is Holds.UNKNOWN
    assert "no standard error" in found.why


@pytest.mark.parametrize(
    ("limit", "said", "holds"),
    [
        (0.3, {}, Holds.PASS),
        (0.8, {}, Holds.UNKNOWN),
        (np.nan, {}, Holds.PASS),
        (np.nan, {"settled": False}, Holds.UNKNOWN),
        (0.3, {"searched": False}, Holds.UNKNOWN),
    ],
)
def test_an_effect_that_is_not_named(limit: float, said: dict[str, bool], holds: Holds) -> None:
    assert judged(one(np.nan, np.nan, 0.0, limit, **said), high=0.5).holds is holds


def test_an_effect_that_must_be_there() -> None:
    assert judged(one(np.nan, np.nan, 0.0, 0.3), low=0.5).holds is Holds.FAIL


def test_when_a_ramp_leaves_its_band() -> None:
    t = 18000.0 + 30.4375 * np.arange(60)
    r = np.random.default_rng(0)
    fall = 10.0 * np.maximum(t - t[30], 0.0) / 365.25
    s = Series(
        name=DAMPER, unit="N", at=np.arange(60), t=t, value=100.0 - fall + r.standard_normal(60),
        stderr=np.full(60, np.nan), low=np.full(60, np.nan), high=np.full(60, np.nan),
    )  # fmt: skip
    found = trend(s, 1e-4)
    assert found is not None
    history = History(damper="D", logs=("a",) * 60, t=t, series={DAMPER: s})
    rule = Rule(name=DAMPER, unit="N", band=Band(low=60.0))
    j = judge(history, {DAMPER: found}, [rule])[0]
    assert j.holds is Holds.PASS
    assert j.reached is not None
    truth = t[30] + 4.0 * 365.25
    assert j.reached[1] <= truth + 8 <= j.reached[2] + 16
    assert abs(j.reached[0] - truth) < 150
    out = Rule(name=DAMPER, unit="N", band=Band(low=99.0))
    assert judge(history, {DAMPER: found}, [out])[0].holds is Holds.FAIL


def test_what_goes_into_its_band_does_not_leave_it() -> None:
    """Falling, and 0.1 above a band now, which it goes into. It was said to
    be out of it as it goes on, and its damper the next to fail."""
    t = 18000.0 + 30.4375 * np.arange(60)
    years, noise = (t - t[0]) / 365.25, np.random.default_rng(0).standard_normal(60)
    s = Series(
        name=DAMPER, unit="N", at=np.arange(60), t=t, value=100.0 - 5.0 * years + noise,
        stderr=np.full(60, np.nan), low=np.full(60, np.nan), high=np.full(60, np.nan),
    )  # fmt: skip
    found = trend(s, 1e-4)
    assert found is not None
    history = History(damper="D", logs=("a",) * 60, t=t, series={DAMPER: s})
    rule = Rule(name=DAMPER, unit="N", band=Band(high=found.now[0] - 0.1))
    j = judge(history, {DAMPER: found}, [rule])[0]
    assert j.holds is Holds.UNKNOWN
    assert j.reached is None


def test_an_effect_of_two_signs_may_be_on_either_side(tmp_path: Path) -> None:
    """Named from 4 N on: a zero error of -4 N would not have been, and is out of -1 to 5 N. A play
    of less than 4 mm cannot be negative."""
    path = tmp_path / "limits.toml"
    path.write_text(
        '"force_offset.F_z" = { low = -1, high = 5 }\n"backlash.g" = { low = -1, high = "5 mm" }'
    )
    for rule in read_limits(str(path)):
        signed = rule.name == "force_offset.F_z"
        limit = 4.0 if signed else 4e-3
        found = judge(unnamed(rule.name, limit), {}, [rule])[0]
        assert (found.low, found.high) == (-limit if signed else 0.0, limit)
        assert found.holds is (Holds.UNKNOWN if signed else Holds.PASS)


def unnamed(name: str, limit: float) -> History:
    h = one(np.nan, np.nan, 0.0, limit)
    return replace(h, series={name: replace(h.series[DAMPER], name=name)})

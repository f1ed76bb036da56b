"""Where a misfit is looked for, on squared misfits that were put there."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from rig import campaign

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.findings import Finding
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.residual.lack_of_fit import LackOfFit
from erdctl.diagnose.residual.localisation import Region, describe, locate
from erdctl.diagnose.residual.places import acting, places
from erdctl.diagnose.residual.predictability import lack_of_fit_test
from erdctl.diagnose.wording import finding_text
from erdctl.effects import get
from erdctl.model.effect import Variable


@cache
def problem() -> Problem:
    return prepare(campaign())


def signals() -> Signals:
    return problem().block.signals


def of(variable: Variable, found: list[Region]) -> list[Region]:
    return [r for r in found if r.variable is variable]


def test_both_ends_of_the_stroke_are_two_places() -> None:
    x = signals().x
    end = 0.7 * np.abs(x).max()
    high, low = sorted(
        of(Variable.X, locate(problem(), 1.0 * (np.abs(x) > end))), key=lambda r: -r.low
    )
    assert (high.low, high.high) == pytest.approx((end, x.max()), rel=0.05)
    assert (low.low, low.high) == pytest.approx((x.min(), -end), rel=0.05)
    assert high.share + low.share == pytest.approx(1.0, abs=0.02)
    [only] = of(Variable.X, locate(problem(), 1.0 * (x > end)))
    assert (only.low, only.high) == pytest.approx((end, x.max()), rel=0.05)


def test_both_directions_at_high_speed_are_two_places() -> None:
    v = signals().xdot
    fast = 0.6 * np.abs(v).max()
    found = of(Variable.XDOT, locate(problem(), np.maximum(np.abs(v) - fast, 0.0) ** 2))
    assert len(found) == 2
    assert min(r.low for r in found) == pytest.approx(v.min())
    assert max(r.high for r in found) == pytest.approx(v.max())
    assert all(min(abs(r.low), abs(r.high)) > 0.95 * fast for r in found)
    [middle] = of(Variable.XDOT, locate(problem(), 1.0 * (np.abs(v) < 0.2 * fast)))
    assert middle.low < 0.0 < middle.high


def test_two_places_need_not_each_hold_half() -> None:
    """Each end holds less than the share that one place must have alone."""
    x = signals().x
    end = 0.7 * np.abs(x).max()
    square = np.where(np.abs(x) > end, 1.0, 0.0)
    square[np.abs(x) <= end] = 0.5 * square.sum() / (np.abs(x) <= end).sum()
    found = of(Variable.X, locate(problem(), square))
    assert len(found) == 2
    assert all(r.share < thresholds.REGION_SHARE for r in found)


def test_levels_that_differ_by_their_last_digits_are_one() -> None:
    """Of such a log 69 % was said to lie "at 1.46e-13 to 10 % duty", for that at no duty."""
    r = campaign()
    jitter = 1e-12 * np.random.default_rng(1).random(len(r))
    uneven = prepare(replace(r, duty=r.duty + jitter))
    square = np.where(r.duty < 0.05, 1.0, 0.01)
    found, plain = (of(Variable.DUTY, locate(p, square)) for p in (uneven, prepare(r)))
    assert plain
    assert [f.text for f in found] == [f.text for f in plain]


def spread(reversals: float = 0.8) -> Array:
    """A misfit that gathers most after reversals, and less so at one end of the stroke."""
    s = signals()
    return reversals * (s.since_reversal < 0.05) + 1.0 * (s.x > 0.5 * s.x.max()) + 0.01


def test_the_physics_of_what_explains_it_goes_first() -> None:
    gathered = locate(problem(), spread())
    assert gathered[0].variable is not Variable.X
    end_stop = get("end_stop")
    acts = acting(problem(), end_stop, {}, [1.0 * (signals().x > 0.01)])
    assert [r.variable for r in acts] == [Variable.X]
    listed = places(problem(), spread(), [(end_stop, acts)])
    assert listed[0].variable is Variable.X
    assert listed[1] == gathered[0]
    assert len(listed) <= thresholds.REGIONS
    # One that does not explain it all says less than the misfit itself.
    unsure = places(problem(), spread(), [(end_stop, acts)], sure=False)
    assert unsure[:2] == [listed[1], listed[0]]
    assert places(problem(), spread()) == gathered[: thresholds.REGIONS]
    # Nor where the misfit is far sharper elsewhere.
    sharp = places(problem(), spread(8.0), [(end_stop, acts)])
    assert [r.variable for r in sharp[:2]] == [Variable.SINCE_REVERSAL, Variable.X]


def test_a_place_that_is_most_of_the_range_is_none() -> None:
    t, leak = signals().t, get("oil_leakage")
    square = np.where(t < 3.0, 1.0, 0.1)
    acts = acting(problem(), leak, {leak.key("t_0"): 3.0}, [1.0 * (t >= 3.0)])
    assert (acts[0].low, acts[0].high) == (3.0, t.max())  # there it acts, and this is said of it
    first = places(problem(), square, [(leak, acts)])[0]
    assert (first.variable, first.low, first.high) == (Variable.TIME, 3.0, t.max())
    assert first.share < first.time
    assert first.text.startswith("oil_leakage acts from 3 s to the end of the records")
    assert f"{100 * (1 - first.share):.0f} % of the misfit" in first.text
    # Where the duty points at something it goes first, and never what was before the onset.
    high = np.where(signals().duty > 0.25, 3.0, 0.1) * square
    listed = places(problem(), high, [(leak, acts)])
    assert [r.variable for r in listed[:2]] == [Variable.DUTY, Variable.TIME]
    assert all(r.high > 3.0 for r in listed if r.variable is Variable.TIME)
    [before] = of(Variable.TIME, places(problem(), square))
    assert before.high == pytest.approx(3.0, abs=0.1)
    # Little of the time, yet most of what times since a reversal there are.
    since = signals().since_reversal
    late = 0.3 * since[np.isfinite(since)].max()
    assert np.mean(since[np.isfinite(since)] > late) < 0.5
    assert of(Variable.SINCE_REVERSAL, locate(problem(), 1.0 * (since > late))) == []


def test_where_nothing_gathers_in_its_variable_an_effect_is_where_it_acts() -> None:
    """The first place has its share of the misfit, not of the effect's own force."""
    x = signals().x
    # No interval of x holds half of it, but the end has more than its part of the time.
    square = np.where(x > 0.5 * x.max(), 1.5, 1.0)
    assert of(Variable.X, locate(problem(), square)) == []
    end_stop = get("end_stop")
    acts = acting(problem(), end_stop, {}, [1.0 * (x > 0.7 * x.max())])
    [acted] = acts
    assert acted.share == pytest.approx(1.0)
    [listed] = places(problem(), square, [(end_stop, acts)])
    assert (listed.low, listed.high) == (acted.low, acted.high)
    assert listed.time < listed.share < 0.5
    assert f"{100 * listed.share:.0f} % of the misfit" in listed.text
    # Where the misfit is less than there elsewhere, and gathers nowhere, it is said of the effect.
    less = np.where(x > 0.7 * x.max(), 0.5, 1.0)
    [only] = places(problem(), less, [(end_stop, acts)])
    assert (only.low, only.high) == (acted.low, acted.high)
    assert only.share < only.time
    assert f"{100 * acted.share:.0f} % of the square of what end_stop adds" in only.text
    assert places(problem(), less, [(end_stop, acts)], sure=False) == []


def test_what_the_other_parameters_leave_of_a_force_is_not_said_of_the_force() -> None:
    """Of a constant force 68 % was said to lie around reversals, in 36 % of the time."""
    preload, even = get("gas_preload"), np.ones(len(signals()))
    acts = acting(problem(), preload, {}, [even, spread(8.0)])
    assert acts
    assert "% of the misfit without it lies" in acts[0].text
    found = Finding(
        effect=preload, equivalent=(), test=None, gain=cast(Any, SimpleNamespace(gain=0.9)),
        acts=tuple(acts), before=0.1, after=0.01, runner_up=None,
    )  # fmt: skip
    assert "% of the misfit without it lies" in finding_text(found)
    own = acting(problem(), preload, {}, [spread(8.0), even])
    assert "% of the square of its force lies" in finding_text(replace(found, acts=tuple(own)))
    # Where the misfit gathers nowhere it has the name of the effect.
    [only] = places(problem(), even, [(preload, acts)])[:1]
    assert "% of the misfit without gas_preload lies" in only.text


def test_what_sets_in_at_a_time_acts_from_then_on() -> None:
    t = signals().t
    leak = get("oil_leakage")
    values = {leak.key("t_0"): 9.0}
    square = np.where(t < 9.0, 0.2, 0.5)
    acts = acting(problem(), leak, values, [square])
    assert len(acts) == 1
    first = places(problem(), square, [(leak, acts)])[0]
    assert (first.variable, first.low, first.high) == (Variable.TIME, 9.0, t.max())


def test_no_place_is_listed_twice() -> None:
    square = spread()
    preload, rub = get("gas_preload"), get("backlash")
    acts = [(e, acting(problem(), e, {}, [square])) for e in (preload, rub)]
    listed = places(problem(), square, acts)
    assert len({(r.variable, r.low, r.high) for r in listed}) == len(listed)
    assert len(listed) <= thresholds.REGIONS


def test_an_even_misfit_has_no_place() -> None:
    assert locate(problem(), np.ones(len(signals()))) == []
    assert places(problem(), np.zeros(len(signals()))) == []


def test_a_side_is_said_where_an_interval_hardly_crosses_rest() -> None:
    assert describe(Variable.XDOT, -0.028, 0.0002).startswith("in release, at -28")
    assert describe(Variable.XDOT, -0.0002, 0.028).startswith("in compression")
    assert describe(Variable.XDOT, 0.01, 0.028).startswith("in compression, at 10 to 28 mm/s")
    assert describe(Variable.XDOT, -0.01, 0.02).endswith("around reversal")


def test_times_from_a_second_on_are_in_s() -> None:
    """It was "within 1.23e+03 ms of a duty step"."""
    assert describe(Variable.SINCE_DUTY_STEP, 0.0, 1.2344) == "within 1.23 s of a duty step"
    assert describe(Variable.SINCE_REVERSAL, 0.0, 0.9998) == "within 1 s of a reversal"
    assert describe(Variable.SINCE_DUTY_STEP, 0.0, 0.296) == "within 296 ms of a duty step"
    assert describe(Variable.SINCE_REVERSAL, 0.4, 1.2) == "0.4 to 1.2 s after a reversal"
    assert describe(Variable.SINCE_REVERSAL, 0.04, 0.12) == "40 to 120 ms after a reversal"


def test_no_place_has_an_exponent() -> None:
    assert describe(Variable.XDOT, 1.234, 2.346) == "in compression, at 1230 to 2350 mm/s"
    assert describe(Variable.TIME, 1234.0, 5432.0) == "where t is from 1230 to 5430 s"


def test_a_time_that_runs_on_over_records_is_that_of_the_log() -> None:
    """Of records of 6 s each it was "from 38.9 to 55.3 s in the records", which none is as long."""
    assert describe(Variable.TIME, 38.9275, 55.3275) == "where t is from 38.9 to 55.3 s"


def test_what_was_found_and_what_is_predicted_add_up() -> None:
    """They have signs: where they cancel there was no misfit; variance has none."""
    predicted, found = np.array([1.0, 2.0, 0.0]), np.array([-1.0, 1.0, 3.0])
    left = LackOfFit(
        predicted=predicted, excess=predicted**2 + np.array([0.0, 0.5, 0.0]), noise_rms=1.0,
        misfit_rms=1.0, significant=True, hint=True, spectral_line=None, impulses=0.0,
    )  # fmt: skip
    assert left.square(found).tolist() == [0.0, 9.5, 9.0]


def test_a_ripple_is_where_it_swings() -> None:
    """No regression predicts it, so that its place is where the rest is large."""
    s = signals()
    ripple = s.sign * np.sin(2 * np.pi * 23.0 * s.t) * (s.duty > 0.25)
    noise = 0.2 * np.random.default_rng(3).standard_normal(len(s))
    left = lack_of_fit_test(problem(), ripple + noise)
    assert left.spectral_line is not None
    [place] = of(Variable.DUTY, places(problem(), left.square(np.zeros(len(s)))))
    assert place.low == pytest.approx(0.25, abs=0.051)
    assert place.high == s.duty.max()

"""From which size data would have shown an effect: held against effects of that size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array, Recording
from erdctl.diagnose.detectable import (
    ABSORBED,
    TAKEN,
    Detectable,
    Injection,
    _least,
    amount_of,
)
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.forecast import forecast
from erdctl.diagnose.problem import prepare
from erdctl.effects import catalogue, get
from erdctl.io.diagnosis import to_json
from erdctl.model.composed import Model
from erdctl.model.parameters import Estimate, Parameters

FEW = ("coulomb_friction", "backlash", "input_delay", "mount_compliance")
SHORT = {"limits": False, "learning": False}  # no name rests on either


@pytest.fixture(scope="module")
def healthy() -> Diagnosis:
    return diagnose(noisy(campaign(100.0, 8.0), seed=31), [get(n) for n in FEW], jobs=1)


def of(found: Diagnosis, name: str) -> Detectable:
    (one,) = [d for d in found.undetected if d.effect.name == name]
    return one


def with_effect(found: Diagnosis, name: str, times: float) -> Recording:
    """The recording with an effect of so many times the size, by the model's own simulation."""
    r, d = found.problem.recording, of(found, name)
    assert d.values is not None
    assert r.force is not None
    on, best = amount_of(d.effect), found.selection.best
    signals = found.problem.block.signals

    def force(part: float) -> Array:
        values = {**d.values, on.symbol: on.off + part * (d.values[on.symbol] - on.off)}
        full = best.values | {d.effect.key(s): v for s, v in values.items()}
        return Model((d.effect,)).force(signals, full)

    # Less a trace of it: what is simulated another way as soon as it is on is no size.
    added = force(times) - force(1e-6)
    return replace(r, force=r.force + added)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    "name", [*FEW[:2], *(pytest.param(name, marks=pytest.mark.long) for name in FEW[2:])]
)
def test_that_size_is_named_and_a_tenth_is_not(healthy: Diagnosis, name: str) -> None:
    named = diagnose(with_effect(healthy, name, 1.0), [get(name)], most=1, **SHORT)
    assert [f.effect.name for f in named.findings] == [name]
    tenth = diagnose(with_effect(healthy, name, 0.1), [get(name)], most=1, **SHORT)
    assert tenth.findings == ()


@pytest.mark.long
def test_a_shape_that_was_added_to_an_effect_does_not_switch_off_its_force() -> None:
    """Of no size would a stop have been seen, it was said, since its contact may be damped."""
    r, stop = noisy(campaign(100.0, 8.0), seed=31), get("end_stop")
    found = diagnose(r, [stop], learning=False)
    least = of(found, "end_stop").values
    assert least is not None
    full = found.selection.best.values | {stop.key(s): v for s, v in least.items()}
    signals = found.problem.block.signals
    added = Model((stop,)).force(signals, full) - Model(()).force(signals, full)
    assert r.force is not None
    for part, named in ((1.0, ["end_stop"]), (0.1, [])):
        more = diagnose(replace(r, force=r.force + part * added), [stop], **SHORT)
        assert [f.effect.name for f in more.findings] == named


def test_every_effect_that_was_not_named_is_told(healthy: Diagnosis) -> None:
    document = to_json(healthy)["undetected"]
    assert {d["effect"] for d in document} == set(FEW)
    friction = next(d for d in document if d["effect"] == "coulomb_friction")
    assert friction["detectable"]
    assert friction["parameter"] == "F_c"
    assert friction["unit"] == "N"
    # Friction is its own force; a fit takes up a part of it.
    assert friction["force_rms"] == pytest.approx(friction["size"], rel=0.02)
    assert 0.0 < friction["beyond_rms"] < friction["force_rms"]
    text = to_json(healthy)["remaining"]["text"]
    assert "would have shown" in text
    assert "holds nothing" not in text


@pytest.mark.long
def test_more_noise_hides_more() -> None:
    quiet, loud = (
        diagnose(noisy(campaign(100.0, 8.0), seed=5, rms=rms), [get("coulomb_friction")])
        for rms in (0.1, 1.0)
    )
    sizes = [of(d, "coulomb_friction").size for d in (quiet, loud)]
    assert sizes[0] is not None
    assert sizes[1] is not None
    assert sizes[1] == pytest.approx(10 * sizes[0], rel=0.15)


def test_what_the_model_takes_up_is_never_shown() -> None:
    """At one duty level and no steps the yield force takes up all friction."""
    r = campaign(100.0, 8.0).select([1])
    found = diagnose(noisy(r, seed=8), [get("coulomb_friction"), get("input_delay")])
    friction, delay = of(found, "coulomb_friction"), of(found, "input_delay")
    assert friction.size is None
    assert friction.reason == ABSORBED
    assert delay.size is None
    assert delay.reason == found.untestable["input_delay"]
    entry = {d["effect"]: d for d in to_json(found)["undetected"]}["coulomb_friction"]
    assert entry["detectable"] is False
    assert entry["parameters"] == {}


@pytest.mark.long
def test_two_springs_cannot_act_together() -> None:
    r = noisy(campaign(100.0, 8.0), seed=3)
    block = prepare(r).block
    stiff = get("mount_compliance")
    soft = Model((stiff,)).force(block.signals, {**TRUTH, stiff.key("s_m"): 2e-4})
    found = diagnose(
        replace(r, force=soft + (r.force - campaign(100.0, 8.0).force)), [stiff], most=1, **SHORT
    )
    assert [f.effect.name for f in found.findings] == [stiff.name]
    injection = Injection(found.problem, found.selection.best)
    assert injection.least(get("fluid_compressibility")).reason == TAKEN


def test_an_effect_at_its_least_is_not_seen_by_the_way_it_is_simulated(healthy: Diagnosis) -> None:
    spring = of(healthy, "mount_compliance")
    assert spring.size is not None
    assert spring.size > 1e3 * amount_of(spring.effect).low


@pytest.mark.long
def test_forecast_of_a_drive_without_force() -> None:
    drive = replace(campaign(100.0, 8.0), force=None)
    with pytest.raises(UsageProblem, match="--params FILE and --noise N"):
        forecast(drive, catalogue())
    damper = Parameters(
        model=Model(),
        estimates={n: Estimate(value=v, unit="") for n, v in TRUTH.items()},
    )
    few = [get(n) for n in FEW]
    ahead = forecast(drive, few, parameters=damper, noise=0.3)
    after = diagnose(noisy(campaign(100.0, 8.0), seed=31), few)
    # By the force: with a play it grows far more slowly than the play, whose size scatters more.
    for d in ahead.effects:
        measured = of(after, d.effect.name).beyond
        assert d.beyond is not None
        assert measured is not None
        assert abs(np.log(d.beyond / measured)) < np.log(2.0), d.effect.name


@pytest.mark.parametrize("least", [0.013, 0.9, 1.0, 1.1, 700.0])
def test_the_least_size_does_not_depend_on_where_it_is_sought_from(least: float) -> None:
    found = [_least(lambda size: size >= least, 1.0, first) for first in (-9, -1, 0, 4, 10)]
    assert len(set(found)) == 1
    size, steps = found[0]
    assert least <= size < 1.06 * least
    assert 2.0 ** (steps - 1) < least <= 2.0**steps


@pytest.mark.parametrize("first", [-9, -1, 10])
def test_what_is_never_seen_and_what_always_is(first: int) -> None:
    assert _least(lambda size: False, 1.0, first) == (np.inf, first)
    assert _least(lambda size: True, 1.0, first) == (0.0, first)

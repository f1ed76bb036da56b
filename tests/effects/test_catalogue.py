"""What every effect must keep to, whatever it is."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from importlib import import_module
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from places import ROOT
from rig import TRUTH, campaign

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import catalogue
from erdctl.io.parameters import parse_parameters, to_document
from erdctl.model.composed import Model, off_values
from erdctl.model.effect import Effect, Stage
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.slots import FeedbackSlot, ScaleSlot, SeriesSlot, SignSlot, TermSlot, ViscousSlot

CONTRACT = {
    Stage.MOTION: "backlash mount_compliance end_stop time_skew",
    Stage.FIELD: (
        "field_threshold field_saturation rise_decay_asymmetry input_delay supply_slew"
        " field_viscosity"
    ),
    Stage.FLUID: (
        "preyield_viscosity yield_hysteresis signed_yield_lag shear_thinning quadratic_damping"
        " fluid_inertia fluid_compressibility cavitation thermal_fade preyield_elasticity"
        " power_law_yield"
    ),
    Stage.FRICTION: "coulomb_friction stribeck_friction presliding_friction",
    Stage.GAS: "gas_preload gas_polytropic gas_thermal_drift",
    Stage.POSITION: "position_dependent_damping",
    Stage.FAULT: "oil_leakage electrical_fault deformation_fault",
    Stage.SENSOR: "force_drift force_smoothing force_offset velocity_noise",
}
STAGE_OF = {name: stage for stage, names in CONTRACT.items() for name in names.split()}
CATALOGUE = catalogue()
every = pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
separable = pytest.mark.parametrize(
    "effect", [e for e in CATALOGUE if Model((e,)).separable], ids=lambda e: e.name
)


Log = Callable[[], Signals]


@cache
def clean() -> Signals:
    """Null control, held levels and control steps, nine records at 200 Hz."""
    return Signals.of(campaign(200.0, 6.0))


@cache
def noisy() -> Signals:
    """The same with noise on the motion: signs flip at reversals, steps are uneven."""
    s, rng = clean(), np.random.default_rng(5)
    n = len(s)
    t = s.t + rng.uniform(-1e-3, 1e-3, n)
    step = np.append(np.diff(t), 0.0)
    step[s.starts[1:] - 1] = 0.0
    x, xdot = s.x + 1e-5 * rng.standard_normal(n), s.xdot + 2e-3 * rng.standard_normal(n)
    return Signals(t=t, x=x, xdot=xdot, duty=s.duty, step=step, starts=s.starts)


def acting(effect: Effect) -> dict[str, float]:
    """Values with the effect on, its shape where this campaign shows it."""
    seen = {"t_0": 2.0, "x_stop": 0.008, "x_r": 0.008}
    return TRUTH | {effect.key(q.symbol): seen.get(q.symbol, q.start) for q in effect.quantities}


def test_the_catalogue_holds_the_contract() -> None:
    found = {e.name: e.stage for e in CATALOGUE}
    assert STAGE_OF.items() <= found.items()


@every
@pytest.mark.parametrize("log", [clean, noisy])
def test_off_is_exact(effect: Effect, log: Log) -> None:
    s = log()
    plain, model = Model(), Model((effect,))
    values = TRUTH | off_values(model)
    assert np.array_equal(model.force(s, values), plain.force(s, TRUTH))
    if model.separable:
        paper = len(plain.linear)
        assert np.array_equal(model.columns(s, values)[:paper], plain.columns(s, TRUTH))


@every
def test_it_acts(effect: Effect) -> None:
    # With noise: of a velocity without any nothing is to be taken away.
    change = Model((effect,)).force(noisy(), acting(effect)) - Model().force(noisy(), TRUTH)
    assert np.sqrt(np.mean(change**2)) > 1e-5


def inside(q: Quantity, part: float) -> float:
    """A value within the bounds; amplitudes, whose bounds mean nothing, near their start."""
    if q.linear:
        return q.start * part
    if q.scale is Scale.LOG:
        return float(np.clip(q.low * (q.high / q.low) ** part, q.low, q.high))
    return q.low + part * (q.high - q.low)


@pytest.mark.untraced
@settings(deadline=None, max_examples=25)
@given(
    parts=st.lists(st.sampled_from([0.0, 1.0]) | st.floats(0.0, 1.0), min_size=6, max_size=6),
    T_d=st.sampled_from([0.0, 1e-3, 0.043, 1.0]),
    log=st.sampled_from([clean, noisy]),
)
@every
def test_finite_and_stable_for_all_parameters(
    effect: Effect, parts: list[float], T_d: float, log: Log
) -> None:
    s = log()
    chosen = {
        effect.key(q.symbol): inside(q, part)
        for q, part in zip(effect.quantities, parts[: len(effect.quantities)], strict=True)
    }
    values = TRUTH | {"compression.T_d": T_d, "release.T_d": T_d}
    force = Model((effect,)).force(s, values | chosen)
    assert np.isfinite(force).all()
    if isinstance(effect.slot, SeriesSlot | FeedbackSlot):
        assert np.abs(force).max() <= 1.5 * np.abs(Model().force(s, values)).max()


@separable
@pytest.mark.parametrize("log", [clean, noisy])
def test_columns_times_amplitudes_is_the_force(effect: Effect, log: Log) -> None:
    s = log()
    model, values = Model((effect,)), acting(effect)
    amplitudes = np.array([values[name] for name in model.linear])
    assert amplitudes @ model.columns(s, values) == pytest.approx(model.force(s, values), abs=1e-9)


@cache
def short() -> Signals:
    """A record each of null control, a held level and control steps: there are many pairs."""
    return Signals.of(campaign(200.0, 6.0).select([0, 4, 8]))


@cache
def alone(effect: Effect) -> Array:
    return Model((effect,)).force(short(), acting(effect))


def force_or_refusal(model: Model, values: dict[str, float]) -> Array | str:
    """The force, or why it cannot be computed."""
    try:
        return model.force(short(), values)
    except IncompatibleEffects as error:
        return str(error)


@pytest.mark.untraced
def test_any_two_act_together_or_are_refused() -> None:
    for pair in combinations(CATALOGUE, 2):
        model = Model(pair)
        values = TRUTH | acting(pair[0]) | acting(pair[1])
        names = [e.name for e in pair]
        force = force_or_refusal(model, values)
        if isinstance(force, str):
            assert re.search("only one|cannot act behind a spring", force), names
            continue
        assert np.isfinite(force).all(), names
        off = TRUTH | acting(pair[0]) | pair[1].off
        assert np.array_equal(model.force(short(), off), alone(pair[0])), names
        if model.separable:
            amplitudes = np.array([values[name] for name in model.linear])
            assert amplitudes @ model.columns(short(), values) == pytest.approx(force, abs=1e-9)


SHAPES = [(e, q) for e in CATALOGUE for q in e.quantities if not q.linear]


@pytest.mark.untraced
@pytest.mark.parametrize(("effect", "q"), SHAPES, ids=[e.key(q.symbol) for e, q in SHAPES])
def test_small_steps_add_up_to_large_ones(effect: Effect, q: Quantity) -> None:
    """The integral of finite differences is the change: no jump hides between them."""
    s, model, values, name = clean(), Model((effect,)), acting(effect), effect.key(q.symbol)
    low = values[name]
    high = low * 1.3 if low * 1.3 <= q.high else low * 0.7

    def force(value: float) -> Array:
        return model.force(s, values | {name: value})

    change = force(high) - force(low)
    points = 60
    total = 0.0
    for value in low + (high - low) * (np.arange(points) + 0.5) / points:
        step = 1e-6 * value
        total += float(np.dot(change, force(value + step) - force(value))) / step
    assert total / points * (high - low) == pytest.approx(float(change @ change), rel=0.05)


@every
def test_records_do_not_see_each_other(effect: Effect) -> None:
    r = campaign(200.0, 6.0)
    model, values = Model((effect,)), acting(effect)
    order = [5, 0, 2, 8]
    apart = [model.force(Signals.of(r.select([i])), values) for i in order]
    assert model.force(Signals.of(r.select(order)), values) == pytest.approx(
        np.concatenate(apart), abs=1e-6
    )


def force_exponent(unit: str) -> int:
    """Power of force in a unit: 1 in N s/m, -1 in m/N and 1/J, 0 in m/s; kg is N s^2/m."""
    above, _, below = unit.partition("/")
    units = r"\b(N|J|W|kg)\b"
    return bool(re.search(units, above)) - bool(re.search(units, below))


@pytest.mark.untraced
@every
@pytest.mark.parametrize("factor", [10.0, 400.0])
def test_a_larger_damper_is_the_same_damper(effect: Effect, factor: float) -> None:
    model, values = Model((effect,)), acting(effect)
    larger = {
        name: value * factor ** force_exponent(model.quantities[name].unit)
        for name, value in values.items()
    }
    for name, value in larger.items():
        assert model.quantities[name].admits(value), name
    force = model.force(clean(), values)
    assert model.force(clean(), larger) == pytest.approx(factor * force, abs=1e-6 * factor)


@every
def test_docstring_says_what_it_is(effect: Effect) -> None:
    text = import_module(f"erdctl.effects.{effect.name}").__doc__ or ""
    assert re.search(r"^    \S.*(=|->)", text, re.M), "no equation"
    for label in ("Check: ", "Source: ", "Valid "):
        assert re.search(rf"^{label}", text, re.M), label
    for q in effect.quantities:
        assert re.search(rf"(?<!\w){re.escape(q.symbol)}(?!\w)", text), q.symbol
        assert f"[{q.unit}]" in text, q.unit


@every
def test_declaration_is_complete(effect: Effect) -> None:
    for text in (effect.title, effect.equation, effect.source, effect.validity):
        assert text.strip()
        assert "\n" not in text
    for q in effect.quantities:
        assert q.admits(q.off), q.symbol
        assert np.isfinite(q.off), q.symbol
        assert q.start != q.off or effect.amplitudes or len(effect.quantities) > 1
    assert effect.of_speed <= isinstance(effect.slot, SignSlot | ViscousSlot | ScaleSlot | TermSlot)


@every
def test_parameter_file_takes_it_on_and_off(effect: Effect) -> None:
    import msgspec

    model = Model((effect,))
    for values in (acting(effect), TRUTH | off_values(model)):
        given = Parameters(
            model=model,
            estimates={
                name: Estimate(value=values[name], unit=q.unit)
                for name, q in model.quantities.items()
            },
        )
        read = parse_parameters(msgspec.json.encode(to_document(given)), "test")
        assert read.values == values


def test_of_speed_is_true() -> None:
    """Such a law gives the same at the same speed, wherever and whenever."""
    rng = np.random.default_rng(2)
    speed = np.abs(clean().xdot[clean().xdot != 0])
    s = Signals(
        np.cumsum(rng.random(len(speed))), rng.random(len(speed)), speed, rng.random(len(speed)),
        np.ones(len(speed)), np.array([0, len(speed)]),
    )  # fmt: skip
    zero = np.zeros(len(speed))
    bare = Signals(zero, zero, speed, zero, zero, s.starts)
    for e in CATALOGUE:
        if e.of_speed:
            p = {q.symbol: q.start for q in e.quantities}
            law: Any = e.added if e.columns is not None else e.slot
            found, plain = law(s, p), law(bare, p)
            if not isinstance(found, dict):
                found, plain = {"": found}, {"": plain}
            assert found.keys() == plain.keys()
            assert all(np.array_equal(found[g], plain[g]) for g in found), e.name


def test_importing_the_catalogue_is_light() -> None:
    code = "from erdctl.effects import catalogue; catalogue(); import sys; print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert not set(run.stdout.split()) & {"scipy", "numba", "pandas", "pint", "msgspec"}

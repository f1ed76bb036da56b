"""Learned laws in every slot, in C against Python."""

from __future__ import annotations

import ctypes
import json
import subprocess
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from c_built import (
    COMPILERS,
    FLOAT,
    SANITIZERS,
    WARNINGS,
    block_of,
    built,
    folder,
    forces,
    record,
    rows_of,
    run,
)  # fmt: skip
from c_motion import random_motion
from msgspec import to_builtins
from rig import TRUTH

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.export.c.source import CBlock, write_c
from erdctl.io.effect_file import effect_source
from erdctl.io.parameters import parse_parameters, to_document
from erdctl.model.composed import Model
from erdctl.model.learned.coordinates import KINDS, Memory, along
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.forms import FORMS
from erdctl.model.learned.law import Law, LawSlot, LearnedEffect
from erdctl.model.learned.surface import Surface
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.slots import MotionSlot, Values

WARM = 25.0
CAUSAL = [slot for slot in LawSlot if slot is not LawSlot.DEFLECTION]
STEADY = [kind for kind, known in KINDS.items() if known.steady]
PAIRS = tuple(zip(FORMS, ["x", "xdot", "duty", "travel", "late_duty", "abs_x", "fresh_x", "t",
                          "since_reversal", "abs_xdot"], strict=True))  # fmt: skip


@cache
def rough() -> Signals:
    s = random_motion()
    return replace(s, temperature=np.full(len(s), WARM))


@cache
def smooth(step: float = 1e-3) -> Signals:
    """Five tones with no rest, on even steps, and a duty that is held."""
    random = np.random.default_rng(3)
    t = np.arange(0.0, 8.0, step)
    x, xdot = np.zeros((2, len(t)))
    for w in random.uniform(3.0, 30.0, 5):
        a, phase = 0.02 / w**0.7, random.uniform(0.0, 6.3)
        x, xdot = x + a * np.sin(w * t + phase), xdot + a * w * np.cos(w * t + phase)
    duty = random.choice([0.0, 0.1, 0.3, 0.45, 0.8], 51)[(t / 0.16).astype(int)]
    warm = np.full(len(t), WARM)
    return Signals(
        t, x, xdot, duty, np.append(np.diff(t), 0.0), np.array([0, len(t)]), temperature=warm
    )


def spanned(kind: str, s: Signals, count: int) -> tuple[float, ...]:
    """Knots over most of what a coordinate spans, so that some of it lies beyond."""
    if kind == "temperature":
        return tuple(np.linspace(WARM - 5.0, WARM + 5.0, count).tolist())
    z = along(kind, s, Memory(0.05))
    low, high = np.quantile(z[np.isfinite(z)], [0.05, 0.95])
    return tuple(np.linspace(low if high > low else 0.0, high, count).tolist())


def curve(kind: str, slot: LawSlot, form: str | None = None) -> Curve:
    knots = spanned(kind, smooth(), 5 if form is None else 2)
    return Curve(kind, knots, form, zero_first=form is None and not slot.adds)


def model_of(slot: LawSlot, curves: Sequence[Curve], size: float) -> tuple[Model, dict[str, float]]:
    """The paper's model with laws, and values: each amplitude up to `size`, of either sign."""
    random, values = np.random.default_rng(7), dict(TRUTH)
    effects = tuple(Law(slot, one).effect for one in curves)
    for effect, one in zip(effects, curves, strict=True):
        values |= {effect.key(q.symbol): q.start for q in one.shape()}
        if one.kind.late:
            values[effect.key("tau")] = 0.05
        for q in one.amplitudes("1"):
            values[effect.key(q.symbol)] = float(size * random.uniform(-1.0, 1.0))
    return Model(effects), values


def size_of(slot: LawSlot) -> float:
    return 30.0 if slot.adds else 0.1


def off_by(model: Model, values: dict[str, float], s: Signals, *options: str) -> Array:
    """(n,) difference over the range of the force."""
    expected = model.force(s, values)
    assert np.abs(expected - Model().force(s, TRUTH)).max() > 1e-3 * np.ptp(expected)
    return np.abs(forces(block_of(model, values), s, *options) - expected) / np.ptp(expected)


@pytest.mark.few(14)
@pytest.mark.parametrize("slot", CAUSAL)
@pytest.mark.parametrize("what", ["splines", "forms", "surfaces"])
def test_every_law_is_the_same_in_c(slot: LawSlot, what: str) -> None:
    curves = {
        "splines": lambda: [curve(kind, slot) for kind in KINDS if kind != "passes"],
        "forms": lambda: [curve(kind, slot, form) for form, kind in PAIRS],
        "surfaces": lambda: [surface("x", "duty", slot), surface("late_duty", "direction", slot),
                             surface("fresh_x", "since_reversal", slot)],
    }[what]()  # fmt: skip
    model, values = model_of(slot, curves, size_of(slot))
    assert off_by(model, values, rough()).max() < 1e-12
    assert off_by(model, values, rough(), FLOAT).max() < 1e-5


def surface(first: str, second: str, slot: LawSlot) -> Surface:
    ends = (-1.0, 1.0) if second == "direction" else spanned(second, smooth(), 3)
    across = Curve(second, ends)
    return Surface(first, spanned(first, smooth(), 4), zero_first=not slot.adds, across=across)


@pytest.mark.parametrize("slot", LawSlot)
def test_without_size_it_is_absent_bit_for_bit(slot: LawSlot) -> None:
    model, values = model_of(slot, [curve("x", slot), surface("travel", "duty", slot)], 0.0)
    found = forces(block_of(model, values), rough())
    assert np.array_equal(found, forces(block_of(Model(), TRUTH), rough()))


@pytest.mark.parametrize("kind", KINDS)
def test_a_deflection_has_the_slope_that_is_known_at_the_sample(kind: str) -> None:
    """No sample ahead is known, so it is not the same; a hard sign tells where the piston turns."""
    model, values = model_of(LawSlot.DEFLECTION, [curve(kind, LawSlot.DEFLECTION)], 1e-3)
    if kind == "temperature":  # held, so it moves nothing
        assert np.isfinite(forces(block_of(model, values), rough())).all()
        return
    expected = model.force(smooth(), values)
    off = np.abs(forces(block_of(model, values), smooth()) - expected) / np.ptp(expected)
    usual = np.quantile(off, 0.9)
    assert usual < (1e-4 if kind in STEADY else 0.3 if kind == "passes" else 3e-3)
    if kind in ("x", "abs_x"):  # of second order
        halved = np.abs(
            forces(block_of(model, values), smooth(5e-4)) - model.force(smooth(5e-4), values)
        )
        assert np.quantile(halved / np.ptp(expected), 0.9) < 0.3 * usual


def causal(effect: LearnedEffect) -> LearnedEffect:
    """A deflection in Python with the slope that C has."""
    law, kind = effect.law, effect.law.curve.coordinate

    def motion(s: Signals, p: Values) -> Signals:
        out = [s.x.copy(), s.xdot.copy()]
        for a, b in pairwise(s.starts.tolist()):
            one = record(s, a, b)
            h = np.append(1e-3, one.step[:-1])
            z = along(kind, one, Memory.of(p))
            speed = np.abs(one.xdot)
            steps = {"x": one.xdot, "abs_x": np.where(one.x < 0, -one.xdot, one.xdot),
                     "duty": 0.0, "t": 1.0, "travel": speed, "field_travel": speed * one.duty,
                     "flow_work": speed**2, "path_since_reversal": speed}  # fmt: skip
            if kind in steps:
                dz = steps[kind] * h
            elif kind == "late_xdot2":
                dz = np.minimum(h / p["tau"], 1.0) * (one.xdot**2 - z)
            else:
                dz = np.diff(z, prepend=z[0])
            sizes = np.array([p[q.symbol] for q in law.curve.amplitudes("m")])
            low, mid, high = (sizes @ law.curve.at(z + k * dz, p) for k in (-1, 0, 1))
            out[0][a:b] += mid
            out[1][a:b] += (high - low) / (2 * h)
        return s.with_motion(*out, s.engaged)

    return replace(effect, slot=MotionSlot(motion))


@pytest.mark.parametrize(
    "kind",
    ["x", "abs_x", "duty", "t", "travel", "field_travel", "flow_work", "path_since_reversal",
     "late_xdot2", "xdot", "largest_x", "ringing_xdot"],
)  # fmt: skip
def test_a_deflection_equals_python_that_knows_the_past_alone(kind: str) -> None:
    model, values = model_of(LawSlot.DEFLECTION, [curve(kind, LawSlot.DEFLECTION)], 1e-3)
    (effect,) = model.effects
    assert isinstance(effect, LearnedEffect)
    expected = Model((causal(effect),)).force(rough(), values)
    off = np.abs(forces(block_of(model, values), rough()) - expected)
    assert off.max() < 1e-9 * np.ptp(expected)


@pytest.mark.parametrize(
    "name",
    ["backlash", "mount_compliance", "fluid_compressibility", "preyield_viscosity", "thermal_fade",
     "signed_yield_lag", "gas_polytropic", "input_delay", "supply_slew"],
)  # fmt: skip
def test_laws_act_with_the_catalogue(name: str) -> None:
    """All slots at once, before and behind what else there is."""
    other, effects, values = get(name), [], dict(TRUTH)
    for slot, kind in zip(LawSlot, ("x", "travel", "largest_x", "t", "abs_x", "late_xdot2",
                                    "since_reversal", "fresh_duty", "x"), strict=True):  # fmt: skip
        size = 1e-3 if slot is LawSlot.DEFLECTION else size_of(slot)
        model, own = model_of(slot, [curve(kind, slot)], size)
        effects += model.effects
        values |= own
    values |= {other.key(q.symbol): q.start for q in other.quantities}
    in_python = [causal(e) if e.name.startswith("learned_deflection") else e for e in effects]
    s = rough()
    expected = Model((other.past_alone(), *in_python)).force(s, values)
    found = forces(block_of(Model((other, *effects)), values, s), s)
    assert np.abs(found - expected).max() < 1e-9 * np.ptp(expected)


@pytest.mark.few(1)
@pytest.mark.parametrize("slot", [LawSlot.FORCE, LawSlot.DUTY, LawSlot.DEFLECTION])
def test_it_stays_clean_with_bad_input_under_sanitizers(slot: LawSlot, tmp_path: Path) -> None:
    curves = [curve(kind, slot) for kind in KINDS]
    curves += [curve(kind, slot, form) for form, kind in PAIRS]
    model, values = model_of(slot, [*curves, surface("x", "duty", slot)], 1e-4)
    block = block_of(model, values)
    rows = rows_of(rough())[:1500].copy()
    random = np.random.default_rng(1)
    bad = (random.integers(0, len(rows), 300), random.integers(0, 4, 300))
    rows[bad] = random.choice([np.nan, np.inf, -np.inf, 0.0, -1.0, 1e5, 1e300], 300)
    file = tmp_path / "rows"
    begin = np.array([0.0, 1.0, -1.0])
    given = np.array([m.value for m in block.parameters])
    file.write_bytes(
        np.array([len(given), len(rows)]).tobytes() + given.tobytes() + begin.tobytes()
        + np.ascontiguousarray(rows).tobytes()
    )  # fmt: skip
    program = built(block, *SANITIZERS, main=True)
    done = subprocess.run([program, file], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    force = np.array([float(line.split()[0]) for line in done.stdout.splitlines()])
    assert len(force) == len(rows)
    assert np.isfinite(force).all()


@pytest.mark.skipif("clang" not in COMPILERS, reason="no clang on this machine")
@pytest.mark.parametrize("options", [(), (FLOAT,)])
def test_clang_has_nothing_to_say(options: tuple[str, ...]) -> None:
    for slot in (LawSlot.FORCE, LawSlot.DUTY, LawSlot.DEFLECTION):
        curves = [curve(kind, slot) for kind in KINDS]
        curves += [curve(kind, slot, form) for form, kind in PAIRS]
        model, values = model_of(slot, [*curves, surface("x", "duty", slot)], 1e-3)
        assert built(block_of(model, values), *options, compiler="clang", optimised="-O0").exists()


TELLS = """
#include "damper.h"
void tell(long n, const double *stroke, const double *warm, const double *rows, double *force);
void tell(long n, const double *stroke, const double *warm, const double *rows, double *force)
{
    damper_params p;
    damper_state s;
    long i;

    damper_defaults(&p);
    damper_init(&s, &p);
    damper_stroke(&s, stroke[0], stroke[1]);
    for (i = 0; i < n; i++, rows += 7) {
        if (warm[i] < 1e6) damper_temperature(&s, warm[i]);
        if (i % 7 == 3) damper_temperature(&s, warm[i] - warm[i] + 0.0 / (warm[i] - warm[i]));
        force[i] = damper_step(&s, rows[0], rows[1], rows[2], rows[3]);
    }
}
"""


def told(block: CBlock, s: Signals, stroke: tuple[float, float], warm: Array) -> Array:
    """(n,) force of a block that is told its stroke, and the temperature where it is known."""
    here = folder() / "told"
    here.mkdir(exist_ok=True)
    texts = {"damper.h": block.header, "damper.c": block.source, "tell.c": TELLS}
    for name, text in texts.items():
        (here / name).write_text(text)
    subprocess.run(
        ["gcc", *WARNINGS, "-shared", "-fPIC", "-o", "tell.so", "damper.c", "tell.c", "-lm"],
        cwd=here, check=True,
    )  # fmt: skip
    out = np.empty(len(s))
    arrays = [np.array(stroke), warm, np.ascontiguousarray(rows_of(s)), out]
    ctypes.CDLL(str(here / "tell.so")).tell(
        ctypes.c_long(len(s)), *(a.ctypes.data_as(ctypes.c_void_p) for a in arrays)
    )
    return out


def test_a_program_tells_stroke_and_temperature() -> None:
    curves = [curve("passes", LawSlot.FORCE), curve("temperature", LawSlot.FORCE),
              surface("temperature", "passes", LawSlot.FORCE)]  # fmt: skip
    model, values = model_of(LawSlot.FORCE, curves, 30.0)
    s = smooth()
    warm = 20.0 + 12.0 * np.sin(0.9 * s.t)
    warm[: len(s) // 3] = WARM  # the middle of the range, which holds before
    heard = np.where(np.arange(len(s)) < len(s) // 3, np.inf, warm)
    block = block_of(model, values)
    assert "void damper_temperature(" in block.header
    assert block.header.count("damper_stroke(") == 1
    expected = model.force(replace(s, temperature=warm), values)
    found = told(block, s, (float(s.x.min()), float(s.x.max())), heard)
    assert np.abs(found - expected).max() < 1e-9 * np.ptp(expected)


def test_passes_without_a_stroke_are_those_over_spots_that_grow() -> None:
    law = Law(LawSlot.FORCE, Curve("passes", (0.0, 30.0), "line")).effect
    model, s = Model((law,)), smooth()
    values = {**TRUTH, law.key("a"): 30.0}
    block = block_of(model, values)
    off = np.abs(forces(block, s) - model.force(s, values))
    assert off.mean() < 1.0  # N, 1 a pass
    assert "passes are counted over parts of the stroke so far" in block.source


def test_parameters_may_be_changed_while_it_runs() -> None:
    """Sizes and time constants are members of the struct, not of the tables."""
    model, values = model_of(LawSlot.GAS, [curve("late_duty", LawSlot.GAS)], 0.4)
    other = {n: v * 1.3 if n.startswith("learned") else v for n, v in values.items()}
    block = block_of(model, values)
    changed = {m.path: other[m.path] for m in block.parameters if m.path in other}
    assert changed
    s = smooth()
    found = run(block, rows_of(s), changed=changed).force
    expected = model.force(s, other)
    assert np.abs(found - expected).max() < 1e-12 * np.ptp(expected)


def test_single_precision_holds_over_a_long_run() -> None:
    """Half an hour at 1 kHz: a plain sum of steps would be off by far more."""
    kinds = ["travel", "t", "flow_work", "field_travel"]
    n, step = 1_800_000, 1e-3
    t = step * np.arange(n)
    x, xdot = 0.01 * np.sin(20.0 * t), 0.2 * np.cos(20.0 * t)
    duty = np.where(t % 2.0 < 1.0, 0.25, 0.75)
    s = Signals(t, x, xdot, duty, np.append(np.diff(t), 0.0), np.array([0, n]))
    ends = [along(kind, s, None)[-1] for kind in kinds]
    curves = [Curve(k, (0.0, float(e)), "line") for k, e in zip(kinds, ends, strict=True)]
    model, values = model_of(LawSlot.FORCE, curves, 100.0)
    expected = model.force(s, values)
    found = forces(block_of(model, values), s, FLOAT)
    assert np.abs(found - expected).max() < 1e-5 * np.ptp(expected)


def test_a_law_of_a_parameter_file_is_exported() -> None:
    model, values = model_of(LawSlot.YIELD, [curve("largest_x", LawSlot.YIELD)], 0.2)
    estimates = {n: Estimate(value=values[n], unit=q.unit) for n, q in model.quantities.items()}
    sent = to_document(Parameters(model=model, estimates=estimates))
    arrived = parse_parameters(json.dumps(to_builtins(sent)).encode(), "laws.json")
    block = write_c(arrived, prefix="damper")
    assert block.source == block_of(model, values).source


def test_an_effect_written_from_a_learned_law_has_the_same_c() -> None:
    for slot in (LawSlot.GAS, LawSlot.FORCE, LawSlot.DEFLECTION):
        model, values = model_of(slot, [curve("late_duty", slot)], 1e-3)
        (found,) = model.effects
        assert isinstance(found, LearnedEffect)
        namespace: dict[str, Any] = {"__name__": "of_lab"}
        exec(effect_source("of_lab", found, values, "a log"), namespace)
        written = namespace["EFFECT"].with_c()
        assert written.c == found.with_c().c
        own = {written.key(q.symbol): values[found.key(q.symbol)] for q in written.quantities}
        s, again = smooth(), block_of(Model((written,)), {**TRUTH, **own})
        assert np.array_equal(forces(again, s), forces(block_of(model, values), s))

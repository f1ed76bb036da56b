"""Random corrected models in C against Python, under sanitizers, and two blocks in one program."""

from __future__ import annotations

import struct
import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from c_built import COMPILERS, FLOAT, SANITIZERS, WARNINGS, block_of, built, forces, rows_of, run
from c_motion import bench, random_motion, record
from places import FIXTURES

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.quantity import Quantity, Scale
from erdctl.core.signals import Signals
from erdctl.effects import catalogue, get
from erdctl.export.c.source import on_the_vehicle
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

PAPER = read_parameters(str(FIXTURES / "table_2.json")).values
ON_CAR, _ = on_the_vehicle(catalogue())
MODELS = 50


def drawn(q: Quantity, rng: np.random.Generator) -> float:
    """A value about the start, within the bounds."""
    seen = {"t_0": 2.0, "x_stop": 0.008, "x_r": 0.008}
    start = seen.get(q.symbol, q.start)
    if q.scale is Scale.LOG or q.linear:
        return float(np.clip(start * 10.0 ** rng.uniform(-0.5, 0.5), q.low, q.high))
    return float(np.clip(start + rng.uniform(-0.3, 0.3) * (abs(start) or 1.0), q.low, q.high))


@cache
def model(seed: int) -> tuple[Model, dict[str, float]]:
    """Two or three effects that go together, and values."""
    rng = np.random.default_rng(1000 + seed)
    while True:
        chosen = rng.choice(len(ON_CAR), rng.integers(2, 4), replace=False)
        found = Model(tuple(ON_CAR[i] for i in chosen))
        values = {
            name: value * 10.0 ** rng.uniform(-0.2, 0.2) if value else value
            for name, value in PAPER.items()
        }
        for effect in found.effects:
            values |= {effect.key(q.symbol): drawn(q, rng) for q in effect.quantities}
        try:
            found.force(moment(), values)
        except IncompatibleEffects:
            continue
        return found, values


def moment() -> Signals:
    return record(random_motion(), 0, 5)


@pytest.mark.few(50)
@pytest.mark.parametrize("seed", range(MODELS))
@pytest.mark.parametrize(("options", "near"), [((), 1e-9), ((FLOAT,), 1e-5)], ids=["", "float"])
def test_it_equals_python(seed: int, options: tuple[str, ...], near: float) -> None:
    found, values = model(seed)
    s = record(bench(), *bench().starts[seed % 3 : seed % 3 + 2].tolist())
    s = random_motion() if seed % 2 else s
    expected = found.past_alone().force(s, values)
    off = np.abs(forces(block_of(found, values, s), s, *options) - expected)
    assert off.max() <= near * np.ptp(expected), [e.name for e in found.effects]


@pytest.mark.parametrize("s_m", [1e-8, 1e-6, 1e-4])
def test_play_in_the_joint_of_a_stiff_mount_equals_python(s_m: float) -> None:
    """There the spring bends between two nodes of the speed."""
    found = Model((get("backlash"), get("mount_compliance")))
    s = random_motion()
    values = PAPER | {"backlash.g": 2e-3, "mount_compliance.s_m": s_m}
    expected = found.past_alone().force(s, values)
    off = np.abs(forces(block_of(found, values, s), s) - expected)
    assert off.max() <= 1e-9 * np.ptp(expected)


@pytest.mark.parametrize("v_s", [0.02, 0.3])
def test_a_piston_that_slips_equals_python(v_s: float) -> None:
    """Its speed passes the end of the table, beyond which friction goes on as it is."""
    found = Model((get("mount_compliance"), get("stribeck_friction")))
    s = random_motion()
    own = {"F_k": 5.0, "F_sk": 60.0, "v_s": v_s}
    values = PAPER | {f"stribeck_friction.{symbol}": v for symbol, v in own.items()}
    values |= {"mount_compliance.s_m": 1e-6, "compression.c_vis": 5.0, "release.c_vis": 5.0}
    expected = found.past_alone().force(s, values)
    off = np.abs(forces(block_of(found, values, s), s) - expected)
    assert off.max() <= 1e-9 * np.ptp(expected)


def packed() -> list[Model]:
    """All effects in as few models as hold those that go together: each costs a compiler's run."""
    groups: list[tuple[Effect, ...]] = []
    for effect in ON_CAR:
        for i, group in enumerate(groups):
            if goes(Model((*group, effect))):
                groups[i] = (*group, effect)
                break
        else:
            groups.append((effect,))
    return [Model(group) for group in groups]


def goes(found: Model) -> bool:
    try:
        found.force(moment(), at_start(found))
    except IncompatibleEffects:
        return False
    return True


def at_start(found: Model) -> dict[str, float]:
    return PAPER | {name: q.start for name, q in found.quantities.items() if name not in PAPER}


all_effects = pytest.mark.parametrize(
    "found", packed(), ids=lambda m: f"{len(m.effects)}_with_{m.effects[0].name}"
)
both = pytest.mark.parametrize("options", [(), (FLOAT,)], ids=["", "float"])


@pytest.mark.parametrize("compiler", COMPILERS)
@both
@all_effects
def test_no_warnings(found: Model, compiler: str, options: tuple[str, ...]) -> None:
    built(block_of(found, at_start(found)), *options, compiler=compiler, optimised="-O2")


HOSTILE = (float("nan"), float("inf"), float("-inf"), 0.0, -1.0, 1e300, -1e300, 1e-300, 1e5, 0.02)


def hostile(seed: int, n: int = 1500) -> np.ndarray:
    """Rows of an ordinary motion, with what no controller should send."""
    rng = np.random.default_rng(seed)
    rows = rows_of(record(random_motion(), 0, n))
    bad = rng.random((n, 7)) < 0.05
    rows[bad] = rng.choice(HOSTILE, bad.sum())
    rows[n // 2 : n // 2 + n // 8, 1:] = rows[n // 2, 1:]  # stuck
    return rows


@pytest.mark.few(4)
@pytest.mark.parametrize("seed", range(0, MODELS, 10))
@both
def test_sanitizers_find_nothing_whatever_comes_in(seed: int, options: tuple[str, ...]) -> None:
    found, values = model(seed)
    s = random_motion()
    program = built(block_of(found, values, s), *options, *SANITIZERS, main=True)
    block = block_of(found, values, s)
    rows = hostile(seed)
    data = program.parent / "rows.bin"
    given = np.array([m.value for m in block.parameters])
    data.write_bytes(
        struct.pack("ll", len(given), len(rows)) + given.tobytes()
        + np.array([0.0, 1.0, -1.0]).tobytes() + rows.tobytes()
    )  # fmt: skip
    done = subprocess.run([str(program), str(data)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    force, status = np.loadtxt(done.stdout.splitlines()).T
    assert np.isfinite(force).all()
    usable = np.isfinite(rows[:, :4]).all(axis=1) & (np.abs(rows[:, :4]) <= 1e6).all(axis=1)
    assert (status[1:][~usable[1:]].astype(int) & 3 > 0).all()


@both
@all_effects
def test_no_effect_lets_nan_out(found: Model, options: tuple[str, ...]) -> None:
    block = block_of(found, at_start(found), random_motion())
    for seed in range(3):
        assert np.isfinite(run(block, hostile(seed), *options).force).all()
    for member in block.parameters:
        broken = {member.path: float("nan")}
        assert np.isfinite(run(block, hostile(4, 200), *options, changed=broken).force).all()


TWO = """
#include "front.h"
#include "rear.h"
#include <string.h>

int main(void)
{
    front_params f;
    rear_params r;
    static front_state a, b, kept;
    static rear_state c;
    int i;

    front_defaults(&f);
    rear_defaults(&r);
    front_init(&a, &f);
    rear_init(&c, &r);
    for (i = 0; i < 100; i++) {
        front_step(&a, 0.001, 0.0001 * i, 0.1, 0.3);
        rear_step(&c, 0.001, 0.0001 * i, 0.1, 0.3);
    }
    memcpy(&kept, &a, sizeof a);
    for (i = 0; i < 100; i++)
        front_step(&a, 0.001, 0.01 - 0.0001 * i, -0.1, 0.1);
    memcpy(&b, &kept, sizeof b);
    for (i = 0; i < 100; i++)
        front_step(&b, 0.001, 0.01 - 0.0001 * i, -0.1, 0.1);
    return memcmp(&a, &b, sizeof a) != 0;
}
"""


@pytest.mark.parametrize("compiler", COMPILERS)
def test_two_dampers_link_and_a_copied_state_goes_on_alike(compiler: str, tmp_path: Path) -> None:
    for prefix, seed in (("front", 3), ("rear", 7)):
        block = block_of(*model(seed), prefix=prefix)
        (tmp_path / f"{prefix}.h").write_text(block.header)
        (tmp_path / f"{prefix}.c").write_text(block.source)
    (tmp_path / "main.c").write_text(TWO)
    subprocess.run(
        [compiler, *WARNINGS, "front.c", "rear.c", "main.c", "-o", "two", "-lm"],
        cwd=tmp_path, check=True,
    )  # fmt: skip
    subprocess.run([str(tmp_path / "two")], check=True)


# What meets in a spring: free play in its joint, factors from the forces, forces from those, laws
# of speed; and what depends on the duty ahead where the fluid follows at once.
TOGETHER = {
    "mount": "mount_compliance backlash thermal_fade gas_thermal_drift stribeck_friction"
    " preyield_viscosity shear_thinning power_law_yield gas_polytropic cavitation input_delay",
    "fluid": "fluid_compressibility backlash thermal_fade gas_thermal_drift coulomb_friction"
    " preyield_viscosity rise_decay_asymmetry supply_slew field_saturation presliding_friction",
    "loop behind a mount": "mount_compliance yield_hysteresis signed_yield_lag presliding_friction"
    " coulomb_friction gas_preload end_stop backlash thermal_fade fluid_inertia",
    "stretch behind a mount": "mount_compliance preyield_field_dependence preyield_elasticity"
    " coulomb_friction gas_polytropic quadratic_damping field_saturation",
    "damped mount": "damped_backlash backlash fluid_inertia yield_hysteresis stribeck_friction"
    " presliding_friction gas_polytropic thermal_fade",
    "loop of the fluid": "fluid_compressibility yield_hysteresis signed_yield_lag gas_polytropic",
    "no spring": "backlash thermal_fade gas_thermal_drift yield_hysteresis signed_yield_lag"
    " preyield_elasticity shear_thinning field_viscosity field_threshold supply_slew input_delay"
    " rise_decay_asymmetry end_stop quadratic_damping oil_leakage electrical_fault",
}


@pytest.mark.few(14)
@pytest.mark.parametrize("names", TOGETHER.values(), ids=TOGETHER)
@pytest.mark.parametrize("T_d", [None, 0.0])
@pytest.mark.parametrize(("options", "near"), [((), 1e-9), ((FLOAT,), 1e-5)], ids=["", "float"])
def test_many_at_once_equal_python(
    names: str, T_d: float | None, options: tuple[str, ...], near: float
) -> None:
    found, s = Model(tuple(get(name) for name in names.split())), even(random_motion())
    rng = np.random.default_rng(2)
    values = dict(PAPER)
    if T_d is not None:
        values |= {"compression.T_d": T_d, "release.T_d": T_d}
    for effect in found.effects:
        values |= {effect.key(q.symbol): drawn(q, rng) for q in effect.quantities}
    expected = found.past_alone().force(s, values)
    off = np.abs(forces(block_of(found, values, s), s, *options) - expected)
    assert off.max() <= near * np.ptp(expected)


def even(s: Signals) -> Signals:
    """The same with even steps: C takes the step ahead to be as long as the last."""
    n, step = len(s), 0.002
    steps = np.full(n, step)
    steps[s.starts[1:] - 1] = 0.0
    return replace(s, t=step * np.arange(n), step=steps)


@pytest.mark.parametrize("effect", ON_CAR, ids=lambda e: e.name)
def test_without_a_lag_it_equals_python(effect: Effect) -> None:
    found, s = Model((effect,)), even(random_motion())
    none = [effect.key(q.symbol) for q in effect.quantities if q.symbol == "T_v"]
    values = at_start(found) | dict.fromkeys(["compression.T_d", "release.T_d", *none], 0.0)
    expected = found.past_alone().force(s, values)
    off = np.abs(forces(block_of(found, values, s), s) - expected)
    # At the end of a record Python has no step ahead to take a mean over.
    inner = np.ones(len(s), dtype=bool)
    inner[s.starts[1:] - 1] = False
    assert off[inner].max() <= 1e-9 * np.ptp(expected)

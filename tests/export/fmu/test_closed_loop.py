"""The closed loop of the tutorial, shorter: a quarter car on a road, with the exported FMUs."""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
from fmu_built import built, damper, table_2
from places import FIXTURES

from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.emulator.source import write_emulator
from erdctl.export.fmu.emulator import emulator_block
from erdctl.model.amplifier import Amplifier
from erdctl.model.faults import FaultKind

ONSET, SECONDS = 1.0, 2.5
RATE = 200.0  # Hz, as in the tutorial


@cache
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("closed_loop", FIXTURES / "closed_loop.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclass looks there
    spec.loader.exec_module(module)
    module.ONSET = ONSET
    return module


@cache
def emulator() -> Path:
    limits = EmulatorLimits(amplifier=Amplifier(update_rate=RATE))
    faults = (FaultKind.OIL, FaultKind.ELECTRICAL)
    c = write_emulator(table_2(), prefix="online", faults=faults, limits=limits)
    return built(emulator_block(c, table_2()), "2")


def test_the_emulated_force_is_that_of_the_faulty_damper(tmp_path: Path) -> None:
    loop, fmu = script(), str(damper("2"))
    healthy = loop.drive(SECONDS, fmu)
    ideal = loop.drive(SECONDS, fmu, faulty=True)
    emulated = loop.drive(SECONDS, fmu, emulator=str(emulator()))

    near = loop.nrmse(emulated.force, ideal.force)
    assert near < 0.06
    assert near < loop.nrmse(healthy.force, ideal.force) / 2.5
    # The car, too, moves as with the faulty damper.
    acts = slice(round(ONSET / loop.STEP), None)
    moved, wanted = (run.body[acts] - ideal.body[acts] for run in (emulated, healthy))
    assert np.std(moved) < 0.5 * np.std(wanted)

    assert emulated.duty.min() >= 0.0
    assert emulated.duty.max() <= 0.45
    changes = np.flatnonzero(np.diff(emulated.duty))
    assert len(changes) > 10
    assert np.diff(changes).min() >= round(1.0 / RATE / loop.STEP)

    loop.picture(str(tmp_path / "loop.png"), healthy, ideal, emulated)
    assert 10_000 < (tmp_path / "loop.png").stat().st_size < 120_000


def test_before_the_fault_all_drives_are_alike() -> None:
    """But for the duty, which the emulator gives on at its own rate."""
    loop, fmu = script(), str(damper("2"))
    healthy = loop.drive(1.0, fmu)
    assert np.array_equal(healthy.force, loop.drive(1.0, fmu, faulty=True).force)
    driven = loop.drive(1.0, fmu, emulator=str(emulator()))
    # Not of the force: where the damper stands still on its yield force, it jumps in both.
    assert np.std(driven.body - healthy.body) < 0.03 * np.std(healthy.body)
    assert not driven.beyond.any()

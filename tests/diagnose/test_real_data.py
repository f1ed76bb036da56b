"""Real recordings: effects are named on some records, and predict records left out of the fit.

Errors over the range and over the standard deviation of the force: a small figure over the range
can hide a poor fit.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pyarrow.parquet as pq
import pytest
from bench import real
from places import SHARED

from erdctl import effects
from erdctl.blocks import thinned
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.trial import Trial
from erdctl.recording import Recording
from erdctl.score import Normalise, nrmse
from erdctl.signals import Signals

MOST = 20_000  # samples of a log for a diagnosis; the prediction is of all samples
FIRST_CYCLES = 2.0  # s; with those, where the play stood as a record began no longer matters


@cache
def load(name: str) -> Recording:
    table = pq.read_table(real(name, SHARED))
    names = table["record"].to_pylist()
    at = [i for i in range(len(names)) if i == 0 or names[i] != names[i - 1]]
    columns = {c: table[c].to_numpy() for c in ("t", "x", "xdot", "force")}
    has_duty = "duty" in table.column_names
    return Recording(
        **columns,
        duty=table["duty"].to_numpy() if has_duty else np.zeros(len(names)),
        starts=np.array([*at, len(names)], dtype=np.intp),
        names=tuple(names[i] for i in at),
    )


def split(name: str, text: str) -> tuple[Recording, Recording]:
    """Records without and with a text in their names."""
    r = load(name)
    held = [i for i, record in enumerate(r.names) if text in record]
    return r.select([i for i in range(len(r.names)) if i not in held]), r.select(held)


@cache
def diagnosis(name: str, text: str) -> Diagnosis:
    """What is found on the records without a text in their names."""
    return diagnose(thinned(split(name, text)[0], MOST), effects.catalogue())


def errors(what: str, trial: Trial, r: Recording, after: float = 0.0) -> tuple[float, float]:
    """NRMSE over the range and over the standard deviation, from a time in each record on."""
    begin = np.repeat(r.t[r.starts[:-1]], np.diff(r.starts))
    use = r.t - begin >= after
    assert r.force is not None
    force, model = r.force[use], trial.model.force(Signals.of(r), trial.values)[use]
    found = [nrmse(force, model, n).nrmse for n in (Normalise.RANGE, Normalise.STD)]
    print(f"{what}, from {after:g} s on: {found[0]:.4f} of the range, {found[1]:.3f} of the std")
    return found[0], found[1]


def named(found: Diagnosis) -> set[str]:
    out = set()
    for f in found.findings:
        print(f.effect.name, f.equivalent, f.gain)
        out |= {f.effect.name, *f.equivalent}
    print(found.verdict, {n: float(f"{v:.4g}") for n, v in found.choice.best.values.items()})
    return out


def held_out(found: Diagnosis, held: Recording, after: float = 0.0) -> tuple[float, float]:
    """NRMSE over the range of the paper's model and of the corrected one."""
    paper, _ = errors("paper's model", found.choice.base, held, after)
    corrected, _ = errors("corrected", found.choice.best, held, after)
    return paper, corrected


def test_magnetorheological_damper() -> None:
    """A smooth sign law with a lag or a spring, from a large stroke to a small and faster one."""
    found = diagnosis("mr_sine.parquet", "5mm_3Hz")
    assert named(found) & {"preyield_viscosity", "yield_hysteresis"}
    paper, corrected = held_out(found, split("mr_sine.parquet", "5mm_3Hz")[1])
    assert paper > 0.075
    assert corrected < 0.068


@pytest.mark.parametrize(
    ("inches", "whole", "settled"), [("0.5", 0.105, 0.053), ("1.5", 0.088, 0.070)]
)
def test_friction_damper_with_backlash(inches: str, whole: float, settled: float) -> None:
    """The laboratory reports the play; the records of one amplitude are left out.

    They begin within the play, where no log says on which side it closes first.
    """
    text = f"tension{inches}amplitude"
    found, held = diagnosis("friction_sine.parquet", text), split("friction_sine.parquet", text)[1]
    assert {"backlash", "mount_compliance"} <= named(found)
    assert 0.0035 < found.choice.best.values["backlash.g"] < 0.005
    for after, reached in ((0.0, whole), (FIRST_CYCLES, settled)):
        paper, corrected = held_out(found, held, after)
        assert paper > 0.19
        assert corrected < reached

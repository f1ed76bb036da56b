"""Gains and zeros that scatter from record to record are carried, not named."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl import plant
from erdctl.core.recording import Recording
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.record_effects import RecordEffects, Varying, estimate, shrunk
from erdctl.effects import get
from erdctl.io import documents
from erdctl.io.diagnosis import to_json

FEW = ("coulomb_friction", "quadratic_damping", "preyield_viscosity", "position_dependent_damping")
SEED, EFFECT, LEVEL = 28, "quadratic_damping", 3.0  # a short campaign; misfit over noise
GAINS = Varying(gain=True)


def recording(case: plant.Case) -> Recording:
    table = plant.log(case)
    names = table["record"].to_pylist()
    at = [i for i in range(len(names)) if i == 0 or names[i] != names[i - 1]]
    columns = {c: table[c].to_numpy() for c in ("t", "x", "xdot", "duty", "force")}
    return Recording(
        **columns, starts=np.array([*at, len(names)], dtype=np.intp),
        names=tuple(names[i] for i in at),
    )  # fmt: skip


@cache
def concealed(effect: str | None) -> plant.Case:
    wish = {"kind": "null"} if effect is None else {"effects": [effect], "level": LEVEL}
    return plant.draw(SEED, scatter=True, motion="exact", **wish)


@cache
def diagnosed(effect: str | None, free: Varying) -> Diagnosis:
    log, few = recording(concealed(effect)), [get(n) for n in FEW]
    return diagnose(log, few, free=free, limits=False, learning=False)


def true_gains(case: plant.Case) -> np.ndarray:
    gains = np.array(case.gains)
    return gains / gains.mean()


@pytest.mark.long
def test_scatter_is_a_mismatch_unless_it_is_carried() -> None:
    """What the option is for: without it the scatter is a misfit that no effect explains."""
    assert diagnosed(None, Varying()).verdict is Verdict.UNEXPLAINED
    assert diagnosed(None, GAINS).verdict is Verdict.ADEQUATE
    assert diagnosed(None, Varying(gain=True, offset=True)).verdict is Verdict.ADEQUATE


@pytest.mark.parametrize("effect", [None, pytest.param(EFFECT, marks=pytest.mark.long)])
def test_gains_come_out_within_their_errors(effect: str | None) -> None:
    found = diagnosed(effect, GAINS).record_effects
    assert found is not None
    off = found.gain - true_gains(concealed(effect))
    print(off / found.gain_error)
    assert found.gain.mean() == pytest.approx(1.0)
    assert np.abs(off).max() < 0.004
    assert np.abs(off / found.gain_error).max() < 4.0
    assert np.median(found.gain_error) < 0.003


def test_an_effect_keeps_its_name() -> None:
    found = diagnosed(EFFECT, GAINS)
    assert found.verdict is Verdict.EXPLAINED
    assert [f.effect.name for f in found.findings] == [EFFECT]


@pytest.mark.long
def test_the_document_tells_shared_from_per_record() -> None:
    found = diagnosed(EFFECT, Varying(gain=True, offset=True))
    document = to_json(found)
    names = [r["name"] for r in document["records"]]
    assert names == list(found.problem.recording.names)
    first = document["records"][0]
    assert first["gain"]["unit"] == "1"
    assert first["offset"]["unit"] == "N"
    assert first["gain"]["stderr"] > 0
    # The corrected parameters are the shared ones, and their scores are what validate prints.
    values = parameters(found).values
    force = found.fit.model.force(found.problem.block.signals, values)
    rms = np.sqrt(np.mean((found.problem.block.force - force) ** 2))
    assert document["corrected"]["rms"] == pytest.approx(rms, rel=1e-3)
    assert document["with_records"]["rms"] < 0.7 * document["corrected"]["rms"]
    assert document["remaining"]["over_noise"] == pytest.approx(1.0, rel=0.05)


@pytest.mark.long
def test_offsets_come_out_and_the_common_one_is_a_finding() -> None:
    r = noisy(campaign(100.0, 6.0), seed=3)
    shifts = np.array([1.0, -2.0, 0.5, 0.0, 1.5, -1.0, 2.0, -0.5, -1.5])
    assert r.force is not None
    force = r.force + np.repeat(shifts + 5.0, np.diff(r.starts))
    candidates = [get(n) for n in ("gas_preload", "coulomb_friction")]
    found = diagnose(replace(r, force=force), candidates, free=Varying(offset=True), limits=False)
    assert [f.effect.name for f in found.findings] == ["gas_preload"]
    assert found.verdict is Verdict.EXPLAINED
    assert found.fit.values["gas_preload.F_0"] == pytest.approx(5.0, abs=0.1)
    assert found.record_effects is not None
    off = found.record_effects.offset - (shifts - shifts.mean())
    assert np.abs(off / found.record_effects.offset_error).max() < 4.0
    assert np.abs(off).max() < 0.15


def test_without_scatter_values_stay_at_the_mean() -> None:
    found = diagnose(
        noisy(campaign(100.0, 6.0), seed=9), [get("coulomb_friction")],
        free=Varying(gain=True, offset=True), limits=False,
    )  # fmt: skip
    assert found.verdict is Verdict.ADEQUATE
    assert found.record_effects is not None
    assert np.abs(found.record_effects.gain - 1.0).max() < 0.003
    assert np.abs(found.record_effects.offset).max() < 0.05


def test_a_record_that_determines_nothing_keeps_the_mean() -> None:
    """In one that stands still there is no force to scale."""
    problem = prepare(noisy(campaign(100.0, 6.0), seed=9), GAINS)
    modelled = problem.block.force.copy()
    modelled[problem.recording.slices[0]] = 0.0
    gains = np.repeat(1.0 + 0.01 * np.arange(-4, 5), np.diff(problem.recording.starts))
    noise = 0.1 * np.random.default_rng(1).standard_normal(len(modelled))
    block = problem.block._replace(force=gains * modelled + noise)
    found = estimate(GAINS, block, modelled, RecordEffects.none(9))
    assert found.gain[0] == 1.0
    assert np.isinf(found.gain_error[0])
    assert found.gain[1:] == pytest.approx(1.0 + 0.01 * (np.arange(-3, 5) - 0.5), abs=2e-3)


def test_values_are_drawn_by_their_errors() -> None:
    """By hand: tau = 1, half way; no scatter beyond the errors, all the way."""
    assert shrunk(np.array([1.0, 3.0]), np.ones(2)) == pytest.approx([-0.5, 0.5])
    assert shrunk(np.array([1.0, 1.5]), np.ones(2)).tolist() == [0.0, 0.0]
    assert shrunk(np.array([1.0, 3.0]), np.array([1.0, np.inf])).tolist() == [0.0, 0.0]


@pytest.mark.long
def test_the_same_for_any_number_of_jobs() -> None:
    r = recording(concealed(EFFECT))
    few = [get(n) for n in FEW]
    one = documents.encode(to_json(diagnosed(EFFECT, GAINS)))
    assert documents.encode(to_json(diagnose(r, few, free=GAINS, jobs=2, limits=False))) == one

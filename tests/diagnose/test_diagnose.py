"""The diagnosis on recordings whose truth comes from the fixtures' independent solution."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from places import FIXTURES
from rig import campaign, noisy

from erdctl.bench.direction_of_motion import uncertain
from erdctl.core.blocks import thinned
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.problem import groups, prepare
from erdctl.diagnose.residual.localisation import locate
from erdctl.diagnose.residual.predictability import lack_of_fit_test
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.model.effect import Effect, Variable

FEW = ("coulomb_friction", "quadratic_damping", "gas_preload", "preyield_viscosity", "time_skew")


def few() -> list[Effect]:
    return [get(name) for name in FEW]


def plus(r: Recording, force: np.ndarray) -> Recording:
    assert r.force is not None
    return replace(r, force=r.force + force)


@pytest.fixture(scope="module")
def rubbing() -> Diagnosis:
    r = noisy(campaign(), seed=4, correlation=0.8)
    return diagnose(plus(r, 2.0 * np.sign(r.xdot)), few())


@pytest.mark.few(1)
@pytest.mark.parametrize("correlation", [0.0, 0.95])
def test_nothing_missing_is_adequate(correlation: float) -> None:
    found = diagnose(noisy(campaign(), seed=9, correlation=correlation), few(), limits=False)
    assert found.verdict is Verdict.ADEQUATE
    assert found.findings == ()
    assert found.mismatch == ()
    assert found.noise_rms == pytest.approx(0.3, rel=0.1)


def test_hidden_friction_is_named_and_measured(rubbing: Diagnosis) -> None:
    assert rubbing.verdict is Verdict.EXPLAINED
    assert [f.effect.name for f in rubbing.findings] == ["coulomb_friction"]
    friction = rubbing.fit.values["coulomb_friction.F_c"]
    assert friction == pytest.approx(2.0, abs=4 * rubbing.fit.stderr["coulomb_friction.F_c"])
    assert friction == pytest.approx(2.0, rel=0.1)
    assert rubbing.findings[0].after < rubbing.findings[0].before


def test_the_document_keeps_the_contract(rubbing: Diagnosis) -> None:
    document = to_json(rubbing)
    assert document["schema"] == "erdctl.diagnosis/1"
    assert {"verdict", "noise_rms", "baseline", "mismatch", "findings", "corrected",
            "remaining"} <= set(document)  # fmt: skip
    (finding,) = document["findings"]
    assert {"effect", "equivalent", "text", "equation", "parameters", "where", "evidence",
            "heldout"} <= set(finding)  # fmt: skip
    assert finding["parameters"]["F_c"]["unit"] == "N"
    assert document["corrected"]["nrmse"] < document["baseline"]["nrmse"]
    assert document["remaining"]["over_noise"] == pytest.approx(1.0, rel=0.05)


def test_something_outside_the_catalogue_is_unexplained() -> None:
    """A ripple that no damper physics makes: there, but without a name."""
    r = noisy(campaign(), seed=6)
    log = plus(r, 2.0 * np.sin(2 * np.pi * r.x / 0.002))
    found = diagnose(log, few(), limits=False, learning=False)  # which takes minutes
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.findings == ()
    best = found.selection.best
    assert lack_of_fit_test(best.problem, best.residual).misfit_rms > 0.7


def test_a_misfit_is_located() -> None:
    problem = prepare(noisy(campaign(), seed=2))
    s = problem.block.signals
    misfit = np.where((s.duty > 0.25) & (s.duty < 0.35), 1.0, 0.01)
    best = locate(problem, misfit)[0]
    assert best.variable is Variable.DUTY
    # Half way to the neighbouring levels of this campaign, 20 % and 60 %.
    assert (best.low, best.high) == pytest.approx((0.25, 0.45))
    assert "duty" in best.text


def test_groups_cover_every_sample_and_stay_within_records() -> None:
    r = campaign()
    group = groups(r)
    assert set(group.tolist()) == set(range(int(group.max()) + 1))
    for a, b in zip(r.slices[:-1], r.slices[1:], strict=True):
        assert group[a].max() < group[b].min()


def test_wrong_signs_of_a_noisy_velocity_are_set_aside() -> None:
    r = campaign()
    rng = np.random.default_rng(1)
    spoiled = replace(r, xdot=r.xdot + 0.002 * rng.standard_normal(len(r)))
    aside = uncertain(Signals.of(spoiled))
    wrong = np.sign(spoiled.xdot) != np.sign(r.xdot)
    assert (aside & wrong).sum() > 0.95 * wrong.sum()
    assert aside.mean() < 0.2
    assert uncertain(Signals.of(r)).mean() < 0.02


def test_thinning_keeps_duty_steps() -> None:
    r = campaign(1000.0)
    thin = thinned(r, 8000)
    assert len(thin) < 12_000
    steps = {(n, t) for n, p in zip(r.names, r.slices, strict=True)
             for t in r.t[p][1:][np.diff(r.duty[p]) != 0].tolist()}  # fmt: skip
    kept = {(n, t) for n, p in zip(thin.names, thin.slices, strict=True)
            for t in thin.t[p][1:][np.diff(thin.duty[p]) != 0].tolist()}  # fmt: skip
    assert kept == steps


def test_the_command(tmp_path: Path) -> None:
    log, out = FIXTURES / "healthy_noisy_motion.csv", tmp_path / "diagnosis.json"
    command = [sys.executable, "-m", "erdctl", "diagnose", str(log), "-o", str(out),
               "--effects", "coulomb_friction,time_skew", "--fail-on-mismatch"]  # fmt: skip
    run = subprocess.run(command, capture_output=True, text=True)
    document = json.loads(out.read_text())
    assert run.returncode == (0 if document["verdict"] == "adequate" else 1), run.stderr
    params = json.dumps(document["corrected"]["params"])
    (tmp_path / "p.json").write_text(params)
    check = [sys.executable, "-m", "erdctl", "validate", str(tmp_path / "p.json"), str(log)]
    assert subprocess.run(check, capture_output=True).returncode == 0

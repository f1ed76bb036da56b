"""Logs of one to three records, at one duty or two: what they cannot tell, and what is no name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
import trajectories
from rig import campaign, noisy, recording
from seeded import KNOWN

from erdctl.core.recording import Recording, concatenate
from erdctl.diagnose import thresholds
from erdctl.diagnose.conditions import most_told, one_speed_but_turns
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.io.logs import read_logs
from erdctl.plant import draw, log

BETA = {"compression.beta", "release.beta"}


def at(*duties: float) -> Recording:
    """A damper in motion at one steady duty in each record."""
    t = np.arange(1500) / 200.0
    tones = trajectories.sine(1.3, 0.012, 0.3)
    return concatenate([
        recording(t, tones.x(t), tones.velocity(t), np.full(len(t), d), f"r{d}", tones.velocity_at)
        for d in duties
    ])  # fmt: skip


def said(seed: int, path: Path, *candidates: str) -> Diagnosis:
    """The diagnosis of a sparse case that was explained by a wrong name."""
    pq.write_table(log(draw(seed, kind="sparse", known=KNOWN)), path / "log.parquet")
    found = read_logs([str(path / "log.parquet")], need_force=True, report=print).recording
    return diagnose(found, [get(n) for n in candidates], limits=False, learning=False)


@pytest.mark.long
def test_levels_that_differ_by_little_leave_the_exponent_of_the_field_free() -> None:
    """Held at 1 it would miss two records by 3 % of the yield force, which friction takes."""
    one, two = at(0.65, 0.65), noisy(at(0.65, 0.673), seed=3, rms=0.05)
    assert prepare(one).held.keys() >= BETA
    assert not BETA & prepare(two).held.keys()
    assert prepare(two).needs.keys() >= BETA  # it is told as not identified all the same
    found = diagnose(two, [get("coulomb_friction"), get("gas_preload")], limits=False)
    assert found.verdict is Verdict.ADEQUATE


@pytest.mark.long
def test_what_the_log_cannot_test_is_told_where_it_would_do_as_well(tmp_path: Path) -> None:
    found = said(1131034, tmp_path, "preyield_viscosity", "preyield_field_dependence", "cavitation")
    assert found.untestable.keys() == {"preyield_field_dependence"}  # of one duty or two
    (finding,) = found.findings
    assert finding.effect.name == "preyield_viscosity"
    assert "preyield_field_dependence" in finding.equivalent


@pytest.mark.long
def test_what_a_strong_effect_leaves_by_its_form_has_no_name(tmp_path: Path) -> None:
    """The void of the plant is compressed, and a base valve fills it: not that of the catalogue."""
    others = "presliding_friction", "gas_polytropic", "position_dependent_damping", "time_skew"
    found = said(1131035, tmp_path, "cavitation", *others)
    assert [f.effect.name for f in found.findings] == ["cavitation"]
    assert found.verdict is Verdict.EXPLAINED


def test_one_force_by_two_names_has_both(tmp_path: Path) -> None:
    """Without gas and field a deformed damper is a leaking one."""
    found = said(1132014, tmp_path, "oil_leakage", "deformation_fault", "electrical_fault")
    (finding,) = found.findings
    assert {finding.effect.name, *finding.equivalent} >= {"oil_leakage", "deformation_fault"}


@pytest.mark.long
def test_a_play_is_searched_for_in_close_steps(tmp_path: Path) -> None:
    """From gaps that are a factor of three apart the nearest end was that of another valley."""
    found = said(1132099, tmp_path, "backlash", "time_skew", "coulomb_friction")
    assert [f.effect.name for f in found.findings] == ["backlash"]
    assert found.fit.values["backlash.g"] == pytest.approx(1.64e-3, rel=0.02)


@pytest.mark.parametrize("many", [False, True])
def test_faint_effects_have_a_name_where_many_records_show_them(many: bool) -> None:
    """A zero error of less than a per cent of the square that a strong effect takes."""
    log = campaign(100.0)
    log = log if many else log.select(range(3))
    assert log.force is not None
    strong = 3000.0 * log.xdot * np.abs(log.xdot)
    log = noisy(replace(log, force=log.force + strong + 0.2), seed=5, rms=0.3)
    candidates = [get("quadratic_damping"), get("force_offset")]
    found = diagnose(log, candidates, limits=False, learning=False)
    names = [f.effect.name for f in found.findings]
    assert names == ["quadratic_damping", *(["force_offset"] if many else [])]
    assert found.verdict is Verdict.EXPLAINED


def test_levels_that_only_a_slow_amplifier_makes_tell_the_exponent_of_the_field(
    tmp_path: Path,
) -> None:
    """One level is commanded; held at 1, the yield force between is another effect's."""
    found = said(1134092, tmp_path, "supply_slew", "rise_decay_asymmetry")
    assert [f.effect.name for f in found.findings] == ["supply_slew"]
    assert found.problem.held.keys() >= BETA
    told = parameters(found).estimates
    truth = {"compression.beta": 1.304, "release.beta": 1.478}
    for name in BETA:
        interval = told[name].interval
        assert interval is not None
        assert interval[0] < truth[name] < interval[1]


def rubbing(more_at_rest: float, ripple: float) -> Recording:
    """30 N of friction, more of it at rest by a part, and a force over the stroke by no effect."""
    t, records = np.arange(2400) / 200.0, []
    for amplitude in (0.006, 0.012, 0.018):
        tones = trajectories.sine(1.3, amplitude, 0.3)
        duty = np.where(t % 2.0 < 1.0, 0.0, 0.5)
        motion = tones.x(t), tones.velocity(t), duty
        records.append(recording(t, *motion, f"{amplitude}", tones.velocity_at))
    r = concatenate(records)
    assert r.force is not None
    rubs = 30.0 * np.sign(r.xdot) * (1.0 + more_at_rest * np.exp(-((r.xdot / 0.02) ** 2)))
    return noisy(replace(r, force=r.force + rubs + ripple * np.sin(r.x / 0.0006)), 3, 0.3)


@pytest.mark.parametrize(
    ("more_at_rest", "ripple", "named"),
    [
        (0.05, 4.0, "coulomb_friction"),
        (0.4, 4.0, "stribeck_friction"),
        (0.05, 0.0, "stribeck_friction"),
    ],
)
def test_a_richer_form_has_the_name_where_it_takes_more_than_a_form_may_be_off(
    more_at_rest: float, ripple: float, named: str
) -> None:
    """Beside a misfit some richer form always takes a part; where noise is left it is the law."""
    both = [get("coulomb_friction"), get("stribeck_friction")]
    found = diagnose(rubbing(more_at_rest, ripple), both, limits=False, learning=False)
    (finding,) = found.findings
    assert finding.effect.name == named
    assert (found.verdict is Verdict.EXPLAINED) is (ripple == 0.0)
    if named == "coulomb_friction":
        assert "stribeck_friction" in finding.equivalent


def test_at_one_speed_but_for_turns_no_law_of_the_speed_is_told(tmp_path: Path) -> None:
    """Nothing was hidden: what a filter made of the turns of a triangle was `explained`."""
    found = said(1425050, tmp_path, "shear_thinning", "coulomb_friction")
    assert found.verdict is not Verdict.EXPLAINED
    assert found.cannot_tell == "one speed but for turns"
    estimates = parameters(found).estimates
    assert not [n for n, e in estimates.items() if e.identified]


@pytest.mark.long
def test_a_turn_on_a_sample_of_a_mended_velocity_is_no_misfit(tmp_path: Path) -> None:
    """It was an error of twice the yield force, 87 % of what the right model left, and a velocity
    that is noisy and late by a third of a sample was told as a skew of the force."""
    found = said(1473039, tmp_path, "velocity_noise", "time_skew")
    assert [f.effect.name for f in found.findings] == ["velocity_noise"]


@pytest.mark.long
def test_no_number_stands_on_a_lag_that_the_log_does_not_show(tmp_path: Path) -> None:
    """One sine at one duty, a lag of 0.13 s and a leak: k_nom was 4,883 +- 77 for 8,227 N/m."""
    found = parameters(said(1471040, tmp_path, "oil_leakage")).estimates
    for name, true in (("compression.k_nom", 8226.8), ("release.c_vis", 721.5)):
        interval = found[name].interval
        assert interval is not None
        assert interval[0] < true < interval[1]


def test_a_log_of_one_loop_is_not_searched_for_twelve_effects() -> None:
    assert most_told(at(0.3), 12) == thresholds.MOST_OF_ONE_LOOP
    assert most_told(at(0.3), 2) == 2
    assert most_told(campaign(), 12) == 12


def test_which_motions_have_one_speed_but_for_turns() -> None:
    def motion(*speeds: float, window: int = 9) -> Recording:
        """Triangles, one record a speed, rounded by an average over some samples."""
        r, parts = at(0.0), []
        for speed in speeds:
            v = speed * np.sign(np.sin(2 * np.pi * 1.8 * r.t))
            v = np.convolve(np.pad(v, window // 2, "edge"), np.full(window, 1 / window), "valid")
            parts.append(replace(r, x=np.cumsum(v) / 200.0, xdot=v))
        return concatenate(parts)

    assert one_speed_but_turns(motion(0.05))
    assert not one_speed_but_turns(motion(0.05, 0.1))
    assert not one_speed_but_turns(motion(0.05, window=61))
    assert not one_speed_but_turns(at(0.3))

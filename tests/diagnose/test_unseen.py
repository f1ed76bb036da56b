"""Unseen means unseen: records kept from fit and search, kinds of excitation from the fit."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
import trajectories
from rig import campaign, noisy, recording
from seeded import known_before

from erdctl.core.recording import Array, Recording, concatenate
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.kinds_of_excitation import kinds_of_motion, levels_of_duty
from erdctl.diagnose.unseen import Left, kept_aside
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.io.logs import read_logs
from erdctl.plant import draw
from erdctl.plant import log as log_of

FRICTION = get("coulomb_friction")
MOTIONS = ((0.7, 0.02), (1.9, 0.01), (3.1, 0.006), (1.2, 0.014))


@cache
def many() -> Recording:
    """Twelve records of steady duty, of which three and three are of one motion; two with steps."""
    t = np.arange(600) / 100.0
    random = np.random.default_rng(4)
    out = []
    for i, (frequency, amplitude) in enumerate(MOTIONS):
        tones = trajectories.sine(frequency, amplitude, 0.3 * i)
        for level in (0.0, 0.15, 0.3):
            duty = np.full(len(t), level)
            out.append(
                recording(t, tones.x(t), tones.velocity(t), duty, f"{i}-{level}", tones.velocity_at)
            )
    for i in range(2):
        tones = trajectories.mixed(random, 0.018, 0.14, 6.0)
        duty = trajectories.random_hold(random, t, (0.0, 0.1, 0.2, 0.3))
        out.append(recording(t, tones.x(t), tones.velocity(t), duty, f"s{i}", tones.velocity_at))
    return concatenate(out)


def in_records(r: Recording, records: tuple[int, ...]) -> Array:
    """(n,) 1 in some records, 0 in the others."""
    number = np.repeat(np.arange(len(r.names)), np.diff(r.starts))
    return np.isin(number, records).astype(np.float64)


def with_friction(where: Array) -> Recording:
    log = noisy(many(), seed=6)
    assert log.force is not None
    return replace(log, force=log.force + 1.5 * where * np.sign(log.xdot))


@cache
def friction_everywhere() -> Diagnosis:
    return diagnose(with_friction(np.ones(len(many()))), [FRICTION])


def test_no_record_is_kept_aside_of_a_log_with_few() -> None:
    assert kept_aside(campaign(100.0), [FRICTION]) == ()


def test_records_kept_aside_have_their_like_among_the_rest() -> None:
    log = many()
    aside = kept_aside(log, [FRICTION])
    assert len(aside) == 2
    widest = int(np.argmax([np.abs(log.x[s]).max() for s in log.slices]))
    assert widest not in aside
    kinds = kinds_of_motion(log)
    assert kinds is not None
    first = kinds[log.starts[:-1]]
    assert set(first[list(aside)]) <= set(np.delete(first, aside))


def test_a_record_whose_duties_no_other_has_is_not_kept_aside() -> None:
    """However much its motion and the mean and spread of its duty are those of another."""
    log, late = many().select(list(range(12))), np.arange(600) % 200 < 100
    alike = log.select([10, 10])
    duty = np.concatenate([np.where(late, 0.075, 0.225), np.where(late, 0.0, 0.3)])
    held = replace(alike, duty=duty, names=("between", "ends"))
    aside = kept_aside(concatenate([log, held]), [FRICTION])
    assert len(aside) == 2
    assert 12 not in aside
    more = replace(held.select([0, 1]), duty=np.tile(duty[:600], 2), names=("again", "too"))
    assert 12 in kept_aside(concatenate([log, held, more]), [FRICTION])


@pytest.mark.long
def test_a_yield_stress_that_levels_off_between_the_levels_of_others_is_named(
    tmp_path: Path,
) -> None:
    """The two records that tell where were kept aside, and what the others left open spoke
    against the right name there."""
    case = draw(1572073, known=known_before("deflection_offset"))
    assert [t.name for t in case.truth] == ["field_saturation"]
    pq.write_table(log_of(case), tmp_path / "log.parquet")
    log = read_logs([str(tmp_path / "log.parquet")], need_force=True, report=print).recording
    found = diagnose(log, [get("field_saturation")], limits=False, learning=False)
    assert [f.effect.name for f in found.findings] == ["field_saturation"]
    assert found.verdict is Verdict.EXPLAINED


def test_neither_fit_nor_search_sees_what_is_kept_aside() -> None:
    """Whatever is recorded there, the search chooses the same, and is judged by it."""
    log = with_friction(np.ones(len(many())))
    aside = kept_aside(log, [FRICTION])
    assert log.force is not None
    other = replace(log, force=log.force + 0.4 * in_records(log, aside))
    first, second = friction_everywhere(), diagnose(other, [FRICTION])
    gains = [found.findings[0].gain for found in (first, second)]
    assert gains[0] == gains[1]
    kept = [found.unseen[0] for found in (first, second)]
    assert [k.left for k in kept] == [Left.ASIDE] * 2
    assert kept[0].names == tuple(log.names[r] for r in aside)
    assert kept[1].after > kept[0].after


def test_the_document_says_which_kind_of_unseen_a_figure_is() -> None:
    found = friction_everywhere()
    entries = to_json(found)["unseen"]
    assert [e["left_out"] for e in entries] == [
        Left.ASIDE.value, Left.MOTIONS.value, Left.GROUPS.value
    ]  # fmt: skip
    assert [e["seen_by_search"] for e in entries] == [False, True, True]
    for entry in entries:
        assert entry["nrmse_after"] < 0.6 * entry["nrmse_before"]
        assert f"{entry['nrmse_after']:.4f}" in entry["text"]
    assert found.withdrawn == ()


@pytest.mark.long
def test_what_predicts_the_records_kept_aside_the_worse_is_not_named() -> None:
    """Damping that turns its sign in those records: the search finds it, and it does not hold."""
    log, damping = noisy(many(), seed=6), get("quadratic_damping")
    aside = kept_aside(log, [damping])
    turned = 1.0 - 2.0 * in_records(log, aside)
    assert log.force is not None
    force = log.force + 200.0 * turned * log.xdot * np.abs(log.xdot)
    found = diagnose(replace(log, force=force), [damping], learning=False)
    assert found.withdrawn == (damping,)
    assert found.findings == ()
    assert found.verdict is Verdict.UNEXPLAINED
    assert "predict the records kept aside worse" in remaining_text(found)
    assert to_json(found)["withdrawn"] == ["quadratic_damping"]


def test_kinds_of_motion_and_levels_of_duty() -> None:
    log = many().select(range(12))
    kinds, levels = kinds_of_motion(log), levels_of_duty(log)
    assert kinds is not None
    assert levels is not None
    assert kinds[log.starts[:-1]].tolist() == pytest.approx(np.repeat(kinds[log.starts[:-1:3]], 3))
    assert len(set(kinds.tolist())) == 4
    assert levels[log.starts[:-1]].tolist() == [0, 1, 2] * 4
    assert levels_of_duty(many()) is None

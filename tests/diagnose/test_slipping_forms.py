"""Friction that falls with speed in the place of constant friction, behind a mount."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trajectories
from rig import noisy, recording

from erdctl.core.recording import Recording, concatenate
from erdctl.diagnose.executor import executor
from erdctl.diagnose.form_error import is_only_form
from erdctl.diagnose.forward_step import Exploration, Explored
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.record_effects import NONE_VARY
from erdctl.effects import get
from erdctl.model.composed import Model


def log(more_at_rest: float, c_vis: float) -> Recording:
    """Five strokes of a damper behind a mount, and a force over the stroke by no effect."""
    t, records = np.arange(1600) / 200.0, []
    for amplitude in (0.006, 0.010, 0.014, 0.018, 0.022):
        tones = trajectories.sine(1.0 + 30.0 * amplitude, amplitude, 0.3)
        motion = tones.x(t), tones.velocity(t), np.zeros(len(t))
        records.append(recording(t, *motion, f"{amplitude}", tones.velocity_at))
    r = concatenate(records)
    model = Model((get("mount_compliance"), get("stribeck_friction")))
    values = {name: q.start for name, q in model.quantities.items()}
    own = {"F_k": 60.0, "F_sk": more_at_rest, "v_s": 0.1}
    values |= {f"stribeck_friction.{symbol}": v for symbol, v in own.items()}
    values |= {"mount_compliance.s_m": 2e-5}
    for way in ("compression", "release"):
        values |= {f"{way}.c_vis": c_vis, f"{way}.k_nom": 300.0}
    force = model.force(prepare(r, NONE_VARY).block.signals, values)
    return noisy(replace(r, force=force + 6.0 * np.sin(r.x / 0.0006)), 3, 0.3)


@pytest.mark.parametrize(
    ("more_at_rest", "c_vis", "slips", "only_form"),
    [
        (12.0, 20.0, True, True),
        (20.0, 20.0, True, False),  # it takes more than a form may be off
        (12.0, 300.0, False, False),  # without slips five records tell forms apart
    ],
)
def test_a_slipping_piston_must_take_more_than_a_form_may_be_off(
    more_at_rest: float, c_vis: float, *, slips: bool, only_form: bool
) -> None:
    problem = prepare(log(more_at_rest, c_vis), NONE_VARY)
    mount, constant, falling = map(
        get, ("mount_compliance", "coulomb_friction", "stribeck_friction")
    )
    base = fit_hypothesis(problem, (), [{}])
    own = {"F_k": 60.0, "F_sk": more_at_rest, "v_s": 0.1}
    start = {"mount_compliance.s_m": 2e-5, "coulomb_friction.F_c": 60.0}
    start |= {f"stribeck_friction.{symbol}": v for symbol, v in own.items()}
    plain, rich = (fit_hypothesis(problem, (mount, e), [start]) for e in (constant, falling))
    assert rich.score < plain.score
    assert (plain.slips, rich.slips) == (False, slips)
    with executor([problem], 1, lambda *_: None) as workers:
        x = Exploration(problem, base, Explored([base]), workers)
        assert is_only_form(x, plain, rich) is only_form
        assert not is_only_form(x, rich, plain)

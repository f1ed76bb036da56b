"""Between the few levels of a log, and beyond them, a law does nothing of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trajectories
from hypothesis import example, given
from hypothesis import strategies as st
from rig import TRUTH, campaign, noisy, recording

from erdctl.core.recording import Recording, concatenate
from erdctl.diagnose.corrected import baseline, parameters
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.learning.closed_forms import closed_forms
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot
from erdctl.model.learned.surface import Surface
from erdctl.model.simulate import simulate

# Widths in steps between levels: a period needs two (Nyquist), a bell one.
NARROWEST = {"sine": 2.0, "bell": 1.0}
BETWEEN = (0.05, 0.15, 0.25, 0.35, 0.4)


@pytest.mark.long
@given(
    levels=st.lists(st.integers(0, 100), min_size=4, max_size=12, unique=True).map(sorted),
    seed=st.integers(0, 1000),
)
@example(levels=[25, 58, 61, 91], seed=0)  # where a search cannot get any nearer
def test_no_form_is_narrower_than_the_widest_step(levels: list[int], seed: int) -> None:
    z = np.array(levels) / 100.0
    values = np.random.default_rng(seed).standard_normal(len(z))
    law = Law(LawSlot.FRICTION, Curve("duty", tuple(z.tolist())))
    own = {f"f_{k + 1}": float(v) for k, v in enumerate(values)}
    with np.errstate(over="raise", invalid="raise"):
        found = closed_forms(law, own, z.repeat(9))
    for form, width in ((new.curve.form, at.get("w", np.inf)) for new, at in found):
        assert width >= NARROWEST.get(form, 0.0) * np.diff(z).max() * (1.0 - 1e-12)


def with_viscosity_of_duty(r: Recording) -> Recording:
    """30 N s/m that rise and fall with the duty: a sine of 0.52 of it."""
    assert r.force is not None
    return replace(r, force=r.force + 30.0 * np.sin(12.0 * r.duty) * r.xdot)


@pytest.mark.long
@pytest.mark.untraced
def test_a_law_of_duty_is_right_between_the_levels_of_the_log() -> None:
    """A sine of 0.024 goes through the levels 0, 0.1, 0.2, 0.3, 0.45 as well as one of 0.52."""
    log = noisy(with_viscosity_of_duty(campaign(100.0, 8.0)), seed=41)
    found = diagnose(log, [get("coulomb_friction")], limits=False)
    assert found.learned is not None
    t = np.arange(400) / 100.0
    tones = trajectories.sine(2.0, 0.015, 0.0)
    fresh = with_viscosity_of_duty(
        concatenate([
            recording(t, tones.x(t), tones.velocity(t), np.full(len(t), duty), f"{duty}")
            for duty in BETWEEN
        ])
    )  # fmt: skip
    assert fresh.force is not None
    models = baseline(found), parameters(found)
    errors = [float(np.std(fresh.force - simulate(p, fresh))) for p in models]
    assert errors[1] < 0.3 * errors[0]


def test_the_exponent_of_the_field_stays_beside_a_law_of_the_duty_that_acts() -> None:
    """Either can be the other within the log; beyond it a factor stays, and an exponent goes on."""
    problem = prepare(noisy(campaign(100.0, 4.0), seed=42))
    paper = fit_hypothesis(problem, (), [TRUTH], 20)
    knots = (0.0, 0.1, 0.2, 0.3, 0.45)
    law = Law(LawSlot.DUTY, Curve("duty", knots, zero_first=True)).effect
    beside = fit_hypothesis(problem, (law,), [paper.values], 20)
    fit, _ = fit_errors(problem, beside)
    for name in ("compression.beta", "release.beta"):
        assert beside.values[name] == fit.values[name] == paper.values[name]
        assert name not in fit.free
    assert beside.values["compression.sigma"] != paper.values["compression.sigma"]
    surface = Surface("duty", knots, across=Curve("x", (-0.01, 0.01)))
    assert Law(LawSlot.YIELD, surface).effect.says_as_well == ()

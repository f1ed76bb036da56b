"""The plain plant is the paper's damper: compared with a general ODE solver and by hand."""

from __future__ import annotations

import math

import numpy as np
import oracle
import pytest
from plant_rig import DAMPER, RATE, constant, record, sine

from erdctl.plant import DutyProgramme, Plant, Side, Trajectory, simulate
from erdctl.plant.simulate import ride

STEPS = DutyProgramme((0.1, 0.4, 0.0, 0.25), (0, 130, 260, 420))


def as_oracle(side: Side) -> oracle.Branch:
    return oracle.Branch(**side._asdict())


@pytest.mark.parametrize("motion", [sine(1.3, 0.01), sine(0.4, 0.02, 2.0, offset=0.003)])
@pytest.mark.parametrize("duty", [constant(0.0), constant(0.3), STEPS])
def test_it_equals_a_general_solver(motion: Trajectory, duty: DutyProgramme) -> None:
    r = record(motion, duty, seconds=2.2)
    t, x, v = ride(r).sampled()
    damper = oracle.Damper(as_oracle(DAMPER.compression), as_oracle(DAMPER.release))
    a, f, p = motion.amplitudes[0], motion.frequencies[0], motion.phases[0]
    expected = oracle.respond(
        t, x, v, duty.at(len(t)), damper,
        velocity=lambda s: a * 2 * math.pi * f * math.cos(2 * math.pi * f * s + p),
    ).force  # fmt: skip
    assert np.abs(simulate(DAMPER, r) - expected).max() < 1e-4  # of 40 N


def test_a_duty_step_by_hand() -> None:
    """xdot > 0 for a second: F_ER = sigma v^beta (1 - exp(-t/T_d)) from the step on."""
    slow = sine(0.2, 0.01, -math.pi / 2 + 0.3)
    r = record(slow, DutyProgramme((0.0, 0.5), (0, 50)), seconds=1.0)
    t, x, v = ride(r).sampled()
    assert (v > 0).all()
    up = DAMPER.compression
    state = up.sigma * 0.5**up.beta * -np.expm1(-np.maximum(t - 50 / RATE, 0.0) / up.T_d)
    np.testing.assert_allclose(simulate(DAMPER, r), up.k_nom * x + up.c_vis * v + state, atol=1e-9)


def test_a_record_that_begins_at_rest() -> None:
    r = record(sine(1.0, 0.01, 0.4, ramp=0.2), constant(0.3), seconds=1.0)
    _, x, v = ride(r).sampled()
    force = simulate(DAMPER, r)
    assert v[0] == 0.0
    assert force[0] == pytest.approx(DAMPER.compression.k_nom * x[0])


def test_directions_are_told_apart() -> None:
    same = Plant(DAMPER.compression, DAMPER.compression)
    r = record(sine(1.0, 0.01), constant(0.3))
    _, _, v = ride(r).sampled()
    differs = np.abs(simulate(same, r) - simulate(DAMPER, r)) > 1e-3
    assert differs[v < 0].mean() > 0.9
    assert differs[v > 0].mean() < 0.6  # for a few T_d after a reversal

"""A viscosity that follows the duty: its lag, and on which side of a step the force is measured."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import quarter_car
from made import signals

from erdctl.core.recording import Array
from erdctl.effects import get
from erdctl.effects.field_viscosity import field_viscosity
from erdctl.model.composed import Model

STEP = 0.005  # s


def factor(T_v: float) -> Array:
    duty = np.repeat([0.0, 0.4], [3, 5])
    s = signals(np.ones(8), duty=duty, step=STEP)
    return field_viscosity(s, {"r": 3.0, "m": 1.0, "T_v": T_v})["viscous"]


def test_without_a_lag_it_follows_at_the_sample_of_the_step() -> None:
    assert factor(0.0) == pytest.approx(np.repeat([1.0, 2.2], [3, 5]))


def test_with_one_it_sets_out_there() -> None:
    since = STEP * np.arange(5)
    for T_v in (0.5 * STEP, STEP, 0.02):
        approach = 1.0 + 1.2 * (1.0 - np.exp(-since / T_v))
        assert factor(T_v)[3:] == pytest.approx(approach, abs=1e-4), T_v


def test_between_them_nothing_jumps() -> None:
    at_step = [factor(part * STEP)[3] for part in np.linspace(0.0, 0.6, 121)]
    falls = [a - b for a, b in pairwise(at_step)]
    assert min(falls) >= 0.0
    assert max(falls) < 0.12 * 1.2


def test_a_car_whose_fluid_thickens_at_once() -> None:
    """Where the control switches at speed: no more than noise is left, given the true values."""
    seed, rate = 110, 250
    log = quarter_car.log(seed, rate, seconds=8.0, effect="field_viscosity")
    names = ("k_nom", "c_vis", "T_d", "sigma", "beta")
    keys = [f"{way}.{name}" for way in ("compression", "release") for name in names]
    values = dict(zip(keys, quarter_car.damper(np.random.default_rng(seed)).tolist(), strict=True))
    (r,) = quarter_car.EFFECTS["field_viscosity"]
    values |= {"field_viscosity.r": r, "field_viscosity.m": 1.0, "field_viscosity.T_v": 0.0}
    values["preyield_viscosity.v_y"] = quarter_car.V_Y
    model = Model((get("field_viscosity"), get("preyield_viscosity")))
    channels = {name: log[name].to_numpy() for name in ("x", "duty", "t")}
    starts = np.cumsum([0, *log.groupby("record", sort=False).size()])
    s = signals(log.xdot.to_numpy(), **channels, starts=starts.tolist())
    left = log.force.to_numpy() - model.force(s, values)
    switched = np.append(False, s.duty[1:] != s.duty[:-1]) & (np.abs(s.xdot) > 0.02)
    assert switched.sum() > 200
    assert np.sqrt(np.mean(left[switched] ** 2)) < 0.4  # of 0.3 N; one sample late 5 N

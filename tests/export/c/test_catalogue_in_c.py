"""Every effect of the catalogue in C against Python, whatever it is."""

from __future__ import annotations

import numpy as np
import pytest
from c_built import FLOAT, block_of, forces
from c_motion import bench, random_motion
from places import FIXTURES

from erdctl.core.signals import Signals
from erdctl.effects import catalogue
from erdctl.export.c.source import on_the_vehicle
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model, off_values
from erdctl.model.effect import Effect

PAPER = read_parameters(str(FIXTURES / "table_2.json")).values
ON_CAR, _ = on_the_vehicle(catalogue())
every = pytest.mark.parametrize("effect", ON_CAR, ids=lambda e: e.name)


def acting(effect: Effect) -> dict[str, float]:
    """Values with the effect on, its shape where these motions show it."""
    seen = {"t_0": 2.0, "x_stop": 0.008, "x_r": 0.008}
    return PAPER | {effect.key(q.symbol): seen.get(q.symbol, q.start) for q in effect.quantities}


@every
def test_it_has_c(effect: Effect) -> None:
    assert effect.c is not None


@every
@pytest.mark.parametrize(("options", "near"), [((), 1e-9), ((FLOAT,), 1e-5)])
@pytest.mark.parametrize("s", [random_motion(), bench()], ids=["random", "bench"])
def test_it_equals_python(
    effect: Effect, s: Signals, options: tuple[str, ...], near: float
) -> None:
    model, values = Model((effect,)), acting(effect)
    expected = model.force(s, values)
    off = np.abs(forces(block_of(model, values, s), s, *options) - expected)
    assert off.max() <= near * np.ptp(expected)


@every
@pytest.mark.parametrize("s", [random_motion()], ids=["random"])
def test_off_it_is_absent(effect: Effect, s: Signals) -> None:
    model = Model((effect,))
    values = PAPER | off_values(model)
    plain = forces(block_of(Model(), PAPER), s)
    assert np.array_equal(forces(block_of(model, values, s), s), plain)

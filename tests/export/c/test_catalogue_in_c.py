"""Every effect of the catalogue in C against Python, whatever it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from c_built import FLOAT, block_of, forces, parameters_of
from c_motion import bench, random_motion
from places import FIXTURES

from erdctl.core.errors import UsageProblem
from erdctl.core.signals import Signals
from erdctl.effects import catalogue
from erdctl.export.c.source import on_the_vehicle, write_c
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model, off_values
from erdctl.model.effect import Effect

PAPER = read_parameters(str(FIXTURES / "table_2.json")).values
ON_CAR, _ = on_the_vehicle(catalogue())
every = pytest.mark.parametrize("effect", ON_CAR, ids=lambda e: e.name)
MOTIONS = {"random": random_motion(), "bench": bench()}
moved = pytest.mark.parametrize("s", MOTIONS.values(), ids=MOTIONS)


def acting(effect: Effect) -> dict[str, float]:
    """Values with the effect on, its shape where these motions show it."""
    seen = {"t_0": 2.0, "x_stop": 0.008, "x_r": 0.008}
    return PAPER | {effect.key(q.symbol): seen.get(q.symbol, q.start) for q in effect.quantities}


@every
def test_it_has_c(effect: Effect) -> None:
    assert effect.c is not None


@every
@pytest.mark.parametrize(("options", "near"), [((), 1e-9), ((FLOAT,), 1e-5)], ids=["", "float"])
@moved
def test_it_equals_python(
    effect: Effect, s: Signals, options: tuple[str, ...], near: float
) -> None:
    """To the last digits, with what `simulate` knows of a sample: the past alone."""
    values = acting(effect)
    expected = Model((effect,)).past_alone().force(s, values)
    off = np.abs(forces(block_of(Model((effect,)), values, s), s, *options) - expected)
    assert off.max() <= near * np.ptp(expected)


@every
@moved
def test_what_a_fit_has_by_looking_ahead_is_little(effect: Effect, s: Signals) -> None:
    assert effect.c is not None
    if effect.past_alone() is effect:
        return
    assert effect.c.note  # says so
    model, values = Model((effect,)), acting(effect)
    expected = model.force(s, values)
    off = forces(block_of(model, values, s), s) - expected
    assert np.sqrt(np.mean(off**2)) <= 0.02 * np.ptp(expected)


@every
def test_off_it_is_absent(effect: Effect) -> None:
    s, model = random_motion(), Model((effect,))
    values = PAPER | off_values(model)
    plain = forces(block_of(Model(), PAPER), s)
    assert np.array_equal(forces(block_of(model, values, s), s), plain)


def test_what_belongs_to_the_bench_is_left_out_and_said() -> None:
    for effect in catalogue():
        if effect in ON_CAR:
            continue
        block = block_of(Model((effect,)), acting(effect))
        assert [effect.name in line for line in block.left_out] == [True]
        assert f"Left out: {effect.name}" in block.source
        plain = block_of(Model(), PAPER)
        assert block.source.partition("#include")[2] == plain.source.partition("#include")[2]


def test_an_effect_without_c_is_refused_by_name() -> None:
    foreign = replace(ON_CAR[0], name="of_a_plugin", c=None)
    values = acting(foreign)
    with pytest.raises(UsageProblem, match=r"has no C: of_a_plugin"):
        write_c(parameters_of(Model((foreign,)), values), prefix="damper")

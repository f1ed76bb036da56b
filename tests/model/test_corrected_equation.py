"""Eq. 13 with the terms of effects put in, for every effect and for pairs of them."""

from __future__ import annotations

import re
from itertools import combinations

import pytest

from erdctl.effects import catalogue, get
from erdctl.model.corrected_equation import FORCE, LAG, corrected_equation
from erdctl.model.effect import Effect
from erdctl.model.paper import EQUATIONS
from erdctl.report.page.mathml import equation, flowing

CATALOGUE = catalogue()


def symbols(lines: tuple[str, ...]) -> set[str]:
    return set(re.findall(r"[A-Za-z]\w*", " ".join(lines)))


def test_without_effects_it_is_the_paper() -> None:
    assert corrected_equation([]) == EQUATIONS


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
def test_every_effect_is_in_it(effect: Effect) -> None:
    lines = corrected_equation([effect])
    assert lines != EQUATIONS
    assert lines[0].startswith(f"{FORCE} = ")
    assert lines[1].startswith(f"{LAG} = sigma ")
    found = symbols(lines)
    for q in effect.quantities:
        # Of two directions one letter stands for both.
        assert q.symbol in found or q.symbol.partition("_")[0] in found, q.symbol
    assert "{" not in "".join(lines)
    assert all(str(equation(line)).startswith("<math") for line in lines)
    assert "<code" not in "".join(str(flowing(line)) for line in lines)


@pytest.mark.untraced
@pytest.mark.parametrize("first", CATALOGUE, ids=lambda e: e.name)
def test_two_effects_are_both_in_it(first: Effect) -> None:
    for pair in combinations(CATALOGUE, 2):
        if pair[0] is first:
            both_are_in(pair)


def both_are_in(pair: tuple[Effect, Effect]) -> None:
    lines = corrected_equation(pair)
    found = symbols(lines)
    shared = {q.symbol for q in pair[0].quantities} & {q.symbol for q in pair[1].quantities}
    for number, effect in enumerate(pair, start=1):
        for q in effect.quantities:
            name = f"{q.symbol}_{number}" if q.symbol in shared else q.symbol
            # What acts on a part that another law has taken the place of is not in the equation.
            laws = [e for e in pair if type(e.slot) is type(effect.slot)]
            assert name in found or name.partition("_")[0] in found or len(laws) > 1, name
    for line in lines:
        assert line.count("(") == line.count(")")
        assert str(equation(line)).startswith("<math"), line


def test_check_values() -> None:
    play, mount = get("backlash"), get("mount_compliance")
    lines = corrected_equation([play, mount])
    assert lines[0] == "F = k_nom x_p + c_vis xdot_p + F_ER sign(xdot_p)"
    assert lines[2].startswith("x_p = x_m - q")
    assert lines[3].startswith("x_m = x - s_m F")
    lag, bent = get("signed_yield_lag"), get("preyield_viscosity")
    lines = corrected_equation([lag, bent])
    assert lines[0] == "F = k_nom x + c_vis xdot + F_y"
    assert lines[2] == "T_s dF_y/dt + F_y = F_ER tanh(xdot / v_y)"
    late, slow = get("input_delay"), get("supply_slew")
    assert corrected_equation([late, slow])[1].endswith("= sigma v_a(t - tau)^beta")

"""Geometry to parameters: hand-computed values, limits, dimensions and the paper's slips."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pint
import pytest

from erdctl.core.errors import InputProblem
from erdctl.model import geometry
from erdctl.model.geometry import (
    Geometry,
    derive,
    field,
    flow,
    gas_pressure,
    pressure_drop,
    static_force,
    voltage,
    yield_stress,
)

# Round numbers, to be computed with a pencil.
ROUND = Geometry(
    A_p=3.5e-4,
    A_s=0.5e-4,
    L_d=0.1,
    d=1e-3,
    R_d=1e-2,
    d_e=1e-3,
    P_0=5e5,
    V_0=7e-6,
    gamma=1.4,
    mu=0.05,
    c=2.0,
    alpha=0.2,
    beta=0.5,
    U_m=1000.0,
    stroke=0.02,
)


def test_the_parameters_of_a_round_geometry() -> None:
    """k = 1.4 * 5e5 * 2.5e-9 / 7e-6; c = 0.03 * 9e-8 / (pi 1e-11); sigma = 3e-4 * 200 * 200."""
    found = derive(ROUND)
    assert found.k_nom == pytest.approx(250.0)
    assert found.c_vis == pytest.approx(270 / math.pi)
    assert found.sigma == pytest.approx(12.0)
    assert found.beta == 0.5
    assert found.preload == pytest.approx(25.0)


def test_gas_pressure() -> None:
    assert gas_pressure(ROUND, np.array([0.0])) == pytest.approx([5e5])
    half = 0.07  # A_s x = 3.5e-6 m^3
    assert gas_pressure(ROUND, np.array([half])) == pytest.approx([5e5 * 2.6390158])
    assert gas_pressure(replace(ROUND, gamma=1.0), np.array([half])) == pytest.approx([1e6])
    with pytest.raises(InputProblem, match=r"below 0\.14 m"):
        gas_pressure(ROUND, np.array([0.0, 0.15]))


def test_pressure_drop_and_field() -> None:
    Q = np.array([math.pi * 1e-5, -math.pi * 1e-5, 0.0])
    assert pressure_drop(ROUND, Q, np.zeros(3)) == pytest.approx([3e4, -3e4, 0])
    assert pressure_drop(ROUND, Q, np.full(3, 200.0)) == pytest.approx([7e4, -7e4, 0])
    assert flow(ROUND, np.array([0.1])) == pytest.approx([3e-5])
    assert field(ROUND, np.array([0.0, 0.2, 1.0])) == pytest.approx([0, 2e5, 1e6])
    assert yield_stress(ROUND, np.array([0.0, 1e6, -1e6])) == pytest.approx([0, 200, 200])


def test_the_voltages_of_table_1() -> None:
    duty = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    assert voltage(duty) == pytest.approx([0, 1e3, 2e3, 3e3, 4e3, 5e3])
    assert voltage(duty, 1000.0) == pytest.approx(1e3 * duty)


def test_the_static_force_is_the_paper_model_with_the_preload() -> None:
    """Eqs. 4 and 8 end to end against Eqs. 11, 13 and 14 with the derived parameters."""
    p = derive(ROUND)
    xdot = np.array([-0.15, -0.01, 0.0, 0.01, 0.15])
    duty = np.array([0.3, 0.0, 0.3, 0.1, 1.0])
    still = static_force(ROUND, np.zeros(5), xdot, duty)
    expected = p.preload + p.c_vis * xdot + p.sigma * duty**p.beta * np.sign(xdot)
    assert still == pytest.approx(expected, rel=1e-12)
    # Eq. 14 is the slope of the gas force at x = 0.
    h = 1e-6
    low, high = static_force(ROUND, np.array([-h, h]), np.zeros(2), np.zeros(2))
    assert (high - low) / (2 * h) == pytest.approx(p.k_nom, rel=1e-6)


def test_the_dimensions_close() -> None:
    """Every function on quantities with units: only the physical form gives N, N/m and N s/m."""
    u: Any = pint.UnitRegistry()
    units = {
        "A_p": "m^2", "A_s": "m^2", "L_d": "m", "d": "m", "R_d": "m", "d_e": "m", "P_0": "Pa",
        "V_0": "m^3", "gamma": "", "mu": "Pa*s", "c": "", "alpha": "Pa*(m/V)^0.5", "beta": "",
        "U_m": "V", "stroke": "m",
    }  # fmt: skip
    assert set(units) == {f.name for f in fields(Geometry)}
    values: Any = {
        name: getattr(ROUND, name) * u.Quantity(1.0, unit) if unit else getattr(ROUND, name)
        for name, unit in units.items()
    }
    g: Any = Geometry(**values)
    found: Any = geometry  # quantities go where floats are declared
    for function, unit in (
        (found.gas_stiffness, "N/m"),
        (found.viscous_damping, "N*s/m"),
        (found.full_yield_force, "N"),
        (found.preload, "N"),
    ):
        assert function(g).check(u.Quantity(1, unit).dimensionality), function.__name__
    Q = found.flow(g, 0.1 * u.m / u.s)
    E = found.field(g, 0.2)
    tau_y = found.yield_stress(g, E)
    assert Q.check("[length]^3 / [time]")
    assert E.check(u.Quantity(1, "V/m").dimensionality)
    assert tau_y.check("[pressure]")
    assert found.pressure_drop(g, Q, tau_y).check("[pressure]")
    assert found.voltage(0.2, g.U_m).to("V").magnitude == pytest.approx(200.0)
    # As printed in Eq. 9 the viscous term is no force: pressure drop per flow times velocity.
    printed = 6 * g.mu * g.L_d / (math.pi * g.d**3 * g.R_d) * (0.1 * u.m / u.s)
    assert not printed.check("[force]")
    # Remark 1, Q = xdot, is no pressure drop either.
    with pytest.raises(pint.DimensionalityError):
        found.pressure_drop(g, 0.1 * u.m / u.s, tau_y)


def test_the_printed_field_is_complex() -> None:
    """Eq. 11: (-U_m / d_e)^beta is complex for Table 2's exponents; |E| gives its magnitude."""
    for beta in (0.2373, 0.3948):
        printed = (-5000.0 / 1e-3) ** beta
        assert isinstance(printed, complex)
        assert abs(printed.imag) > 1.0
        with np.errstate(invalid="ignore"):
            assert np.isnan(np.power(-5e6, beta))
        g = replace(ROUND, beta=beta, U_m=5000.0, alpha=1.0)
        assert yield_stress(g, field(g, np.array([1.0]))) == pytest.approx([abs(printed)])


def test_scaling_laws() -> None:
    """Each parameter against the power of each dimension that its equation has."""
    p = derive(ROUND)
    assert derive(replace(ROUND, d=2e-3)).c_vis == pytest.approx(p.c_vis / 8)
    assert derive(replace(ROUND, d=2e-3)).sigma == pytest.approx(p.sigma / 2)
    assert derive(replace(ROUND, d_e=4e-3)).sigma == pytest.approx(p.sigma / 2)
    assert derive(replace(ROUND, A_p=6.5e-4)).c_vis == pytest.approx(p.c_vis * 4)
    assert derive(replace(ROUND, A_p=6.5e-4)).sigma == pytest.approx(p.sigma * 2)
    assert derive(replace(ROUND, V_0=14e-6)).k_nom == pytest.approx(p.k_nom / 2)


@pytest.mark.parametrize(
    ("change", "names"),
    [
        *(({f.name: -1.0}, f.name) for f in fields(Geometry)),
        *(({f.name: 0.0}, f.name) for f in fields(Geometry) if f.name != "stroke"),
        ({"mu": math.nan}, "mu"),
        ({"P_0": math.inf}, "P_0"),
        ({"A_s": 3.5e-4}, "exchanged"),
        ({"A_s": 4e-4}, "A_p"),
        ({"d": 2e-2}, "R_d"),
        ({"gamma": 0.9}, "polytropic"),
        ({"stroke": 0.14}, "V_0"),
    ],
)
def test_an_impossible_geometry_is_refused(change: dict[str, float], names: str) -> None:
    with pytest.raises(InputProblem, match=names) as caught:
        derive(replace(ROUND, **change), file="geometry.json")
    assert str(caught.value).startswith("geometry.json: ")


def test_an_unknown_stroke_is_allowed() -> None:
    assert derive(replace(ROUND, stroke=0.0)) == derive(ROUND)


@pytest.mark.parametrize("wrong", [{"d": 5e-324}, {"beta": 1e19}, {"alpha": 1e308, "U_m": 1e308}])
def test_dimensions_beyond_any_number_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(InputProblem, match=r"^g.json: these dimensions give"):
        derive(replace(ROUND, **wrong), file="g.json")

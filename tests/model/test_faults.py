"""Faults: the grammar of --fault and the factors of Eqs. 20-23."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.core.errors import UsageProblem
from erdctl.model.faults import (
    Corner,
    Fault,
    FaultFactors,
    FaultKind,
    factors,
    leakage,
    on_channel,
    parse_fault,
)

finite = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def faults(draw: st.DrawFn) -> Fault:
    kind = draw(st.sampled_from(FaultKind))
    by_flow = kind is FaultKind.OIL and draw(st.booleans())
    start = draw(st.none() | st.floats(-1e3, 1e3))
    return Fault(
        kind=kind,
        factor=None if by_flow else draw(st.floats(0, 1)),
        flow=draw(st.floats(0, 1e3, exclude_min=True)) if by_flow else None,
        start=start,
        end=None if start is None else draw(st.none() | st.floats(1e3, 2e3, exclude_min=True)),
        ramp=draw(st.floats(0, 1e4)),
        channel=draw(st.sampled_from(Corner)),
    )


def over(t: list[float], *specs: str, xdot: list[float] | None = None) -> FaultFactors:
    times = np.array(t)
    speed = np.full(len(t), 0.1) if xdot is None else np.array(xdot)
    return factors([parse_fault(s) for s in specs], times, speed, np.array([0, len(t)]))


def test_the_sequence_of_section_6_4() -> None:
    """Oil 50 % at 15 s, electrical 80 % from 31 s, deformation 70 % from 46 s to 60 s."""
    t = [0.0, 14.999, 15.0, 30.999, 31.0, 45.0, 46.0, 59.999, 60.0]
    f = over(t, "oil=0.5@15:31", "electrical=0.8@31:46", "deformation=0.7@46:60")
    assert f.gas.tolist() == [1, 1, 0.5, 0.5, 1, 1, 1, 1, 1]
    assert f.viscous.tolist() == [1, 1, 0.5, 0.5, 1, 1, 0.7, 0.7, 1]
    assert f.yield_.tolist() == [1, 1, 0.5, 0.5, 0.8, 0.8, 0.7, 0.7, 1]


@pytest.mark.parametrize(
    ("spec", "expected"),
    [
        ("oil=0.5", (0.5, 0.5, 0.5)),  # Eq. 20
        ("oil_leakage=0.5", (0.5, 0.5, 0.5)),
        ("electrical=0.5", (1.0, 1.0, 0.5)),  # Eq. 22
        ("electrical_fault=0.5", (1.0, 1.0, 0.5)),
        ("deformation=0.5", (1.0, 0.5, 0.5)),  # Eq. 23
        ("deformation_fault=0.5", (1.0, 0.5, 0.5)),
        ("oil=0", (0.0, 0.0, 0.0)),
    ],
)
def test_each_fault_acts_on_its_terms(spec: str, expected: tuple[float, float, float]) -> None:
    f = over([0.0, 1.0], spec)
    for part, value in zip((f.gas, f.viscous, f.yield_), expected, strict=True):
        assert part.tolist() == [value, value]


def test_several_faults_multiply_also_of_the_same_kind() -> None:
    f = over([5.0, 15.0, 25.0], "oil=0.5@10", "oil=0.5@20", "deformation=0.5@20", "electrical=0.5")
    assert f.gas.tolist() == [1, 0.5, 0.25]
    assert f.viscous.tolist() == [1, 0.5, 0.125]
    assert f.yield_.tolist() == [0.5, 0.25, 0.0625]


def test_a_ramp_falls_linearly_and_ends_at_once() -> None:
    f = over([9.0, 10.0, 11.0, 12.0, 19.999, 20.0], "electrical=0.5@10:20,ramp=2")
    assert f.yield_.tolist() == [1, 1, 0.75, 0.5, 0.5, 1]
    cut_short = over([11.0, 12.0, 13.0], "electrical=0@10:12,ramp=4")
    assert cut_short.yield_.tolist() == [0.75, 1, 1]


def test_times_are_those_of_each_record_as_logged() -> None:
    t = np.array([0.0, 10.0, 20.0, 100.0, 110.0, 5.0, 15.0])
    starts = np.array([0, 3, 5, 7])
    at = factors([parse_fault("electrical=0.5@10")], t, np.zeros(7), starts)
    assert at.yield_.tolist() == [1, 0.5, 0.5, 0.5, 0.5, 1, 0.5]
    # With no START a ramp begins at the first sample of each record.
    ramp = factors([parse_fault("electrical=0,ramp=20")], t, np.zeros(7), starts)
    assert ramp.yield_.tolist() == [1, 0.5, 0, 1, 0.5, 1, 0.5]


def test_a_leakage_by_flow_is_bounded_at_rest() -> None:
    """Eq. 21 is only a proportionality: q / |xdot|, at most 1."""
    assert leakage(np.array([0.0, 0.05, -0.05, 0.1, -0.2]), 0.05).tolist() == [1, 1, 1, 0.5, 0.25]
    f = over([14.0, 15.0, 16.0], "oil=flow:0.05@15", xdot=[0.1, 0.1, 0.0])
    assert f.gas.tolist() == f.viscous.tolist() == f.yield_.tolist() == [1, 0.5, 1]


def test_one_damper_is_picked_by_its_channel() -> None:
    all_ = [parse_fault("oil=0.5"), parse_fault("oil=0.6,channel=rr")]
    assert on_channel(all_, Corner.FRONT_LEFT) == (all_[0],)
    assert on_channel(all_, Corner.REAR_RIGHT) == (all_[1],)


@pytest.mark.parametrize(
    ("spec", "names"),
    [
        ("oil", "'='"),
        ("", "'='"),
        ("leak=0.5", "'leak'"),
        ("oil=half", "'half'"),
        ("oil=nan", "'nan'"),
        ("oil=inf", "'inf'"),
        ("oil=1.5", "0..1"),
        ("oil=-0.1", "0..1"),
        ("oil=50", "50 % is 0.5"),
        ("oil=0.5@", "START"),
        ("oil=0.5@:31", "START"),
        ("oil=0.5@15:", "END"),
        ("oil=0.5@31:15", "END"),
        ("oil=0.5@15:15", "END"),
        ("oil=0.5@15:31:40", "END"),
        ("oil=0.5@1e999", "START"),
        ("electrical=flow:0.1", "only oil"),
        ("oil=flow:0", "above 0"),
        ("oil=flow:", "flow"),
        ("oil=0.5,ramp=-1", "ramp"),
        ("oil=0.5,ramp", "ramp"),
        ("oil=0.5,rmp=1", "'rmp'"),
        ("oil=0.5,ramp=1,ramp=2", "twice"),
        ("oil=0.5,channel=left", "fl, fr, rl, rr"),
        ("oil=0.5,", "''"),
    ],
)
def test_a_bad_specification_is_named_with_an_example(spec: str, names: str) -> None:
    with pytest.raises(UsageProblem) as caught:
        parse_fault(spec)
    message = str(caught.value)
    assert repr(spec)[1:-1] in message
    assert names in message
    assert "oil=0.5@15:31" in message


@given(faults())
def test_a_fault_survives_its_own_text(fault: Fault) -> None:
    assert parse_fault(str(fault)) == fault


@given(st.text(max_size=30) | st.from_regex(r"(oil|electrical)=[-0-9.@:,a-z=]{0,20}"))
def test_any_text_is_a_fault_or_a_usage_problem(spec: str) -> None:
    try:
        fault = parse_fault(spec)
    except UsageProblem:
        return
    assert parse_fault(str(fault)) == fault


@given(st.lists(faults(), max_size=4), st.lists(finite, min_size=1, max_size=20), st.data())
def test_factors_stay_between_lost_and_healthy(
    several: list[Fault], xdot: list[float], data: Any
) -> None:
    n = len(xdot)
    t = np.sort(data.draw(st.lists(st.floats(-2e3, 3e3), min_size=n, max_size=n)))
    cut = data.draw(st.integers(0, n))
    starts = np.unique([0, cut, n])
    f = factors(several, np.asarray(t, float), np.array(xdot), starts)
    for part in (f.gas, f.viscous, f.yield_):
        assert part.shape == (n,)
        assert np.all((part >= 0) & (part <= 1))
    # Whatever acts on the gas acts on the viscous force too, and that on the yield force.
    assert np.all(f.gas >= f.viscous)
    assert np.all(f.viscous >= f.yield_)
    reordered = factors(several[::-1], np.asarray(t, float), np.array(xdot), starts)
    assert np.allclose(reordered.yield_, f.yield_, rtol=1e-12)


@given(faults(), st.integers(1, 30))
def test_a_healthy_factor_changes_nothing(fault: Fault, n: int) -> None:
    healthy = Fault(kind=fault.kind, factor=1.0, start=fault.start, end=fault.end, ramp=fault.ramp)
    f = factors([healthy], np.linspace(-5.0, 5.0, n), np.ones(n), np.array([0, n]))
    assert np.array_equal(f.yield_, np.ones(n))

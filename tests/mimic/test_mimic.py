"""Fault emulation against the paper's formulas, the independent solution, and the amplifier."""

from __future__ import annotations

from functools import cache

import numpy as np
import oracle
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from places import FIXTURES
from pyarrow import csv
from rig import TRUTH, recording

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.io.parameters import parse_parameters
from erdctl.mimic import YieldLaw, follow, mimic, static_duty
from erdctl.model.amplifier import Amplifier
from erdctl.model.composed import Model
from erdctl.model.faults import factors, parse_fault

PARAMETERS = parse_parameters((FIXTURES / "table_2.json").read_bytes(), "table_2.json")
SEQUENCE = ("oil=0.5@15:31", "electrical=0.8@31:46", "deformation=0.7@46:60")


@cache
def schedule() -> Recording:
    table = csv.read_csv(FIXTURES / "schedule_60s.csv")
    t, x, xdot, duty = (table[c].to_numpy() for c in ("t", "x", "xdot", "duty"))
    return recording(t, x, xdot, duty)


def by_hand(r: Recording, kind: str, f: float) -> Array:
    """Eqs. 27, 31 and 35 as printed, sample by sample; zero where the bracket is negative."""
    out = []
    for x, xdot, v in zip(r.x, r.xdot, r.duty, strict=True):
        d = "compression" if xdot > 0 else "release"
        k, c, sigma, beta = (TRUTH[f"{d}.{s}"] for s in ("k_nom", "c_vis", "sigma", "beta"))
        bracket = {
            "oil": (f - 1) / sigma * (k * x + c * xdot) * np.sign(xdot) + f * v**beta,
            "electrical": f * v**beta,
            "deformation": (f - 1) / sigma * c * abs(xdot) + f * v**beta,
        }[kind]
        out.append(max(bracket, 0.0) ** (1 / beta))
    return np.array(out)


@pytest.mark.parametrize("kind", ["oil", "electrical", "deformation"])
@pytest.mark.parametrize("f", [0.0, 0.5, 0.8, 1.0])
def test_static_inverse_is_the_papers(kind: str, f: float) -> None:
    r = schedule()
    s = Signals.of(r)
    prepared = Model().prepare(s, TRUTH)
    laws = tuple(YieldLaw.of(Model(), TRUTH, d) for d in ("compression", "release"))
    g = factors([parse_fault(f"{kind}={f}")], s.t, s.xdot, s.starts)
    found = static_duty(prepared, prepared.parts(TRUTH), g, laws)
    assert found == pytest.approx(by_hand(r, kind, f), abs=1e-12)


def test_sequence_of_section_6_4() -> None:
    plan = mimic(PARAMETERS, schedule(), [parse_fault(f) for f in SEQUENCE], Amplifier())
    for reach in plan.reaches:
        print(reach.fault, f"compensated {reach.compensated:.4f}, paper {reach.paper:.4f}")
        assert reach.compensated < 0.7 * reach.paper
        assert reach.compensated < 0.02
        assert reach.out_of_reach == 0.0
    assert plan.duty.min() >= 0.0
    assert plan.duty.max() <= 0.45


def test_expected_force_is_what_the_oracle_gives() -> None:
    r = schedule()
    plan = mimic(PARAMETERS, r, [parse_fault(f) for f in SEQUENCE], Amplifier())
    force = oracle.respond(r.t, r.x, r.xdot, plan.duty).force
    away = Signals.of(r).since_reversal > 0.01
    assert plan.expected[away] == pytest.approx(force[away], abs=0.01)


def test_what_no_duty_can_do_is_reported() -> None:
    plan = mimic(PARAMETERS, schedule(), [parse_fault("deformation=0.05")], Amplifier())
    (reach,) = plan.reaches
    assert reach.out_of_reach > 0.05
    assert reach.missing_max > reach.missing_rms > 0
    assert not plan.duty_paper[plan.out_of_reach].all()


def test_a_healthy_factor_changes_nothing_after_the_start() -> None:
    r = schedule()
    plan = mimic(PARAMETERS, r, [parse_fault("oil=1.0")], Amplifier())
    assert plan.reaches == ()
    assert plan.duty_paper == pytest.approx(r.duty)


def test_ceiling_is_said() -> None:
    r = schedule()
    plan = mimic(PARAMETERS, r, [parse_fault("oil=0.9")], Amplifier(duty_max=0.2))
    assert plan.duty.max() <= 0.2
    assert plan.limited > 0.4


@pytest.mark.parametrize(
    "bad",
    [{"duty_max": 0.0}, {"duty_max": 1.5}, {"resolution": 0.9}, {"slew": 0.0},
     {"update_rate": 1e9}, {"carrier": -1.0}],
)  # fmt: skip
def test_impossible_amplifiers_are_refused(bad: dict[str, float]) -> None:
    with pytest.raises(UsageProblem):
        Amplifier(**bad)


@settings(deadline=None, max_examples=40)
@given(
    st.floats(0.1, 0.9), st.sampled_from([0.0, 0.001, 0.02]), st.sampled_from([np.inf, 2.0, 50.0]),
    st.sampled_from([None, 50.0, 200.0]), st.sampled_from(["oil", "deformation", "electrical"]),
)  # fmt: skip
def test_the_amplifier_can_carry_out_every_plan(
    factor: float, resolution: float, slew: float, rate: float | None, kind: str
) -> None:
    t = np.arange(600) * 0.005
    duty = np.where(np.floor(t / 0.7) % 2 == 0, 0.3, 0.1)
    r = recording(t, 0.01 * np.sin(9 * t), 0.09 * np.cos(9 * t), duty)
    amplifier = Amplifier(resolution=resolution, slew=slew, update_rate=rate)
    plan = mimic(PARAMETERS, r, [parse_fault(f"{kind}={factor}@1")], amplifier)
    for v in (plan.duty, plan.duty_paper):
        assert v.min() >= 0.0
        assert v.max() <= amplifier.duty_max + 1e-12
        if resolution:
            assert v / resolution == pytest.approx(np.round(v / resolution), abs=1e-6)
        change = np.flatnonzero(np.diff(v)) + 1
        if rate is not None:
            # Changes happen at ticks only.
            ticks = np.flatnonzero(np.diff(np.floor(t * rate + 1e-9))) + 1
            assert set(change) <= set(ticks)
        if np.isfinite(slew) and len(change):
            since = np.diff(t[np.concatenate([[0], change])])
            assert (np.abs(np.diff(v))[change - 1] <= slew * np.maximum(since, 0.005) + 1e-9).all()
    assert np.isfinite(plan.expected).all()


def test_follow_restarts_at_each_record() -> None:
    r = schedule()
    two = r.select([0, 0])
    wanted = np.concatenate([np.full(len(r), 0.1), np.full(len(r), 0.4)])
    found = follow(wanted, Signals.of(two), Amplifier(slew=0.01))
    assert found[len(r)] == pytest.approx(0.4)

"""Records of one duty each: what is missing in some of them is a fault, or how forces change with
the duty or the motion, and where the data do not tell no fault is looked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from by_hand import recording
from steady_sines import steady_sines

from erdctl.core.recording import Array, Recording
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.one_after_another import if_sure
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.records_with_a_fault import is_no_law
from erdctl.diagnose.residual.predictability import lack_of_fit_of
from erdctl.diagnose.sets_in_once import SetsInOnce, sets_in_once
from erdctl.effects import get
from erdctl.model.composed import Model
from erdctl.model.effect import Effect

FAULTS = tuple(get(name) for name in ("oil_leakage", "electrical_fault", "deformation_fault"))
LEVELS = (0.0, 0.11, 0.22, 0.33, 0.45)
ONE, TWO = [(0.5, 0.025)], [(0.5, 0.025), (3.0, 0.005)]  # motions at each [Hz], [m]
POWER, SQUARE = np.array(LEVELS) ** 0.5, np.array(LEVELS) ** 2


def campaign(yields: Array, motions: list[tuple[float, float]]) -> Recording:
    """yields : (5,) yield force at the levels, over 30 N."""

    def force(x: Array, v: Array, u: Array) -> Array:
        return np.asarray(300 * x + 60 * v + own(u) * np.tanh(v / 3e-3))

    def own(u: Array) -> Array:
        return 30.0 * np.interp(u, LEVELS, yields)

    return steady_sines(LEVELS, motions, force, noise=0.1)


def faulty(r: Recording, record: int, f: float, logged: float = 1.0) -> Recording:
    """A log of a power of the duty of which one record has an electrical fault.

    logged : duty in the log over that of the record
    """
    assert r.force is not None
    force, duty, own = r.force.copy(), r.duty.copy(), r.slices[record]
    force[own] -= (1.0 - f) * 30.0 * r.duty[own] ** 0.5 * np.tanh(r.xdot[own] / 3e-3)
    duty[own] *= logged
    return replace(r, force=force, duty=duty)


def fit(r: Recording, effects: tuple[Effect, ...] = ()) -> Hypothesis:
    start = {name: q.start for name, q in Model(effects).quantities.items()}
    return fit_hypothesis(prepare(r), effects, [start])


def sought(r: Recording) -> SetsInOnce | None:
    best = fit(r)
    return sets_in_once(best, FAULTS, lack_of_fit_of(best).misfit_rms)


@pytest.mark.parametrize(
    ("yields", "motions"),
    [
        (POWER * (1.0, 0.75, 1.0, 1.0, 1.0), ONE),  # as of a magneto-rheological damper, at 0.25 A
        (POWER * (1.0, 1.0, 1.0, 1.0, 0.85), TWO),
        pytest.param(SQUARE / (SQUARE + 0.02), ONE, marks=pytest.mark.long),
    ],
    ids=["less at one level", "the highest adds nothing", "S-shaped"],
)
def test_what_a_law_of_the_duty_may_be_is_no_fault(
    yields: Array, motions: list[tuple[float, float]]
) -> None:
    """`deformation_fault` in the records of one duty was looked for, longer than a diagnosis."""
    best = fit(campaign(yields, motions))
    assert lack_of_fit_of(best).misfit_rms > 0.3
    assert sets_in_once(best, FAULTS, lack_of_fit_of(best).misfit_rms) is None


@pytest.mark.parametrize("record", [5, pytest.param(9, marks=pytest.mark.long)])
def test_less_than_at_nearly_the_same_duty_is_a_fault(record: int) -> None:
    found = sought(faulty(campaign(POWER, TWO), record, 0.7, logged=0.98))
    assert found is not None
    assert found.whole
    assert record in found.records


def test_less_than_at_a_lower_duty_is_a_fault() -> None:
    found = sought(faulty(campaign(POWER, ONE), 3, 0.5))
    assert found is not None
    assert (found.effect.name, found.records, found.whole) == ("electrical_fault", (3,), True)
    assert found.f == pytest.approx(0.5, abs=0.02)


def test_more_than_at_any_lower_duty_may_be_its_law() -> None:
    assert sought(faulty(campaign(POWER, ONE), 1, 0.5)) is None


@pytest.mark.parametrize(("record", "said"), [(3, True), (1, False)])
def test_nor_is_it_said_in_the_end(record: int, said: bool) -> None:
    """Of a fault that began within a record as it was sought."""
    r = faulty(campaign(POWER, ONE), record, 0.5)
    order = (*(k for k in range(5) if k != record), record)
    fault = get("electrical_fault")
    once = SetsInOnce(fault, order, 4, True, (0.0, 0.0), 0.5, FAULTS)
    best = fit(once.in_order(r), (fault,))
    told = if_sure(once, order, best, r, explained=True)
    assert (told is not None) == said
    none = {**best.values, fault.key("f"): 0.0}  # of all that fails nothing is left
    dead = replace(best, fitted=replace(best.fitted, values=none))
    assert is_no_law(dead, fault, 0.0, [4]) == said


@pytest.mark.parametrize(("motions", "said"), [(ONE, False), (TWO, True)])
def test_without_a_duty_other_records_without_one_tell(
    motions: list[tuple[float, float]], said: bool
) -> None:
    """A fluid may be more viscous in a field; a spring, most of the force here, is not stiffer."""
    best = fit(campaign(POWER, motions))
    assert is_no_law(best, get("deformation_fault"), 0.7, [0]) == said
    assert is_no_law(best, get("oil_leakage"), 0.7, [0])


def test_where_most_records_have_it_the_others_tell() -> None:
    """Half of the force at 0.33 and 0.45 is less than the other's at 0.22; at 0.11 it is not."""
    best = fit(campaign(POWER, ONE))
    assert is_no_law(best, get("electrical_fault"), 0.5, [1, 3, 4])
    assert not is_no_law(best, get("electrical_fault"), 0.9, [1, 3, 4])


def test_what_all_records_of_one_motion_lack_is_no_fault() -> None:
    """It was seen in those at 1.5 Hz, and in all at no duty, of which none told otherwise."""
    r = campaign(POWER, [*TWO, (1.5, 0.01)])
    assert r.force is not None
    of_third = np.repeat(np.arange(15) % 3 == 2, np.diff(r.starts))
    slower = r.force + np.where(of_third, 0.15 * (300 * r.x - r.force), 0.0)
    assert sought(replace(r, force=slower)) is None


def test_a_motion_that_wanders_goes_where_others_go() -> None:
    """Sines of one stroke and frequency are of their own kind, and a random motion is not."""
    t = np.arange(2000) / 200.0
    shape = np.random.default_rng(5).normal(size=(2, 40))
    hertz = 2 * np.pi * np.linspace(0.2, 3.0, 40)
    wave = (shape[0] @ np.sin(np.outer(hertz, t) + 6.0 * shape[1][:, None])) * 2e-3
    parts = [0.01 * np.sin(np.pi * t), 0.004 * np.sin(6 * np.pi * t), wave]
    x = np.concatenate(parts)
    v = np.concatenate([np.gradient(own, t) for own in parts])
    force = 200 * x + 60 * v + 10.0 * np.tanh(v / 3e-3)
    starts = [0, 2000, 4000, 6000]
    r = recording(v, x=x, duty=0.1, force=force, t=np.tile(t, 3), starts=starts)
    fault = get("deformation_fault")
    best = fit(r)
    assert all(is_no_law(best, fault, 0.7, [k]) for k in range(3))
    assert all(is_no_law(best, fault, 0.7, [k for k in range(3) if k != own]) for own in range(3))
    sines = fit(r.select([0, 1]))
    assert not any(is_no_law(sines, fault, 0.7, [k]) for k in range(2))

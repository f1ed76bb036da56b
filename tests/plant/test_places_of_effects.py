"""Where the plant's effects are looked for: in the variable of their physics, and there rightly.

The corrected model is the truth and the paper's model the plant's own refit: what is held here is
what is listed, not what is fitted.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from plant_rig import DAMPER, RATE, hidden, over, plain, samples

from erdctl.core.recording import Recording
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.residual.localisation import Region
from erdctl.diagnose.residual.places import acting, places
from erdctl.effects import get
from erdctl.model.effect import Variable
from erdctl.plant.refit import refit, shape_of
from erdctl.plant.regions import MisfitRegion, overlap, regions
from erdctl.plant.simulate import forces
from erdctl.prove.score import OVERLAP

ONSET = 0.475 * 4.0  # [s], the middle of the draws' part of the shortest record
FAULTS = ("oil_leakage", "electrical_fault", "deformation_fault")
STRENGTHS = {
    "cavitation": 0.3, "gas_polytropic": 0.6, "position_dependent_damping": 0.8, "end_stop": 0.5,
    "gas_thermal_drift": 0.3, "thermal_fade": 0.4, "field_saturation": 0.8, "input_delay": 0.05,
    "backlash": 0.1, "quadratic_damping": 0.5, **dict.fromkeys(FAULTS, 0.4),
}  # fmt: skip


@cache
def found(name: str) -> tuple[list[Region], list[Region], tuple[MisfitRegion, ...]]:
    """Places listed, where the effect is said to act, and where the plant's force changes."""
    plant, s = hidden(name, STRENGTHS[name]), samples()
    force, edges = forces(plant, over()), s.starts
    t = np.concatenate([np.arange(b - a) / RATE for a, b in pairwise(edges.tolist())])
    problem = prepare(
        Recording(
            t=t, x=s.x, xdot=s.v, duty=s.duty, force=force, starts=edges,
            names=tuple(f"r{k}" for k in range(len(edges) - 1)),
        )
    )  # fmt: skip
    effect = get(name)
    values = {effect.key("t_0"): ONSET} if effect.sets_in else {}
    misfit = refit(s, force, [shape_of(DAMPER)]).rest ** 2
    acts = acting(problem, effect, values, [(force - plain()) ** 2, misfit])
    listed = places(problem, misfit, [(effect, acts)])
    return listed, acts, regions(s, force, force - plain())


def true(name: str, region: Region) -> bool:
    """Whether the plant's own force of the effect gathers there."""
    return any(
        r.variable == region.variable.value and overlap(r, (region.low, region.high)) >= OVERLAP
        for r in found(name)[2]
    )


@pytest.mark.parametrize("name", STRENGTHS)
def test_the_first_place_is_in_the_variable_of_the_physics(name: str) -> None:
    listed, acts, _ = found(name)
    assert acts[0].variable is get(name).shows
    if name != "cavitation":  # whose misfit is sharper on one side of rest, see below
        assert listed[0].variable is get(name).shows


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_from_its_onset_on(name: str) -> None:
    listed, acts, _ = found(name)
    for first in (listed[0], acts[0]):
        assert (first.low, first.high) == (pytest.approx(ONSET), pytest.approx(4.0 - 1 / RATE))
        assert true(name, first)


def test_a_void_is_after_a_reversal_and_in_release() -> None:
    listed, acts, _ = found("cavitation")
    assert true("cavitation", acts[0])
    side, after = listed[:2]
    assert (side.variable, after.variable) == (Variable.XDOT, Variable.SINCE_REVERSAL)
    assert side.high < 0.1 * -side.low
    assert after.low < 1 / RATE


def test_gas_and_stops_are_at_the_ends_of_the_stroke() -> None:
    most, least = samples().x.max(), samples().x.min()
    for name in ("gas_polytropic", "end_stop"):
        listed, acts, _ = found(name)
        for ends in (listed, acts):
            at = [r for r in ends if r.variable is Variable.X]
            assert any(r.high == pytest.approx(most, rel=0.01) and r.low > 0.5 * most for r in at)
    assert any(r.low == pytest.approx(least, rel=0.01) for r in found("end_stop")[1])


def test_a_groove_is_at_both_ends_of_the_stroke() -> None:
    """Its force grows with the square of x, so that no single interval holds half of it.

    Samples of no weight make the difference.
    """
    name, x = "position_dependent_damping", samples().x
    acts = found(name)[1]
    assert [r.variable for r in acts] == [Variable.X] * 2
    force = (forces(hidden(name, STRENGTHS[name]), over()) - plain()) ** 2
    inside = [(x >= r.low) & (x <= r.high) for r in acts]
    for r, at in zip(acts, inside, strict=True):
        assert force[at].sum() / force.sum() == pytest.approx(r.share, abs=0.05)
        assert r.share - r.time > 0.1
    assert force[inside[0] | inside[1]].sum() > 0.8 * force.sum()
    assert not (inside[0] & inside[1]).any()


def test_high_speeds_are_in_both_directions() -> None:
    acts = found("quadratic_damping")[1]
    assert [r.variable for r in acts] == [Variable.XDOT] * 2
    assert sorted(np.sign([r.low + r.high for r in acts]).tolist()) == [-1.0, 1.0]

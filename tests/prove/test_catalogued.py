"""What the proof takes for catalogued is what the catalogue holds, with no second list."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from by_hand import signals
from results import document, key, sealed

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import DIRECTIONS
from erdctl.effects import catalogue, get, names
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.paper import QUANTITIES
from erdctl.plant import twins
from erdctl.plant.plan import draw_plan
from erdctl.prove import catalogued
from erdctl.prove.case import Wish, check
from erdctl.prove.catalogued import nameable, no_model_has, right_names, structures
from erdctl.prove.judge import scored
from erdctl.prove.score import Errors

OWN = catalogue()
ERRORS = Errors(5.0, 1.4, 1.0, 100.0)
# What the plant can hide and the package's catalogue has no file for, whatever that is by now.
STRANGER, OTHER = [n for n in twins.names() if n not in nameable()][:2]


def added(name: str, **more: object) -> Effect:
    """Some effect under another name, as a file or another package would add it."""
    return replace(get("coulomb_friction"), name=name, **more)  # type: ignore[arg-type]  # fields by name


@pytest.fixture
def catalogue(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    """The package's own effects and one more."""
    monkeypatch.setattr(catalogued, "catalogue", lambda: (*OWN, request.param))


def test_the_catalogue_alone_says_what_can_be_named() -> None:
    declared = {n for e in OWN for n in e.equivalents}
    assert nameable() == {*names(), *declared}
    assert STRANGER not in nameable()


@pytest.mark.parametrize("catalogue", [added(STRANGER)], indirect=True)
def test_a_twin_whose_effect_was_added_is_no_stranger(catalogue: None) -> None:
    plan = draw_plan(7, known=nameable(), effects=[STRANGER])
    assert (plan.kind, plan.known) == ("single", (True,))
    sealed_key = key((STRANGER, 3.0))
    right = scored(sealed(), document("explained", (STRANGER,)), sealed_key, ERRORS)
    assert (right.named, right.spurious, right.matched) == (True, 0, 1)
    other = scored(sealed(), document("explained", ("backlash",)), sealed_key, ERRORS)
    assert (other.named, other.spurious) == (False, 1)
    assert [e.name for e in structures(STRANGER)] == [STRANGER]


@pytest.mark.parametrize("catalogue", [added(STRANGER)], indirect=True)
def test_unknown_cases_never_hide_what_the_catalogue_has(catalogue: None) -> None:
    drawn = [draw_plan(s, known=nameable(), kind="unknown") for s in range(120)]
    assert not {e.name for p in drawn for e in p.effects} & nameable()
    check(Wish(effects=(STRANGER,), kind="single"), range(2))
    with pytest.raises(UsageProblem, match=f"{STRANGER} in a case of kind unknown"):
        check(Wish(effects=(STRANGER,), kind="unknown"), range(2))


@pytest.mark.parametrize("catalogue", [added("valve", equivalents=(OTHER,))], indirect=True)
def test_an_effect_without_a_twin_is_right_for_what_it_says_it_equals(catalogue: None) -> None:
    assert OTHER in nameable()
    assert [e.name for e in structures(OTHER)] == ["valve"]
    result = scored(sealed(), document("explained", ("valve",)), key((OTHER, 3.0)), ERRORS)
    assert (result.named, result.spurious) == (True, 0)
    with pytest.raises(UsageProblem, match="the plant has no twin of that name"):
        check(Wish(effects=("valve",)), range(1))


def test_names_that_are_right_come_from_plant_and_catalogue_together() -> None:
    assert right_names("mount_compliance") == ("fluid_compressibility",)
    assert right_names("mount_compliance", ("drift",)) == ("drift", "fluid_compressibility")
    assert right_names("force_offset") == ("gas_preload",)  # declared from the other side
    assert right_names("backlash") == ()
    polytropic = right_names("gas_preload", beside=["gas_polytropic", "backlash"])
    assert polytropic == ("force_offset", "gas_polytropic")  # which has a preload of its own


def test_the_best_that_can_be_reached_has_the_bounds_of_neither_of_two_alike() -> None:
    """A hidden preload below 0 was refitted as 0, so that 389,116 % of what can be were removed."""
    assert [e.name for e in structures("gas_preload")] == ["gas_preload", "force_offset"]
    assert [e.name for e in structures("force_offset")] == ["force_offset", "gas_preload"]
    assert [e.name for e in structures("backlash")] == ["backlash"]


def test_a_stranger_has_no_right_name() -> None:
    said = document("explained", ("backlash",))
    result = scored(sealed(), said, key(("stranger", 3.0), kind="unknown"), ERRORS)
    assert result.named is None
    assert result.spurious == 1
    assert math.isfinite(result.level)


def test_what_no_model_holds_beside_a_spring_is_known() -> None:
    spring = get("mount_compliance")
    s = signals(np.cos(np.arange(40) / 3.0), x=0.01 * np.sin(np.arange(40) / 3.0), duty=0.3)
    values = {f"{d}.{q}": v.start for d in DIRECTIONS for q, v in QUANTITIES.items()}
    values |= {spring.key("s_m"): 1e-6}
    another = "fluid_compressibility"
    assert no_model_has({another}, Model((spring,)), s, values)
    assert not no_model_has({another, "backlash"}, Model((spring,)), s, values)
    assert not no_model_has({another}, Model(()), s, values)

"""Twins: found by file, complete, and one file each, also with physics of their own."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module, invalidate_caches
from pathlib import Path
from pkgutil import iter_modules
from types import SimpleNamespace

import numpy as np
import pytest
from places import ROOT
from plant_rig import DAMPER, EVERY, effect, hidden, over, plain, samples

from erdctl.effects import names
from erdctl.plant import draw, twins
from erdctl.plant.plan import draw_plan
from erdctl.plant.simulate import forces

UNIT = re.compile(r"1|(kg|m|s|N|K|V|Hz|rad|J)?[0-9]?([ /](kg|m|s|N|K|V|Hz|rad|J)[0-9]?)*")

# A twin in one file, as CONTRIBUTING has it: the yield force hunts with time, a spring creeps.
FILE = '''"""Yield force times 1 + s sin(2 pi f t), and a force s k x beside it."""

import numpy as np

from erdctl.plant.hooks import Array, FineGrid, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _yielding(grid: FineGrid, p: Values) -> Array:
    return 1.0 + p["depth"] * np.sin(2 * np.pi * p["rate"] * grid.t)


def _force(F: Array, grid: FineGrid, p: Values) -> Array:
    return F + p["depth"] * 50.0 * grid.x


HOOKS = Hooks("hunting_field", yielding=_yielding, force=_force)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, depth=s, rate=q["rate"])


TWIN = Twin(
    name="hunting_field", family="ripple", part="yielding", low=1e-4, start=0.1, high=0.9,
    build=_build, shows={"own.depth": "1", "own.rate": "Hz"}, shape={"rate": (0.5, 2.0)},
    rigid=True,
)
'''


def forget() -> None:
    invalidate_caches()
    twins.names.cache_clear()
    twins.get.cache_clear()


@pytest.fixture
def added(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A twin's file beside the others, for the length of a test."""
    (tmp_path / "hunting_field.py").write_text(FILE)
    monkeypatch.setattr(twins, "__path__", [*twins.__path__, str(tmp_path)])
    forget()
    yield "hunting_field"
    monkeypatch.undo()
    sys.modules.pop("erdctl.plant.twins.hunting_field", None)
    forget()


def own_effects() -> list[str]:
    return [m.name for m in iter_modules([str(ROOT / "erdctl" / "effects")])]


def test_every_effect_of_the_package_has_a_twin() -> None:
    missing = [name for name in own_effects() if name not in twins.names()]
    assert not missing, (
        f"effects without a twin in the plant: {', '.join(missing)}; "
        f"add erdctl/plant/twins/NAME.py, see the docstring of erdctl.plant.twins"
    )


@pytest.mark.parametrize("name", EVERY)
def test_a_twin_is_complete(name: str) -> None:
    twin = effect(name)
    assert twin.name == name
    assert twin.family
    assert twin.part in {"", "gas", "viscous", "yielding"}
    assert 0.0 < twin.low < twin.start < twin.high
    assert name not in twin.equivalents
    assert len(set(twin.shows)) >= 1
    plant = hidden(name, twin.start)
    for path, unit in twin.shows.items():
        part, field = path.split(".")
        assert UNIT.fullmatch(unit), (path, unit)
        assert part == "own" or hasattr(getattr(plant, part), field)
    for own in plant.own:
        assert own.hooks.name == name
        assert {f"own.{symbol}" for symbol, _ in own.values} == set(twin.shows)
    # What goes by the rod's motion must say so, or it is paired with what moves otherwise.
    assert twin.rigid == (any(o.hooks.rigid for o in plant.own) or plant.outside != DAMPER.outside)
    assert twin.soft == (plant.physics.mount > 0.0 or plant.physics.fluid_spring > 0.0)


@pytest.mark.parametrize("name", EVERY)
def test_a_twin_has_its_law_in_words(name: str) -> None:
    doc = import_module(f"erdctl.plant.twins.{name}").__doc__
    assert doc
    assert doc.strip().endswith(".")


def test_a_seed_goes_on_hiding_what_it_hid() -> None:
    """The order of choice is kept, and what is new comes after it."""
    assert twins.names()[: len(twins.FIRST)] == twins.FIRST
    later = twins.names()[len(twins.FIRST) :]
    assert later == tuple(sorted(later))


def test_a_twin_is_one_file(added: str) -> None:
    assert twins.names()[-1] != added  # by name, after force_smoothing and before the p's
    assert added in twins.names()
    case = draw(5, effects=[added], known=[*names(), added], level=3.0)
    assert case.kind == "single"
    assert case.truth[0].catalogued
    assert case.level == pytest.approx(3.0, rel=0.12)
    assert case.truth[0].parameters["rate"][1] == "Hz"
    stranger = draw_plan(5, effects=[added], known=["backlash"])
    assert stranger.kind == "unknown"


def test_another_package_adds_a_twin(monkeypatch: pytest.MonkeyPatch) -> None:
    other = replace(twins.get("field_ripple"), name="rust")
    entry = SimpleNamespace(name="rust", load=lambda: other)
    monkeypatch.setattr(twins, "entry_points", lambda **asked: [entry])
    forget()
    try:
        assert "rust" in twins.names()[len(twins.FIRST) :]
        assert twins.get("rust") is other
        entry.name, entry.load = "moss", lambda: other
        with pytest.raises(TypeError, match="does not declare itself under that name"):
            twins.get("moss")
    finally:
        monkeypatch.undo()
        forget()
    with pytest.raises(KeyError):
        twins.get("rust")


def test_physics_of_its_own_is_what_the_file_says(added: str) -> None:
    """On the small campaign, against the same worked out from parts of the plain damper."""
    plant = hidden(added, 0.3)
    still = forces(DAMPER._replace(**{
        side: getattr(DAMPER, side)._replace(sigma=0.0) for side in ("compression", "release")
    }), over())  # fmt: skip
    n = over()[0].record.samples
    t = np.tile(np.arange(n) / 250.0, len(over()))
    swing = 1.0 + 0.3 * np.sin(2 * np.pi * 1.25 * t)
    expected = still + (plain() - still) * swing + 15.0 * samples().x
    np.testing.assert_allclose(forces(plant, over()), expected, atol=1e-9)


def test_physics_of_its_own_that_gives_no_numbers_is_refused(added: str) -> None:
    plant = hidden(added, float("nan"))
    with pytest.raises(ValueError, match=r"hunting_field: .* expected \(\d+,\) finite values"):
        forces(plant, over()[:1])


def test_rigid_twins_are_not_paired_with_soft_ones(added: str) -> None:
    soft = [n for n in EVERY if effect(n).soft]
    for seed in range(30):
        plan = draw_plan(seed, kind="pair", effects=[*soft, added, "backlash", "gas_preload"])
        assert len({e.name for e in plan.effects} & {*soft, added}) < 2
    both = hidden(added, 0.1).with_physics(mount=1e-5)
    with pytest.raises(ValueError, match="not modelled behind a spring"):
        forces(both, over()[:1])


def test_what_is_unknown_is_said_by_the_caller() -> None:
    outside = {"field_ripple", "stick_slip", "backlash", "bore_wear"}
    inside = [n for n in twins.names() if n not in outside]
    drawn = {draw_plan(s, kind="unknown", known=inside).effects[0].name for s in range(200)}
    assert drawn == outside
    more = [*inside, "field_ripple", "stick_slip"]
    drawn = {draw_plan(s, kind="unknown", known=more).effects[0].name for s in range(200)}
    assert drawn == outside - {"field_ripple", "stick_slip"}
    plan = draw_plan(3, effects=["field_ripple"], known=more)
    assert (plan.kind, plan.known) == ("single", (True,))
    with pytest.raises(ValueError, match="the catalogue has it"):
        draw_plan(3, kind="unknown", effects=["field_ripple"], known=more)
    with pytest.raises(ValueError, match="its kind is unknown"):
        draw_plan(3, kind="single", effects=["field_ripple"], known=inside)
    with pytest.raises(ValueError, match="the plant has no twin of that name"):
        draw_plan(3, effects=["rust"], known=[*inside, "rust"])


def test_a_catalogue_that_has_everything_leaves_nothing_unknown() -> None:
    assert "unknown" not in {draw_plan(s, known=twins.names()).kind for s in range(60)}
    with pytest.raises(ValueError, match="nothing is unknown"):
        draw_plan(0, kind="unknown", known=twins.names())

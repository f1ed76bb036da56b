"""Scores, checked by hand on made-up findings and keys."""

from __future__ import annotations

import pytest
from results import REGION, document, key, sealed

from erdctl.prove.judge import places, scored
from erdctl.prove.score import (
    Errors,
    Found,
    HiddenEffect,
    Interval,
    Naming,
    band,
    located,
    matches,
    naming,
)

MOUNT = HiddenEffect("mount", 3.0, ("fluid",))
ERRORS = Errors(5.0, 1.4, 1.0, 100.0)


@pytest.mark.parametrize(
    ("level", "name"),
    [(10.0, ">= 2"), (2.0, ">= 2"), (1.99, "1 to 2"), (1.0, "1 to 2"), (0.2, "0.2 to 1"),
     (0.19, "< 0.2")],
)  # fmt: skip
def test_bands(level: float, name: str) -> None:
    assert band(level) == name


@pytest.mark.parametrize(
    ("found", "right"),
    [
        (Found("mount"), True),
        (Found("fluid"), True),  # the same to a force channel at the rod
        (Found("rub", ("mount",)), True),
        (Found("rub", ("drift", "mount")), True),  # three names
        (Found("rub", ("drift", "mount", "skew")), False),  # four: says too little
        (Found("mount", ("drift", "rub", "skew")), True),  # the first name is right all the same
        (Found("rub"), False),
        (Found("rub", ("fluid",)), False),  # the truth itself must be in the list
    ],
)
def test_what_counts_as_named(found: Found, right: bool) -> None:
    assert matches(found, MOUNT) is right


@pytest.mark.parametrize(
    ("names", "hidden", "expected"),
    [
        (["a", "b"], ["a", "b"], Naming(first=True, matched=2, spurious=0, redundant=0)),
        (["b", "a"], ["a", "b"], Naming(first=True, matched=2, spurious=0, redundant=0)),
        (["c", "a"], ["a"], Naming(first=False, matched=1, spurious=1, redundant=0)),
        (["a", "c", "d"], ["a"], Naming(first=True, matched=1, spurious=2, redundant=0)),
        (["a"], ["a", "b"], Naming(first=True, matched=1, spurious=0, redundant=0)),
        ([], ["a"], Naming(first=False, matched=0, spurious=0, redundant=0)),
        (["a"], [], Naming(first=False, matched=0, spurious=1, redundant=0)),
    ],
)
def test_findings_against_truth(names: list[str], hidden: list[str], expected: Naming) -> None:
    assert naming([Found(n) for n in names], [HiddenEffect(h, 3.0) for h in hidden]) == expected


def test_one_finding_stands_for_one_effect() -> None:
    both = [HiddenEffect("a", 3.0), HiddenEffect("b", 3.0)]
    assert naming([Found("a", ("b",))], both).matched == 1
    # The first finding could be either; the second can only be a.
    assert naming([Found("a", ("b",)), Found("a")], both).matched == 2
    twice = naming([Found("mount"), Found("fluid")], [MOUNT])
    assert twice == Naming(first=True, matched=1, spurious=0, redundant=1)


@pytest.mark.parametrize(
    ("place", "right"),
    [
        (Interval("xdot", -0.01, 0.01), True),
        (Interval("xdot", 0.0, 0.01), True),  # 0.01 of 0.02 is a half
        (Interval("xdot", 0.006, 0.02), False),  # 0.004 of 0.03 is 0.13
        (Interval("xdot", -0.03, 0.03), True),  # 0.02 of 0.06 is a third
        (Interval("xdot", -0.035, 0.035), False),  # 0.02 of 0.07 is 0.29
        (Interval("x", -0.01, 0.01), False),
    ],
)
def test_overlap_with_the_true_region(place: Interval, right: bool) -> None:
    assert located([place], [REGION]) is right


def test_a_place_that_covers_most_of_the_range_points_at_nothing() -> None:
    wide = {**REGION, "width": 0.5}  # the range is 0.04
    assert located([Interval("xdot", -0.012, 0.012)], [wide]) is True  # 0.6 of it
    assert located([Interval("xdot", -0.013, 0.013)], [wide]) is False
    assert located([Interval("xdot", -0.01, 0.01)], []) is None
    assert located([], [REGION]) is False


def test_the_part_of_the_error_removed() -> None:
    assert ERRORS.removed == pytest.approx(0.9)
    assert ERRORS.nrmse(ERRORS.corrected) == pytest.approx(0.014)
    assert Errors(5.0, 6.0, 1.0, 100.0).removed == pytest.approx(-0.25)
    assert Errors(5.0, 1.0, None, 100.0).removed is None
    assert Errors(5.0, 5.0, 5.0, 100.0).removed is None  # nothing there to remove


def test_a_single() -> None:
    where = {"variable": "xdot", "low": 0.0, "high": 0.01}
    said = document("explained", ("rub", "drift"), places=[where])
    r = scored(sealed(), said, key(("drift", 1.5), regions=[REGION]), ERRORS)
    assert (r.named, r.matched, r.spurious, r.located) == (True, 1, 0, True)
    assert (r.verdict, r.motion, r.colour) == ("explained", "exact", "white")
    assert r.first_place is True
    assert places(said) == [Interval("xdot", 0.0, 0.01)]


def test_the_first_place_is_one_of_the_misfit_or_of_the_effect() -> None:
    speed = {"variable": "xdot", "low": -0.01, "high": 0.01}
    stroke = {"variable": "x", "low": 0.02, "high": 0.03}
    acts = {"effect_regions": [REGION | stroke]}
    for listed, more, right in (
        ([speed, stroke], {}, True),
        ([stroke, speed], {}, False),
        ([stroke, speed], acts, True),
        ([], {}, False),
    ):
        truth = key(("rub", 3.0), regions=[REGION], **more)
        r = scored(sealed(), document("explained", ("rub",), places=listed), truth, ERRORS)
        assert r.first_place is right
        assert r.located is bool(listed)  # by any of them, and by the misfit alone
    nowhere = scored(sealed(), document("explained", ("rub",)), key(("rub", 3.0)), ERRORS)
    assert nowhere.first_place is None


def test_what_the_rig_s_check_names_and_mends_needs_no_finding() -> None:
    said = document("adequate") | {"rig": [{"code": "velocity_noise"}, {"code": "force_gain"}]}
    r = scored(sealed(), said, key(("velocity_noise", 2.0)), ERRORS)
    assert (r.named, r.matched, r.spurious) == (True, 1, 0)
    r = scored(sealed(), said, key(("rub", 2.0)), ERRORS)
    assert (r.named, r.matched, r.spurious) == (False, 0, 0)


def test_nothing_and_strangers_have_no_name() -> None:
    null = scored(sealed(), document("explained", ("rub",)), key(kind="null"), ERRORS)
    assert (null.named, null.spurious, null.located) == (None, 1, None)
    stranger = key(("stranger", 4.0), kind="unknown", motion_noise={"kind": "savgol"})
    r = scored(sealed(), document("unexplained"), stranger, ERRORS)
    assert (r.named, r.spurious, r.motion) == (None, 0, "measured")


def test_in_a_crowd_the_strong_one_has_to_be_first() -> None:
    crowd = key(("rub", 6.0), ("drift", 0.5), ("mount", 0.4), kind="crowded", strong="rub")
    faint = scored(sealed(), document("explained", ("drift",), ("rub",)), crowd, ERRORS)
    assert (faint.named, faint.matched, faint.spurious) == (False, 2, 0)
    strong = scored(sealed(), document("explained", ("rub",), ("stick",)), crowd, ERRORS)
    assert (strong.named, strong.matched, strong.spurious) == (True, 1, 1)


def test_a_check_of_the_rig_stands_before_no_finding() -> None:
    """A faint noise of the velocity, that the rig's check mends, is no first name."""
    rig = {"rig": [{"code": "velocity_noise"}]}
    crowd = key(("rub", 6.0), ("velocity_noise", 0.3), kind="crowded", strong="rub")
    found = scored(sealed(), document("explained", ("rub",)) | rig, crowd, ERRORS)
    assert (found.named, found.matched, found.spurious) == (True, 2, 0)
    missed = scored(sealed(), document("explained", ("drift",)) | rig, crowd, ERRORS)
    assert (missed.named, missed.matched, missed.spurious) == (False, 1, 1)


def test_what_a_sparse_diagnosis_prints_is_held_against_the_plant() -> None:
    """Only of a model that is the plant's, and with the law's own value of a paper's parameter."""
    side = {"k_nom": 100.0, "c_vis": 10.0, "T_d": 0.02, "sigma": 5.0, "beta": 1.0}
    plant = {"damper": {"compression": side, "release": side}}
    law = {"F_c": 2.0, "compression.c_vis": 12.0}
    k = key(("coulomb_friction", 4.0), kind="sparse", law=law, **plant)

    def value(value: float, stderr: float | None) -> dict[str, float | str | None]:
        return {"value": value, "stderr": stderr}

    up = {n: value(v, None) for n, v in side.items()} | {"c_vis": value(11.0, 0.6)}
    down = {n: value(v, None) for n, v in side.items()} | {"k_nom": value(97.0, 1.0)}
    friction = value(1.0, None) | {"interval": [0.5, 2.5]}
    effects = [{"effect": "coulomb_friction", "parameters": {"F_c": friction}}]
    params = {"schema": "erdctl.parameters/1", "compression": up, "release": down}
    corrected = {"corrected": {"params": params | {"effects": effects}}}
    said = document("explained", ("coulomb_friction",)) | corrected
    printed = scored(sealed(), said, k, ERRORS).printed
    assert {p.parameter: p.holds for p in printed} == {
        "compression.c_vis": True,  # 12 is within 11 +- 1.96 0.6
        "release.k_nom": False,  # 100 is not within 97 +- 1.96
        "coulomb_friction.F_c": True,  # 2 is within 0.5 to 2.5
    }
    other = document("explained", ("stribeck_friction",)) | corrected
    assert scored(sealed(), other, k, ERRORS).printed == ()
    unlike = key(("coulomb_friction", 4.0), kind="sparse", law=None, **plant)
    assert scored(sealed(), said, unlike, ERRORS).printed == ()
    cannot = scored(sealed(), said | {"cannot_tell": True}, k, ERRORS)
    assert cannot.cannot_tell

"""How far a learned law goes, in words: bumps, dips, ends that are alike."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from erdctl.diagnose.learning.stage import _law
from erdctl.diagnose.learning.words import law_text
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot

END = 0.014
BUMP = {"m": 3e-3, "w": 1.5e-3}


def said(slot: LawSlot, values: dict[str, float], form: str | None = None) -> str:
    """Of a curve over the deflection, a closed form or one through values at even knots."""
    law = Law(slot, Curve("x", tuple(np.linspace(-END, END, max(len(values), 2)).tolist()), form))
    effect = law.effect
    finding = SimpleNamespace(
        effect=effect, gain=SimpleNamespace(gain=0.5), before=0.04, after=0.02, test=None
    )
    selection = cast(Any, SimpleNamespace(look_alikes={effect.name: []}))
    found = _law(selection, cast(Any, finding), {effect.key(s): v for s, v in values.items()})
    return law_text(found).partition(": with it")[0].partition("deflection, ")[2]


def through(slot: LawSlot, *f: float) -> str:
    """The same through values at even knots."""
    return said(slot, {f"f_{k + 1}": v for k, v in enumerate(f)})


def test_a_bump_is_said_with_its_place() -> None:
    """It was "from 6.96e-22 N at -14 mm to 6.96e-22 N at 14 mm", as if there were none."""
    assert said(LawSlot.FRICTION, {"a": 3.6, **BUMP}, "bell") == (
        "from 0 N at -14 mm to 0 N at 14 mm, between 0 and 3.6 N, the largest at 3.01 mm"
    )


def test_a_dip_is_said_with_its_place() -> None:
    assert said(LawSlot.FORCE, {"a": -3.6, **BUMP}, "bell") == (
        "from 0 N at -14 mm to 0 N at 14 mm, between -3.6 and 0 N, the smallest at 3.01 mm"
    )
    assert said(LawSlot.YIELD, {"a": -0.5, **BUMP}, "bell") == (
        "by +0 % from -14 mm to 14 mm, between -50 and +0 % of itself at its reference,"
        " the smallest at 3.01 mm"
    )


@pytest.mark.parametrize("more", [0.0, 1e-12, -1e-12, 1e-3])
def test_ends_that_are_nearly_alike(more: float) -> None:
    text = through(LawSlot.FORCE, 1.0, 3.0, 1.0 + more)
    assert text == "from 1 N at -14 mm to 1 N at 14 mm, between 1 and 3 N, the largest at 0 mm"


def test_what_turns_twice_has_two_places() -> None:
    text = through(LawSlot.FORCE, 0.0, -2.0, 0.0, 2.0, 0.0)
    assert "the smallest at -7" in text
    assert "and the largest at 7" in text


def test_what_only_rises_is_told_by_its_ends() -> None:
    assert through(LawSlot.FORCE, 1.0, 2.0, 3.0) == "from 1 N at -14 mm to 3 N at 14 mm"
    assert through(LawSlot.VISCOUS, 0.0, 0.1, 0.2) == "by +20 % from -14 mm to 14 mm"

"""Learned laws in documents: what a parameter file needs to act by one."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import msgspec

from erdctl.core.errors import InputProblem
from erdctl.model.learned.coordinates import KINDS
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.forms import FORMS
from erdctl.model.learned.law import Law, LawSlot

NAME = "learned"  # of the effect that a law is, in a parameter file


class LawCoordinate(msgspec.Struct):
    """What a law depends on; one that remembers has a parameter `tau` [s]."""

    name: str


class LawDocument(msgspec.Struct, omit_defaults=True, kw_only=True):
    """A curve over a coordinate, in a slot of the model.

    A spline (natural, cubic) goes through its parameters f_1, f_2, ... at the `knots`, and is 0 at
    the first where `zero_first`; a closed form has two: the ends of the range in which it was seen.
    Outside of the knots the curve stays at its end value. In SI units.
    """

    slot: str
    coordinates: list[LawCoordinate]
    form: str = "spline"
    knots: list[float]
    zero_first: bool = False


def to_law(document: LawDocument, where: str, file: str) -> Law:
    """The law of a document; `where` it stands there is for messages."""

    def known(name: str, names: Any, what: str) -> str:
        if name not in names:
            raise InputProblem(
                f"{where}: unknown {what} '{name}'; known are {', '.join(names)}", file=file
            )
        return name

    if len(document.coordinates) != 1:
        raise InputProblem(
            f"{where}: expected one coordinate, found {len(document.coordinates)}", file=file
        )
    given = known(document.coordinates[0].name, KINDS, "coordinate")
    spline = document.form == "spline"
    form = None if spline else known(document.form, FORMS, "form")
    knots = document.knots
    rising = all(a < b for a, b in pairwise(knots))
    count = len(knots) > 2 if spline else len(knots) == 2
    if not (rising and count and all(map(math.isfinite, knots))):
        expected = "three rising numbers or more" if spline else "two rising numbers"
        raise InputProblem(f"{where}.knots: expected {expected}", file=file)
    slot = LawSlot(known(document.slot, [s.value for s in LawSlot], "slot"))
    zero_first = spline and document.zero_first
    return Law(slot, Curve(given, tuple(knots), form, zero_first))


def to_law_document(law: Law) -> LawDocument:
    """The document of a law."""
    curve = law.curve
    return LawDocument(
        slot=law.slot.value,
        coordinates=[LawCoordinate(curve.coordinate)],
        form=curve.form or "spline",
        knots=list(curve.knots),
        zero_first=curve.zero_first,
    )

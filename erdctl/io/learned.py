"""Learned laws in documents: what a parameter file needs to act by one."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import msgspec

from erdctl.core.errors import InputProblem

if TYPE_CHECKING:  # most parameter files have no law
    from erdctl.model.learned.law import Law

NAME = "learned"  # of the effect that a law is, in a parameter file


class LawCoordinate(msgspec.Struct, omit_defaults=True):
    """What a law depends on; one that remembers has a parameter `tau` [s], or [m] of travel.

    knots : of the second coordinate of two
    """

    name: str
    knots: list[float] = []


class LawDocument(msgspec.Struct, omit_defaults=True, kw_only=True):
    """A curve over a coordinate, or a surface over two, in a slot of the model.

    A spline (natural, cubic) goes through its parameters f_1, f_2, ... at the `knots`, and is 0 at
    the first where `zero_first`; a closed form has two: the ends of the range in which it was seen.
    Over two coordinates there is a value f_i_j at the knots i of the first and j of the second one.
    Outside of the knots a spline stays at its end value; a closed form goes on, as far as two times
    that range and three times what it is at its ends. In SI units.
    """

    slot: str
    coordinates: list[LawCoordinate]
    form: str = "spline"
    knots: list[float]
    zero_first: bool = False


def to_law(document: LawDocument, where: str, file: str) -> Law:
    """The law of a document; `where` it stands there is for messages."""
    from erdctl.model.learned.coordinates import KINDS
    from erdctl.model.learned.curve import Curve
    from erdctl.model.learned.forms import FORMS
    from erdctl.model.learned.law import Law, LawSlot
    from erdctl.model.learned.surface import Surface

    def known(name: str, names: Any, what: str) -> str:
        if name not in names:
            raise InputProblem(
                f"{where}: unknown {what} '{name}'; known are {', '.join(names)}", file=file
            )
        return name

    if len(document.coordinates) not in (1, 2):
        raise InputProblem(
            f"{where}: expected one coordinate or two, found {len(document.coordinates)}", file=file
        )
    names = [known(c.name, KINDS, "coordinate") for c in document.coordinates]
    spline = document.form == "spline"
    form = None if spline else known(document.form, FORMS, "form")
    two = len(names) == 2

    def knots(given: list[float], least: int, of: str) -> tuple[float, ...]:
        rising = all(a < b for a, b in pairwise(given))
        count = len(given) >= least if spline else len(given) == 2
        if not (rising and count and all(map(math.isfinite, given))):
            words = {2: "two", 3: "three"}[least] + " rising numbers or more"
            expected = words if spline else "two rising numbers"
            raise InputProblem(f"{where}.{of}: expected {expected}", file=file)
        return tuple(given)

    first = knots(document.knots, 2 if two else 3, "knots")
    slot = LawSlot(known(document.slot, [s.value for s in LawSlot], "slot"))
    zero_first = spline and document.zero_first
    if not two:
        return Law(slot, Curve(names[0], first, form, zero_first))
    if not spline or KINDS[names[1]].late:
        raise InputProblem(
            f"{where}: over two coordinates only a spline is known, and the second has no memory",
            file=file,
        )
    second = Curve(names[1], knots(document.coordinates[1].knots, 2, "coordinates.2.knots"))
    return Law(slot, Surface(names[0], first, zero_first=zero_first, across=second))


def to_law_document(law: Law) -> LawDocument:
    """The document of a law."""
    curve = law.curve
    return LawDocument(
        slot=law.slot.value,
        coordinates=[
            LawCoordinate(curve.coordinate),
            *(LawCoordinate(axis.coordinate, list(axis.knots)) for axis in curve.axes[1:]),
        ],
        form=curve.form or "spline",
        knots=list(curve.knots),
        zero_first=curve.zero_first,
    )

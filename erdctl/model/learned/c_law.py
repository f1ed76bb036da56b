"""A learned law as C: its coordinates from sample to sample, its curve, and what that does.

Where Python sees the whole record and C cannot, see `c_coordinates`. Besides,

    deflection   xdot -> xdot + (f(z + dz) - f(z - dz)) / 2 h

with dz what the coordinate changes by in a step h at the slope that it has at the sample: for one
that goes with the motion, the difference that Python takes between the samples before and after, to
second order in h. A coordinate that jumps moves the piston there, and gives it no velocity.
"""

from __future__ import annotations

from textwrap import indent
from typing import TYPE_CHECKING

from erdctl.model.c_law import CLaw
from erdctl.model.learned.c_coordinates import WRITTEN, CCoordinate
from erdctl.model.learned.c_curve import CCurve, curve_in_c
from erdctl.model.learned.law_slot import LEAST_LAG, LawSlot

if TYPE_CHECKING:
    from erdctl.model.learned.law import Law

NAMES = ("first", "second")  # the coordinates
PLACES = ("at", "by")  # of a curve on them
NOTES = {
    "passes": "passes are counted over parts of the stroke so far, not of the whole record's",
    "temperature": "the temperature is told, not logged",
}
MOVED = "the velocity of a learned deflection is that at the sample, not a mean over two steps"

# Motion in a chain of laws of the joint, as a sample of its own.
_WITHIN = """\
Sample own = *s;
within(&own, m, z->past);
s = &own;"""
# The duty is that which the laws before this one leave.
_LED = """\
Sample own = *s;
own.duty = duty;
s = &own;"""


def c_law(law: Law) -> CLaw:
    """The C of a law."""
    slot, moves = law.slot, law.slot is LawSlot.DEFLECTION
    axes = [
        WRITTEN[axis.coordinate].named(name, axis.range, moves=moves)
        for name, axis in zip(NAMES, law.curve.axes, strict=False)
    ]
    curve = curve_in_c(law.curve, law.unit)
    code = _deflection(axes, curve) if moves else _acts(slot, axes, curve, law.curve.kind.least)
    more = ("past[4]",) if moves else ("held",) if slot is LawSlot.DUTY else ()
    notes = [NOTES[axis.coordinate] for axis in law.curve.axes if axis.coordinate in NOTES]
    return CLaw(
        code="" if slot.adds else code,
        force=code if slot.adds else "",
        state=tuple(member for axis in axes for member in axis.state) + more,
        told=tuple(told for axis in axes for told in axis.told),
        note="; ".join([*notes, *([MOVED] if moves else [])]),
    )


def _coordinates(axes: list[CCoordinate]) -> str:
    """Variables of the coordinates, with their values at the sample."""
    names = NAMES[: len(axes)]
    return "\n".join([f"real {', '.join(names)};", *(axis.code for axis in axes)])


def _value(axes: list[CCoordinate], curve: CCurve) -> str:
    """The curve at the coordinates, as `value`."""
    places = [f"real {at} = {name};" for at, name in zip(PLACES, NAMES[: len(axes)], strict=False)]
    return "\n".join([_coordinates(axes), curve.declared, *places, "real value;", curve.code])


def _acts(slot: LawSlot, axes: list[CCoordinate], curve: CCurve, least: float) -> str:
    value = _value(axes, curve)
    if slot is LawSlot.DUTY:
        # What acts over the step that has ended was decided as it began.
        end = "z->held = clipped((K(1.0) + value) * duty, K(0.0), K(1.0));\nreturn z->held;"
        return "\n".join(["if (!s->ahead && !s->first) return z->held;", _LED, value, end])
    if slot is LawSlot.LAG:
        return f"{value}\nreturn FMAX(K(1.0) + value, K({LEAST_LAG!r}));"
    if slot.adds:
        return f"{value}\nreturn value{' * s->sign' if slot is LawSlot.FRICTION else ''};"
    factors = [f"f->{group} *= value;" for group in slot.groups]
    return "\n".join([value, f"value = FMAX(K(1.0) + value, K({least!r}));", *factors])


def _deflection(axes: list[CCoordinate], curve: CCurve) -> str:
    """The curve at the coordinates, and a step before and after at the slope that they have."""
    pairs = list(zip(PLACES, NAMES, axes, strict=False))
    steps = [f"const real {name}_step = {axis.step};" for _, name, axis in pairs]
    places = [f"real {at} = {name} + (real)(k - 1) * {name}_step;" for at, name, _ in pairs]
    return "\n".join(
        [
            _WITHIN,
            _coordinates(axes),
            "const real h = s->first ? K(1e-3) : s->h;",
            *steps,
            curve.declared,
            "real value, values[3];",
            "int k;",
            "for (k = 0; k < 3; ++k) {",
            indent("\n".join([*places, curve.code, "values[k] = value;"]), "    "),
            "}",
            "m->x += values[1];",
            "m->xdot += (values[2] - values[0]) / (K(2.0) * h);",
        ]
    )

"""Functions of C that hold what effects do, and their calls."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from erdctl.export.c.names import identifier
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect
from erdctl.model.slots import (
    ControlSlot,
    DrivenSlot,
    FeedbackSlot,
    FieldSlot,
    GasSlot,
    HysteresisSlot,
    LagSlot,
    MotionSlot,
    ScaleSlot,
    SeriesSlot,
    SignSlot,
    Slot,
    ViscousSlot,
    YieldSlot,
)

WIDTH = 100  # of a line of C


class Head(NamedTuple):
    """Of the function that holds an effect's body: what it returns and is given besides p, z, s."""

    returns: str
    given: tuple[str, ...] = ()
    sample: bool = True


HEADS: dict[type[Slot], Head] = {
    MotionSlot: Head("void", ("Motion *m",)),
    ControlSlot: Head("real", ("real duty",)),
    FieldSlot: Head("real", ("real field", "int way")),
    LagSlot: Head("real"),
    SignSlot: Head("real"),
    ViscousSlot: Head("real"),
    GasSlot: Head("real"),
    HysteresisSlot: Head("real", ("real sign",)),
    YieldSlot: Head("real", ("real force",)),
    ScaleSlot: Head("void", ("Groups *f",)),
    FeedbackSlot: Head("void", ("const Groups *force", "Groups *f")),
    DrivenSlot: Head("real", ("const Groups *force",)),
    SeriesSlot: Head("real", sample=False),
}
TERM = Head("real")
PLAY = Head("real", sample=False)


def law_of(effect: Effect) -> CLaw:
    """Its C. An effect without is refused before."""
    assert effect.c is not None
    return effect.c


def functions(effects: Iterable[Effect], *, springs: bool, plays: bool) -> str:
    """What each effect does, in functions of its own.

    springs : with what a spring in series asks of them
    plays : with free plays, which one of the whole damper takes over
    """
    out: list[str] = []
    for effect in effects:
        c = law_of(effect)
        if c.code:
            out.append(_function("law", effect, HEADS[type(effect.slot)], c.code))
        if c.force:
            out.append(_function("force", effect, TERM, c.force))
        if c.by and springs:
            out.append(_function("by", effect, TERM, c.by))
        if c.damping:
            out.append(_function("damping", effect, PLAY, c.damping))
        if c.play and plays:
            out.append(_function("play", effect, PLAY, c.play))
    return "\n\n".join(out)


def _function(kind: str, effect: Effect, head: Head, body: str) -> str:
    name = identifier(effect.name)
    given = [f"const struct PREFIX_{name}_params *p"]
    if head.sample:
        given += [f"struct PREFIX_{name}_state *z"] if law_of(effect).state else []
        given += [f"struct PREFIX_{name}_past *w"] if law_of(effect).past else []
        given += ["const Sample *s"]
    return function(f"{head.returns} {kind}_{name}", [*given, *head.given], body)


def function(head: str, given: Sequence[str], body: str) -> str:
    """A static function; what it is given and does not use is marked so, against warnings."""
    text = textwrap.indent(textwrap.dedent(body).strip("\n"), "    ")
    names = [one.split()[-1].lstrip("*") for one in given]
    unused = [n for n in names if not re.search(rf"\b{n}\b", text)]
    marks = f"    {' '.join(f'(void){n};' for n in unused)}\n" if unused else ""
    first = f"static {head}("
    whole = ", ".join(one.replace(" ", "\0") for one in given)  # a line ends between two of them
    arguments = textwrap.wrap(whole, WIDTH - len(first), break_long_words=False)
    listed = f"\n{' ' * len(first)}".join(arguments).replace("\0", " ")
    return f"{first}{listed})\n{{\n{marks}{text}{chr(10) if text else ''}}}"


def call(kind: str, effect: Effect, *given: str, state: str = "") -> str:
    """The call of one of these functions, in one that has `st` and `s`."""
    name = identifier(effect.name)
    arguments = [f"&st->p.{name}"]
    if law_of(effect).state:
        arguments.append(f"&st->{name}{state}")
    if law_of(effect).past:
        arguments.append(f"&s->keeper->{name}_past{state}")
    return f"{kind}_{name}({', '.join([*arguments, 's', *given])})"

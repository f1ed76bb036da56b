"""The functions of a block that its effects fill: one for each place where an effect may act."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from erdctl.core.errors import IncompatibleEffects
from erdctl.export.c.names import identifier
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, in_slot
from erdctl.model.slots import (
    ControlSlot,
    DrivenSlot,
    FeedbackSlot,
    FieldSlot,
    GasSlot,
    LagSlot,
    MotionSlot,
    ScaleSlot,
    SeriesSlot,
    SignSlot,
    Slot,
    ViscousSlot,
    YieldSlot,
)


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


def functions(effects: Iterable[Effect], *, plays: bool) -> str:
    """What each effect does, in functions of its own.

    plays : with free plays, which a spring in series takes over
    """
    out: list[str] = []
    for effect in effects:
        c = law_of(effect)
        if c.code:
            out.append(_function("law", effect, HEADS[type(effect.slot)], c.code))
        if c.force:
            out.append(_function("force", effect, TERM, c.force))
        if c.play and plays:
            out.append(_function("play", effect, PLAY, c.play))
    return "\n\n".join(out)


def _function(kind: str, effect: Effect, head: Head, body: str) -> str:
    name, given = (
        identifier(effect.name),
        [f"const struct PREFIX_{identifier(effect.name)}_params *p"],
    )
    unused = ["p"]
    if head.sample:
        if law_of(effect).state:
            given.append(f"struct PREFIX_{name}_state *z")
            unused.append("z")
        given.append("const Sample *s")
        unused.append("s")
    given += head.given
    unused += [g.split()[-1].lstrip("*") for g in head.given]
    lines = textwrap.indent(textwrap.dedent(body).strip(), "    ").splitlines()
    marks = " ".join(f"(void){u};" for u in unused)
    # Declarations may follow in a body, as C99 has it.
    text = "\n".join([f"    {marks}", *lines])
    return f"static {head.returns} {kind}_{name}({', '.join(given)})\n{{\n{text}\n}}"


def call(kind: str, effect: Effect, *given: str, state: str = "") -> str:
    """The call of one of these functions, in one that has `st` and `s`."""
    name = identifier(effect.name)
    arguments = [f"&st->p.{name}"]
    if law_of(effect).state:
        arguments.append(f"&st->{name}{state}")
    return f"{kind}_{name}({', '.join([*arguments, 's', *given])})"


def hooks(effects: Sequence[Effect], *, plays: bool) -> str:
    """The functions that call them, in the order in which effects of one slot act.

    plays : a compliance in series takes over the free play of joints while it acts
    """

    def of(kind: type[Slot]) -> list[Effect]:
        return [effect for effect, _ in in_slot(effects, kind)]

    scales = of(ScaleSlot)
    terms = [e for e in effects if law_of(e).force]
    rows = [f"    sum += {call('force', e)};" for e in terms]
    feedback = [_fed_back(e) for e in of(FeedbackSlot)]
    lags = []
    for effect, slot in in_slot(effects, LagSlot):
        lags += ["    one = " + call("law", effect) + ";", "    *falls *= one;"]
        lags += ["    *rises *= one;"] if slot.rising else []
    fields = [call("law", e, "value", "way", state="[way]") for e in of(FieldSlot)]
    return "\n\n".join([
        _hook("void motion", "Motion *m", _moved(of(MotionSlot), plays=plays)),
        _hook(
            "real control", "real duty",
            [f"    duty = {call('law', e, 'duty')};" for e in of(ControlSlot)],
            "duty",
        ),
        _hook(
            "real field", "real value, int way",
            [f"    value = {one};" for one in fields],
            "value",
        ),
        _hook(
            "void lags", "real *rises, real *falls",
            ["    real one = K(1.0);", "", "    *rises = *falls = one;", *lags, "    (void)one;"],
        ),
        _place("gas_law", of(GasSlot), "s->x", "gas"),
        _place("viscous_law", of(ViscousSlot), "s->xdot", "viscous"),
        _place("sign_law", of(SignSlot), "s->sign", "sign"),
        _hook(
            "real yield_law", "real force",
            [f"    force = {call('law', e, 'force')};" for e in of(YieldSlot)],
            "force",
        ),
        _hook("void scale", "Groups *f", _scaled(scales, of_speed=False)),
        _hook("void of_speed", "Groups *f", _scaled(scales, of_speed=True)),
        _hook("void feedback", "Groups *force", feedback),
        _hook("real terms", "", ["    real sum = K(0.0);", "", *rows], "sum"),
        _hook(
            "real driven", "const Groups *force",
            ["    real sum = K(0.0);", ""]
            + [f"    sum += {call('law', e, 'force')};" for e in of(DrivenSlot)],
            "sum",
        ),
    ])  # fmt: skip


def _hook(head: str, given: str, lines: Sequence[str], result: str = "") -> str:
    marks = "(void)st; (void)s;"
    for one in given.split(",") if given else ():
        marks += f" (void){one.split()[-1].lstrip('*')};"
    end = [f"    return {result};"] if result else []
    body = [*lines[:1], *lines[1:], f"    {marks}", *end]
    arguments = ", ".join(["State *st", "const Sample *s", *([given] if given else [])])
    return "\n".join([f"static {head}({arguments})", "{", *body, "}"])


def _place(name: str, laws: Sequence[Effect], plain: str, what: str) -> str:
    if len(laws) > 1:
        names = ", ".join(e.name for e in laws)
        raise IncompatibleEffects(f"only one effect can take the place of {what}: {names}")
    return _hook(f"real {name}", "", [], call("law", laws[0]) if laws else plain)


def _moved(laws: Sequence[Effect], *, plays: bool) -> list[str]:
    out = []
    for effect in laws:
        joint = plays and bool(law_of(effect).play)
        out += ["    if (!(compliance(st) > K(0.0)))"] if joint else []
        out += [f"    {'    ' if joint else ''}{call('law', effect, 'm')};"]
    return out


def _scaled(scales: Sequence[Effect], *, of_speed: bool) -> list[str]:
    return [f"    {call('law', e, 'f')};" for e in scales if e.of_speed is of_speed]


def _fed_back(effect: Effect) -> str:
    return "\n".join([
        "    {",
        "        Groups f = {K(1.0), K(1.0), K(1.0)};",
        "",
        f"        {call('law', effect, 'force', '&f')};",
        "        force->gas *= f.gas;",
        "        force->viscous *= f.viscous;",
        "        force->yield *= f.yield;",
        "    }",
    ])  # fmt: skip

"""The functions of a block that its effects fill: one for each place where an effect may act."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.core.errors import IncompatibleEffects
from erdctl.export.c.functions import call, function, law_of
from erdctl.model.effect import Effect, in_slot
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
    SignSlot,
    Slot,
    ViscousSlot,
    YieldSlot,
)

AT = ("State *st", "const Sample *s")


def hooks(effects: Sequence[Effect], *, plays: bool) -> str:
    """The functions that call them, in the order in which effects of one slot act.

    plays : a compliance in series takes over the free play of joints while it acts
    """

    def of(kind: type[Slot]) -> list[Effect]:
        return [effect for effect, _ in in_slot(effects, kind)]

    scales = of(ScaleSlot)
    fields = [call("law", e, "value", "way", state="[way]") for e in of(FieldSlot)]
    remembers = any(law_of(e).state for e in of(FieldSlot))
    return "\n\n".join([
        f"enum {{ FIELD_REMEMBERS = {int(remembers)} }};  /* a law of the field has a past */",
        _hook("void motion", ["Motion *m"], _moved(of(MotionSlot), plays=plays)),
        _through("control", "duty", [call("law", e, "duty") for e in of(ControlSlot)]),
        _through("field", "value", fields, "int way"),
        _hook("void lags", ["real *rises", "real *falls"], _lags(effects)),
        _place("gas_law", of(GasSlot), "s->x"),
        _place("viscous_law", of(ViscousSlot), "s->xdot"),
        _place("sign_law", of(SignSlot), "s->sign"),
        _through("stretched", "sign", [call("law", e, "sign") for e in of(HysteresisSlot)]),
        _through("yield_law", "force", [call("law", e, "force") for e in of(YieldSlot)]),
        _hook("void scale", ["Groups *f"], _scaled(scales, of_speed=False)),
        _hook("void of_speed", ["Groups *f"], _scaled(scales, of_speed=True)),
        _hook("void feedback", ["Groups *force"], _fed_back(of(FeedbackSlot))),
        total("terms", [call("force", e) for e in effects if law_of(e).force]),
        total("driven", [call("law", e, "force") for e in of(DrivenSlot)], "const Groups *force"),
    ])  # fmt: skip


def _hook(head: str, given: Sequence[str], lines: Sequence[str]) -> str:
    return function(head, [*AT, *given], "\n".join(lines))


def _through(name: str, what: str, calls: Sequence[str], *given: str) -> str:
    """What laws make of a value, one after the other."""
    lines = [*(f"{what} = {one};" for one in calls), f"return {what};"]
    return _hook(f"real {name}", [f"real {what}", *given], lines)


def total(name: str, calls: Sequence[str], *given: str) -> str:
    """The sum of forces [N]."""
    lines = ["real sum = K(0.0);", "", *(f"sum += {one};" for one in calls), "return sum;"]
    return _hook(f"real {name}", given, lines)


def _place(name: str, laws: Sequence[Effect], plain: str) -> str:
    """What stands in the place of a signal of the piston: that itself, or an effect's."""
    if len(laws) > 1:
        what, names = name.removesuffix("_law"), ", ".join(e.name for e in laws)
        raise IncompatibleEffects(f"only one effect can take the place of {what}: {names}")
    return _hook(f"real {name}", [], [f"return {call('law', laws[0]) if laws else plain};"])


def _moved(laws: Sequence[Effect], *, plays: bool) -> list[str]:
    out = []
    for effect in laws:
        joint = plays and bool(law_of(effect).play)
        out += ["if (!(compliance(st) > K(0.0)))"] if joint else []
        out += [f"{'    ' if joint else ''}{call('law', effect, 'm')};"]
    return out


def _lags(effects: Sequence[Effect]) -> list[str]:
    laws = in_slot(effects, LagSlot)
    out = ["real one;", ""] if laws else []
    out += ["*rises = *falls = K(1.0);"]
    for effect, slot in laws:
        out += [f"one = {call('law', effect)};", "*falls *= one;"]
        out += ["*rises *= one;"] if slot.rising else []
    return out


def _scaled(scales: Sequence[Effect], *, of_speed: bool) -> list[str]:
    return [f"{call('law', e, 'f')};" for e in scales if e.of_speed is of_speed]


def _fed_back(laws: Sequence[Effect]) -> list[str]:
    """Each with the forces that those before it leave."""
    out = ["Groups f;", ""] if laws else []
    for effect in laws:
        out += [
            "f.gas = f.viscous = f.yield = K(1.0);",
            f"{call('law', effect, 'force', '&f')};",
            *(f"force->{group} *= f.{group};" for group in ("gas", "viscous", "yield")),
        ]
    return out

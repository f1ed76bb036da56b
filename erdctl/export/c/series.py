"""A compliance in series, in C: the march of `erdctl.model.series_compliance`."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.core.errors import IncompatibleEffects
from erdctl.export.c.functions import call, function, law_of
from erdctl.export.c.hooks import AT, total
from erdctl.export.c.layout import CMember
from erdctl.export.c.names import identifier, part
from erdctl.model.behind_spring import FASTEST, masses, refuse, sliding
from erdctl.model.effect import Effect, in_slot
from erdctl.model.parameters import Parameters
from erdctl.model.slots import FeedbackSlot, HysteresisSlot, SeriesSlot, SignSlot, YieldSlot


def spring_of(effects: Sequence[Effect]) -> Effect | None:
    """The effect that puts a compliance in series.

    Raises IncompatibleEffects where a model cannot have it, for the reasons of a simulation.
    """
    springs = [e for e, _ in in_slot(effects, SeriesSlot)]
    if not springs:
        return None
    if len(springs) > 1:
        raise IncompatibleEffects("only one compliance can be in series")
    refuse(effects)
    return springs[0]


def whole(spring: Effect) -> bool:
    """Whether it is in series with the whole damper."""
    assert isinstance(spring.slot, SeriesSlot)
    return spring.slot.carries is None


def fastest(parameters: Parameters) -> CMember:
    """The speed that the grid of speeds behind the spring is made for."""
    ranges = dict(parameters.provenance.get("ranges", {}))
    ends = [abs(float(e)) for e in ranges.get("xdot", ())]
    return CMember(
        "fastest", max([FASTEST, *ends]), "m/s",
        "highest speed of the rod: the laws behind the spring are tabulated up to four times of it",
    )  # fmt: skip


def march(spring: Effect, effects: Sequence[Effect]) -> str:
    """The functions of the march.

    For every effect that is made from the forces the model marches once more, with the factors
    of those before it, as `Prepared` does.
    """
    feedback = [e for e, _ in in_slot(effects, FeedbackSlot)]
    lines = []
    for number, effect in enumerate(feedback):
        lines += [
            "    to = joint_of(st, s, &gain, besides);",
            f"    force = march(st, &st->spring[{number}], &to, s, x, u);",
            f"    parts = behind(st, &st->spring[{number}], &to, s, x, force);",
            f"    {call('law', effect, '&parts', '&gain')};",
        ]
    inside = [e for e in effects if e.of_speed and law_of(e).force]
    slides = sliding(effects) if whole(spring) else None
    carried = [e for e in effects if law_of(e).force and e.carried and whole(spring)]
    known = [e for e in carried if e not in inside and (not slides or e is not slides[0])]
    outside = [e for e in effects if law_of(e).force and e not in carried]
    text = "\n\n".join(
        [
            f"enum {{ WHOLE = {int(whole(spring))} }};  /* in series with all, or the fluid */",
            total("friction", [call("force", e) for e in inside if whole(spring)]),
            total("beside", [call("force", e) for e in known]),
            *_sliding(slides),
            _mass(effects if whole(spring) else ()),
            *_of_the_sign(effects),
            total("outside", [call("force", e) for e in outside]),
            part("spring.c").strip(),
        ]
    )
    text = text.replace("@FEEDBACK@", "".join(f"{line}\n" for line in lines))
    return text.replace("@LAST@", str(len(feedback)))


def _of_the_sign(effects: Sequence[Effect]) -> list[str]:
    """What else the yield force is made from than F_ER sign(v), as `behind_spring.other` has it."""
    signs, yields = in_slot(effects, SignSlot), in_slot(effects, YieldSlot)
    stretched = in_slot(effects, HysteresisSlot)
    asked = {
        "sign_lead": [_parameter(e, slot.lead) for e, slot in signs if slot.lead],
        "yield_time": [_parameter(e, slot.time) for e, slot in yields if slot.time],
        "yield_travel": [_parameter(e, slot.travel) for e, slot in stretched],
    }
    by = [call("by", e) for e, slot in signs if slot.by]
    other = bool(by or any(asked.values()))
    return [
        f"enum {{ OTHER = {int(other)} }};  /* the yield force is not F_ER sign(v) alone */",
        *(
            function(f"real {name}", ["const State *st"], f"return {(found or ['K(0.0)'])[0]};")
            for name, found in asked.items()
        ),
        function("real sign_by", [*AT], f"return {(by or ['K(1.0)'])[0]};"),
    ]


def _sliding(found: tuple[Effect, str, str] | None) -> list[str]:
    """The friction that follows the piston's direction over its travel, if any does."""
    force, travel = "K(0.0)", "K(1.0)"
    if found is not None:
        effect, *symbols = found
        force, travel = (_parameter(effect, symbol) for symbol in symbols)
    return [
        f"enum {{ SLIDES = {int(found is not None)} }};  /* a friction builds up over a travel */",
        function("real slide_force", ["const State *st"], f"return {force};"),
        function("real slide_travel", ["const State *st"], f"return {travel};"),
    ]


def _mass(effects: Sequence[Effect]) -> str:
    """What goes with the piston."""
    sum_ = " + ".join(_parameter(e, symbol) for e, symbol in masses(effects)) or "K(0.0)"
    return function("real piston_mass", ["const State *st"], f"return {sum_};")


def _parameter(effect: Effect, symbol: str) -> str:
    return f"st->p.{identifier(effect.name)}.{symbol}"


def joint(spring: Effect, effects: Sequence[Effect]) -> str:
    """What is asked of the spring: compliance, damping, and the free play that it takes over."""
    p = f"&st->p.{identifier(spring.name)}"
    plays = [e for e in effects if law_of(e).play and whole(spring)]
    lines = [f"gap += play_{identifier(e.name)}(&st->p.{identifier(e.name)});" for e in plays]
    return "\n\n".join([
        function(
            "real compliance", ["const State *st"], f"return law_{identifier(spring.name)}({p});"
        ),
        function(
            "real spring_damping", ["const State *st"],
            f"return damping_{identifier(spring.name)}({p});" if law_of(spring).damping
            else "return K(0.0);",
        ),
        function(
            "real free_play", ["const State *st"],
            "\n".join(["real gap = K(0.0);", "", *lines, "return gap;"]),
        ),
    ])  # fmt: skip


def state(effects: Sequence[Effect]) -> str:
    """Members of the state."""
    marches = 1 + len(in_slot(effects, FeedbackSlot))
    return part("spring_state.h").replace("@MARCHES@", str(marches))

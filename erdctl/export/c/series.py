"""A compliance in series, in C: the march of `erdctl.model.series_compliance`."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.core.errors import IncompatibleEffects
from erdctl.export.c.functions import call, function, law_of
from erdctl.export.c.hooks import total
from erdctl.export.c.layout import CMember
from erdctl.export.c.names import identifier, part
from erdctl.model.effect import Effect, in_slot
from erdctl.model.parameters import Parameters
from erdctl.model.slots import FeedbackSlot, SeriesSlot, SignSlot, ViscousSlot, YieldSlot

FASTEST = 1.0  # m/s, where the logs do not say


def spring_of(effects: Sequence[Effect]) -> Effect | None:
    """The effect that puts a compliance in series.

    Raises IncompatibleEffects where a model cannot have it, for the reasons of a simulation.
    """
    springs = [e for e, _ in in_slot(effects, SeriesSlot)]
    if not springs:
        return None
    if len(springs) > 1:
        raise IncompatibleEffects("only one compliance can be in series")
    if in_slot(effects, YieldSlot):
        raise IncompatibleEffects("a yield force with memory cannot act behind a spring")
    for effect in effects:
        if isinstance(effect.slot, SignSlot | ViscousSlot) and not effect.of_speed:
            raise IncompatibleEffects(
                f"{effect.name} cannot act behind a spring: no law of speed alone"
            )
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
        "fastest", max(ends, default=FASTEST), "m/s",
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
            "    to = joint_of(st, &gain);",
            f"    force = march(st, &st->spring[{number}], &to, s, x, u);",
            f"    parts = behind(st, &st->spring[{number}], &to, s, x, force);",
            f"    {call('law', effect, '&parts', '&gain')};",
        ]
    inside = [e for e in effects if e.of_speed and law_of(e).force]
    outside = [e for e in effects if law_of(e).force and not (whole(spring) and e in inside)]
    text = "\n\n".join(
        [
            f"enum {{ WHOLE = {int(whole(spring))} }};  /* in series with all, or the fluid */",
            total("friction", [call("force", e) for e in inside if whole(spring)]),
            total("outside", [call("force", e) for e in outside]),
            part("spring.c").strip(),
        ]
    )
    text = text.replace("@FEEDBACK@", "".join(f"{line}\n" for line in lines))
    return text.replace("@LAST@", str(len(feedback)))


def joint(spring: Effect, effects: Sequence[Effect]) -> str:
    """What the motion asks of the spring: its compliance, and the free play that it takes over."""
    p = f"&st->p.{identifier(spring.name)}"
    plays = [e for e in effects if law_of(e).play and whole(spring)]
    lines = [f"gap += play_{identifier(e.name)}(&st->p.{identifier(e.name)});" for e in plays]
    return "\n\n".join([
        function(
            "real compliance", ["const State *st"], f"return law_{identifier(spring.name)}({p});"
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

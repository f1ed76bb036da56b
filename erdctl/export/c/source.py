"""C99 source of a damper, from its parameters."""

from __future__ import annotations

from dataclasses import dataclass

from erdctl.core.errors import UsageProblem
from erdctl.export.c import series
from erdctl.export.c.functions import functions
from erdctl.export.c.hooks import hooks
from erdctl.export.c.layout import (
    CMember,
    defaults,
    effect_members,
    first_past,
    paper_members,
    parameter_struct,
    past_structs,
    state_structs,
)
from erdctl.export.c.names import helpers, identifier, part
from erdctl.export.c.provenance import about
from erdctl.export.c.told import told, told_by, told_heads
from erdctl.export.damper_alone import of_the_bench
from erdctl.model.c_law import Told
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters


@dataclass(frozen=True)
class CBlock:
    """A damper in C.

    prefix : begins every name that others see;  header, source : text of PREFIX.h and PREFIX.c
    left_out : effects that the block has not, each with why, for people
    told : functions by which a program tells it more than motion, control and faults
    memory : member of the state from which on it is long memories, empty if it has none
    parameters : every member of PREFIX_params: path, value, unit and title
    """

    prefix: str
    header: str
    source: str
    left_out: tuple[str, ...]
    parameters: tuple[CMember, ...]
    told: tuple[Told, ...] = ()
    memory: str = ""


def write_c(parameters: Parameters, *, prefix: str) -> CBlock:
    """The block of a damper; the model without what belongs to its bench.

    prefix : made a name of C if it is none
    Raises UsageProblem for an effect that has no C.
    """
    prefix = identifier(prefix)
    effects, left_out = on_the_vehicle(parameters.model.effects)
    missing = [e.name for e in effects if e.c is None]
    if missing:
        raise UsageProblem(
            f"has no C: {', '.join(missing)}; its file declares none (`c=CLaw(...)` in EFFECT)"
        )
    spring = series.spring_of(effects)
    plays = spring is not None and series.whole(spring)
    paper = paper_members(parameters)
    paper += () if spring is None else (series.fastest(parameters),)
    own = [(e, effect_members(parameters, e)) for e in effects]
    members = (*paper, *(m for _, of in own for m in of))
    top = about(parameters, effects, left_out)

    header = part("header.h").replace("@GUARD@", f"{prefix.upper()}_H")
    header = header.replace("@PARAMETERS@", parameter_struct(paper, own))
    header = header.replace("@TOLD@", told_heads(effects))
    header = header.replace(
        "@STATES@",
        state_structs(effects)
        + ("" if spring is None else series.state(effects))
        + past_structs(effects),
    )
    body = [
        part("base.c"), functions(effects, springs=spring is not None, plays=plays),
        "" if spring is None else series.joint(spring, effects),
        hooks(effects, plays=plays), part("sample.c"), part("forces.c"),
        part("plain.c") if spring is None else series.march(spring, effects),
        defaults(members), part("interface.c"), told(effects),
    ]  # fmt: skip
    called = helpers("\n".join(body))
    pieces = [part("types.c"), *([called] if called else []), *body]
    source = "\n\n".join(piece.strip("\n") for piece in pieces if piece.strip())
    return CBlock(
        prefix=prefix,
        header=f"{top}\n{header}".replace("PREFIX", prefix),
        source=f"{top}\n{source}\n".replace("PREFIX", prefix),
        left_out=left_out,
        parameters=members,
        told=told_by(effects),
        memory=first_past(effects),
    )


def on_the_vehicle(effects: tuple[Effect, ...]) -> tuple[tuple[Effect, ...], tuple[str, ...]]:
    """The effects that belong to the damper, and what is left out because it belongs to a bench."""
    kept, left_out = [], []
    for effect in effects:
        if of_the_bench(effect):
            left_out.append(f"{effect.name}: {effect.title}; belongs to the bench")
        else:
            kept.append(effect.with_c())
    return tuple(kept), tuple(left_out)

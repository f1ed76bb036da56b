"""The structs of a block: parameters with their units, and what each effect remembers."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import NamedTuple

from erdctl.core.quantity import Quantity
from erdctl.core.recording import DIRECTIONS
from erdctl.export.c.names import comment, identifier, literal
from erdctl.model.effect import Effect
from erdctl.model.paper import QUANTITIES
from erdctl.model.parameters import Parameters
from erdctl.model.slots import FieldSlot


class CMember(NamedTuple):
    """A parameter of the block: path within the struct, value, unit and title."""

    path: str
    value: float
    unit: str
    title: str


def paper_members(parameters: Parameters) -> tuple[CMember, ...]:
    """Those of the paper's model, in either direction."""
    return tuple(
        CMember(
            f"{way}_{symbol}", parameters.values[f"{way}.{symbol}"], quantity.unit,
            f"{quantity.title}, in {way}",
        )
        for way in DIRECTIONS
        for symbol, quantity in QUANTITIES.items()
    )  # fmt: skip


def effect_members(parameters: Parameters, effect: Effect) -> tuple[CMember, ...]:
    """Those of an effect."""

    def member(q: Quantity) -> CMember:
        path = f"{identifier(effect.name)}.{identifier(q.symbol)}"
        return CMember(path, parameters.values[effect.key(q.symbol)], q.unit, q.title)

    return tuple(member(q) for q in effect.quantities)


def parameter_struct(
    paper: Sequence[CMember], effects: Sequence[tuple[Effect, Sequence[CMember]]]
) -> str:
    """The struct with all parameters, those of each effect in a struct of their own."""
    lines = ["typedef struct PREFIX_params {", *(_declared(m.path, m) for m in paper)]
    for effect, members in effects:
        name = identifier(effect.name)
        lines += [f"    struct PREFIX_{name}_params {{", *_remark(effect.equation)]
        lines += [f"    {_declared(m.path.partition('.')[2], m)}" for m in members]
        lines += [f"    }} {name};"]
    return "\n".join([*lines, "} PREFIX_params;"])


def _declared(name: str, member: CMember) -> str:
    return f"    PREFIX_real {name}; /* [{comment(member.unit)}] {comment(member.title)} */"


def _remark(text: str) -> list[str]:
    """A comment of as many lines as it needs."""
    lines = textwrap.wrap(f"/* {comment(text)} */", 88, break_long_words=False)
    return [f"        {' * ' if i else ''}{line}" for i, line in enumerate(lines)]


def state_structs(effects: Sequence[Effect]) -> str:
    """Members of the state for what effects remember; a field law has one for each direction."""
    lines: list[str] = []
    for effect in effects:
        if effect.c is None or not effect.c.state:
            continue
        name = identifier(effect.name)
        lines += [f"    struct PREFIX_{name}_state {{"]
        lines += [f"        PREFIX_real {member};" for member in effect.c.state]
        lines += [f"    }} {name}{'[2]' if isinstance(effect.slot, FieldSlot) else ''};"]
    return "".join(f"{line}\n" for line in lines)


def past_structs(effects: Sequence[Effect]) -> str:
    """The last member of the state: long memories, which a look ahead shares and does not copy."""
    kept = [(e, e.c.past) for e in effects if e.c is not None and e.c.past]
    if not kept:
        return ""
    lines = ["    /* Long memories, behind all else: a look ahead does not copy them. */"]
    for effect, past in kept:
        name = identifier(effect.name)
        lines += [f"    struct PREFIX_{name}_past {{"]
        lines += [f"        PREFIX_real {member};" for member in past]
        lines += [f"    }} {name}_past{'[2]' if isinstance(effect.slot, FieldSlot) else ''};"]
    return "".join(f"{line}\n" for line in lines)


def first_past(effects: Sequence[Effect]) -> str:
    """The member with which the long memories begin; empty if there are none."""
    return next((f"{identifier(e.name)}_past" for e in effects if e.c and e.c.past), "")


def defaults(members: Sequence[CMember]) -> str:
    """The function that fills in the identified values."""
    lines = [f"    p->{m.path} = {literal(m.value)};" for m in members]
    return "\n".join(["void PREFIX_defaults(PREFIX_params *p)", "{", *lines, "}"])

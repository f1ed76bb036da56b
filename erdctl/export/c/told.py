"""Functions by which a program tells a block more than motion, control and faults."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from erdctl.export.c.names import comment, identifier
from erdctl.model.c_law import Told
from erdctl.model.effect import Effect


def told_by(effects: Sequence[Effect]) -> tuple[Told, ...]:
    """What there is to tell, each once."""
    return tuple(tells[0][1] for tells in _by_name(effects).values())


def told_heads(effects: Sequence[Effect]) -> str:
    """Their declarations."""
    out = []
    for tells in _by_name(effects).values():
        first = tells[0][1]
        words = textwrap.wrap(comment(first.words), 94)
        out.append("/* " + "\n * ".join(words) + f" */\n{_head(first)};\n\n")
    return "".join(out)


def told(effects: Sequence[Effect]) -> str:
    """The functions; each reaches all effects that ask for it."""
    out = []
    for tells in _by_name(effects).values():
        first = tells[0][1]
        inner = [_inner(effect, tell) for effect, tell in tells]
        usable = " && ".join(f"usable({name}, HUGEST)" for name in first.given)
        calls = [
            f"        {_name(effect, tell)}(&st->p.{identifier(effect.name)},"
            f" &st->{identifier(effect.name)}, {', '.join(tell.given)});"
            for effect, tell in tells
        ]
        lines = [_head(first), "{", f"    if ({usable}) {{", *calls, "    }", "}"]
        out += [*inner, "\n".join(lines)]
    return "\n\n".join(out)


def _by_name(effects: Sequence[Effect]) -> dict[str, list[tuple[Effect, Told]]]:
    out: dict[str, list[tuple[Effect, Told]]] = {}
    for effect in effects:
        for tell in effect.c.told if effect.c is not None else ():
            out.setdefault(tell.name, []).append((effect, tell))
    return out


def _head(tell: Told) -> str:
    given = ", ".join(f"PREFIX_real {name}" for name in tell.given)
    return f"void PREFIX_{identifier(tell.name)}(PREFIX_state *st, {given})"


def _name(effect: Effect, tell: Told) -> str:
    return f"told_{identifier(tell.name)}_{identifier(effect.name)}"


def _inner(effect: Effect, tell: Told) -> str:
    name = identifier(effect.name)
    given = ", ".join(f"real {one}" for one in tell.given)
    body = textwrap.indent(tell.code, "    ")
    return (
        f"static void {_name(effect, tell)}(const struct PREFIX_{name}_params *p,"
        f" struct PREFIX_{name}_state *z, {given})\n{{\n    (void)p;\n{body}\n}}"
    )

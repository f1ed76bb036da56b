"""The paper's equations with the terms of some effects put in, as text.

Eq. 13 is taken as its three groups, and Eq. 12 as its steady value:

    F = gas + viscous + yield,  gas = k_nom x, viscous = c_vis xdot, yield = F_ER sign
    T_d dF_ER/dt + F_ER = sigma law,  law = v^beta

An effect says in `alters` what becomes of a piece (`gas`, `viscous`, `yield`, `sign`, `law`), with
{} for what stood there, or of a symbol (`v`, `x`, `xdot`). Forces that it adds are taken from its
own equation `F = ...`; what defines a new symbol is written below.
Check: a friction F_c sign(xdot) is one term more; a play g makes x_p of x, with q up to g/2 either
way, dq/dt = xdot between its flanks and 0 on them.
>>> from erdctl.effects import get
>>> for line in corrected_equation([get("coulomb_friction"), get("backlash")]): print(line)
F = k_nom x_p + c_vis xdot_p + F_ER sign(xdot_p) + F_c sign(xdot_p)
T_d dF_ER/dt + F_ER = sigma v^beta
x_p = x - q, |q| <= g/2, dq/dt = xdot in the play and 0 on its flanks
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from erdctl.model.effect import Effect
from erdctl.model.slots import (
    ControlSlot,
    FieldSlot,
    GasSlot,
    HysteresisSlot,
    MotionSlot,
    SeriesSlot,
    SignSlot,
    ViscousSlot,
    YieldSlot,
)

# In the order in which effects act on a piece; those of the motion come last, since all forces act
# on the piston's own motion.
ORDER = (GasSlot, ViscousSlot, SignSlot, HysteresisSlot, FieldSlot, ControlSlot, YieldSlot)
LAST = (MotionSlot, SeriesSlot)
PIECES = {"gas": "k_nom x", "viscous": "c_vis xdot", "yield": "F_ER {sign}", "sign": "sign(xdot)",
          "law": "v^beta"}  # fmt: skip
FORCE, LAG = "F", "T_d dF_ER/dt + F_ER"


def corrected_equation(effects: Sequence[Effect]) -> tuple[str, ...]:
    """Eqs. 13 and 12 with the effects put in, and below them what new symbols mean.

    A symbol of two effects bears the number of its effect among those given: n_1 and n_2.
    """
    pieces: dict[str, str] = dict(PIECES)
    below: list[str] = []
    added: list[str] = []
    motions: list[tuple[str, str]] = []
    for effect in sorted(_told_apart(effects), key=_order):
        own = _clauses(effect.equation)
        known = [c for c in own if "->" not in c and not c.startswith((f"{FORCE} =", f"{LAG} ="))]
        if not effect.alters and not effect.amplitudes:
            known = own
        elif not effect.alters:
            added += [c.removeprefix(f"{FORCE} =").strip() for c in own if c not in known]
        if known:
            # What an effect is applied to is what earlier ones have made of it.
            text = ", ".join(known)
            if {"viscous", "yield"} & set(dict(effect.alters)):
                text = _at_speed(text, r"c_vis (\w+)", pieces["viscous"])
                text = _at_speed(text, r"F_ER sign\((\w+)\)", _yield(pieces))
            if "sign" in dict(effect.alters):
                text = _at_speed(text, r"sign\((\w+)\)", pieces["sign"])
            below.append(text)
        for piece, becomes in effect.alters:
            if pieces.get(piece):
                pieces[piece] = becomes.replace("{}", _bracketed(pieces[piece], becomes))
            elif piece in pieces:
                pass  # what stood there is a part of another force by now
            elif piece == "v":
                pieces["law"] = _renamed(pieces["law"], piece, becomes)
            else:
                motions.append((piece, becomes))
                below[:-1] = [_renamed(line, piece, becomes) for line in below[:-1]]
    force = " + ".join(p for p in (pieces["gas"], pieces["viscous"], _yield(pieces), *added) if p)
    for piece, becomes in motions:
        force = _renamed(force, piece, becomes)
    force = force.replace("+ -", "- ")
    return (f"{FORCE} = {force}", f"{LAG} = sigma {pieces['law']}", *dict.fromkeys(below))


def _told_apart(effects: Sequence[Effect]) -> list[Effect]:
    """The effects, with those symbols numbered that several of them use."""
    used = Counter(q.symbol for e in effects for q in e.quantities)
    out = []
    for number, effect in enumerate(effects, start=1):
        for symbol in (q.symbol for q in effect.quantities if used[q.symbol] > 1):
            new = f"{symbol}_{number}"
            effect = replace(
                effect,
                equation=_renamed(effect.equation, symbol, new),
                alters=tuple((p, _renamed(b, symbol, new)) for p, b in effect.alters),
            )
        out.append(effect)
    return out


def _order(effect: Effect) -> tuple[int, int]:
    for place, kinds in enumerate((ORDER, LAST)):
        for i, kind in enumerate(kinds):
            if isinstance(effect.slot, kind):
                return (2 * place, i)
    return (1, 0)


def _yield(pieces: dict[str, str]) -> str:
    return pieces["yield"].replace("{sign}", pieces["sign"])


def _bracketed(piece: str, into: str) -> str:
    """A sum in brackets where something is put in front of it."""
    return f"[{piece}]" if into != "{}" and len(split(piece, " + ")) > 1 else piece


def _renamed(text: str, symbol: str, becomes: str) -> str:
    """A symbol as another, but not where it is a part of a longer one."""
    return re.sub(rf"(?<![\w.]){symbol}(?!\w)", lambda match: becomes, text)


def _at_speed(text: str, paper: str, now: str) -> str:
    """What the paper has for a force at some speed, as it is now, at that speed."""
    return re.sub(paper, lambda match: _renamed(now, "xdot", match.group(1)), text)


def _clauses(equation: str) -> list[str]:
    return [c.strip() for part in split(equation, ";") for c in split(part, ",")]


def split(text: str, at: str) -> list[str]:
    """A text at separators outside of brackets.

    >>> split("a, b(c, d)", ",")
    ['a', ' b(c, d)']
    """
    out, depth, start = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "([") - (c in ")]")
        if depth == 0 and text.startswith(at, i):
            out.append(text[start:i])
            start = i + len(at)
    return [*out, text[start:]]

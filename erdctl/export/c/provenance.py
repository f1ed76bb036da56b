"""The comment on top of a source: what it is, where it comes from, what it has not."""

from __future__ import annotations

import hashlib
import textwrap
from collections.abc import Sequence

from erdctl.core.recording import DIRECTIONS
from erdctl.core.version import __version__
from erdctl.export.c.names import comment
from erdctl.export.origin import identified
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters
from erdctl.model.slots import ControlSlot, FieldSlot

AHEAD = "without T_d, the step ahead is taken to be as long as the last"


def hash_of(parameters: Parameters) -> str:
    """SHA-256 of the values, by their names: the same for the same model."""
    text = "\n".join(f"{name} {value!r}" for name, value in sorted(parameters.values.items()))
    return hashlib.sha256(text.encode()).hexdigest()


def looking_ahead(parameters: Parameters, effects: Sequence[Effect]) -> list[str]:
    """Effects that make a mean over the step ahead, where no T_d lets the force wait for it.

    With a T_d the force of a sample is made from the step that has ended.
    """
    if any(parameters.values[f"{d}.T_d"] > 0.0 for d in DIRECTIONS):
        return []
    held = [e for e in effects if isinstance(e.slot, ControlSlot | FieldSlot)]
    return [e.name for e in held if e.c is not None and e.c.state]


def about(parameters: Parameters, effects: Sequence[Effect], left_out: Sequence[str]) -> str:
    """The comment block."""
    lines = [
        "PREFIX: force of an electro-rheological damper from its motion and control.",
        "",
        "    F = k_nom x + c_vis xdot + F_ER sign(xdot),  T_d dF_ER/dt + F_ER = sigma v^beta",
        "",
        *(f"with {e.name}: {e.equation}" for e in effects),
        f"Written by erdctl {__version__}",
        f"SHA-256 of the parameters: {hash_of(parameters)}",
        *(f"{line[0].upper()}{line[1:]}" for line in identified(parameters)),
    ]
    lines += [f"Left out: {what}" for what in left_out]
    lines += [f"{e.name}, in C: {e.c.note}" for e in effects if e.c is not None and e.c.note]
    lines += [f"{name}, in C: {AHEAD}" for name in looking_ahead(parameters, effects)]
    lines += [f"Note: {caveat}" for caveat in parameters.caveats()]
    lines += ["C99; needs <math.h> only. -DERDCTL_FLOAT takes float in place of double."]
    out = []
    for line in lines:
        text = line if line.startswith("    ") else comment(line)
        out += textwrap.wrap(text, 96, subsequent_indent="    ", break_long_words=False,
                             drop_whitespace=True, replace_whitespace=False) or [""]  # fmt: skip
    return "\n".join(["/*", *(f" * {line}".rstrip() for line in out), " */"])

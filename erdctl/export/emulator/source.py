"""The C of the online emulator, put together from its `parts/`.

The parts are C as it stands but for a few places: PREFIX, and @...@, which are filled here.
"""

from __future__ import annotations

import textwrap
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from erdctl.core.errors import UsageProblem
from erdctl.core.version import __version__
from erdctl.export.c.layout import CMember
from erdctl.export.c.names import comment, identifier, literal
from erdctl.export.c.provenance import hash_of
from erdctl.export.c.source import on_the_vehicle
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.emulator.model_part import declared, model_part
from erdctl.export.origin import identified
from erdctl.model.faults import FaultKind
from erdctl.model.parameters import Parameters

COMMON = ("numbers.c", "amplifier.c", "motion.c")
LAST = ("step.c", "entries.c")
ALL = tuple(FaultKind)
INCLUDES = '#include <math.h>\n\n#include "PREFIX.h"\n\n'


@dataclass(frozen=True)
class EmulatorBlock:
    """The emulator as C: two texts that compile by themselves, and what a wrapper must know.

    parameters : every member of PREFIX_params
    faults : whose factors count; those of the others are ignored
    left_out : effects that it does not know, each with why, for people
    """

    prefix: str
    header: str
    source: str
    parameters: tuple[CMember, ...]
    faults: tuple[FaultKind, ...]
    left_out: tuple[str, ...] = ()


def write_emulator(
    parameters: Parameters,
    *,
    prefix: str,
    faults: Collection[FaultKind] = ALL,
    limits: EmulatorLimits | None = None,
    remarks: Collection[str] = (),
) -> EmulatorBlock:
    """The online emulator of a damper as `PREFIX.h` and `PREFIX.c`.

    prefix : begins all names that can be seen, made a name of C if it is none
    faults : that can be emulated
    remarks : what else is left out, for the comment on top

    Raises UsageProblem without any fault, and for an effect that has no C.
    """
    prefix = identifier(prefix)
    chosen = tuple(kind for kind in FaultKind if kind in faults)
    if not chosen:
        raise UsageProblem("an emulator needs a fault: oil, electrical or deformation")
    model, own = model_part(parameters, prefix), limit_members(limits or EmulatorLimits())
    members = (*model.members, *own)
    places = {
        "@DAMPER@": model.before,
        "@GUARD@": f"{prefix.upper()}_H",
        "@REAL@": model.real,
        "@MEMBERS@": "\n".join((*model.declared, *map(declared, own))),
        "@WANTED@": part(model.wanted) if model.wanted else "",
        "@YIELDING@": model.yielding,
        "@OBSERVED@": part(model.state).rstrip(),
        "@COPIED@": model.copied,
        "@DEFAULTS@": "\n".join(f"    p->{m.path} = {literal(m.value)};" for m in members),
        "@USABLE@": "\n".join(
            f"        && within(p->{m.path}, K(-1e30), K(1e30))" for m in model.members
        ),
        "@FAULTS@": "\n".join(
            f"    s->f_{k.short} = factor(s, s->f_{k.short}, f_{k.short});"
            if k in chosen
            else f"    (void)f_{k.short}; /* not exported */"
            for k in FaultKind
        ),
    }
    types = model.types or INCLUDES + part("types.c")
    body = [*map(part, COMMON), part(model.code), *map(part, LAST)]
    top = about(parameters, chosen, (*model.left_out, *remarks))
    return EmulatorBlock(
        prefix=prefix,
        header=filled(f"{top}\n\n{part('emulator.h')}", places, prefix),
        source=filled(f"{top}\n\n{types}" + "".join(body), places, prefix),
        parameters=members,
        faults=chosen,
        left_out=model.left_out,
    )


def limit_members(limits: EmulatorLimits) -> tuple[CMember, ...]:
    """The members of PREFIX_params that are limits."""
    a = limits.amplifier
    return (
        CMember("duty_max", a.duty_max, "1", "highest duty"),
        CMember("resolution", a.resolution, "1", "smallest step of the duty, 0 for none"),
        CMember("slew", limits.slew, "1/s", "fastest change of the duty, 0 for no limit"),
        CMember("update_period", limits.update_period, "s", "between changes, at least; 0 for any"),
        CMember("temperature_max", limits.temperature_max, "degC", "closes the output above it"),
        CMember(
            "temperature_hysteresis", limits.temperature_hysteresis, "K", "it opens that much below"
        ),
    )


@cache
def part(name: str) -> str:
    """A fixed part of the source."""
    return (files("erdctl.export.emulator") / "parts" / name).read_text(encoding="utf-8")


def filled(text: str, places: dict[str, str], prefix: str) -> str:
    """A text with what belongs into its places."""
    for place, lines in places.items():
        text = text.replace(place, lines)
    return text.replace("PREFIX", prefix)


def about(parameters: Parameters, chosen: Collection[FaultKind], remarks: Collection[str]) -> str:
    """The comment on top: what it is, where it comes from, what it has not."""
    effects = on_the_vehicle(parameters.model.effects)[0]
    lines = [
        "PREFIX: online fault emulator of an electro-rheological damper (Eqs. 12, 13, 24-35): the"
        " healthy damper under duty_out has the force of a faulty one. From what has been measured"
        " so far alone.",
        f"Faults: {', '.join(k.short for k in chosen)}.",
        *([f"The damper has {', '.join(e.name for e in effects)}."] if effects else []),
        f"Written by erdctl {__version__}",
        f"SHA-256 of the parameters: {hash_of(parameters)}",
        *(f"{line[0].upper()}{line[1:]}" for line in identified(parameters)),
        *(f"Left out: {what}" for what in remarks),
        "C99; needs <math.h> only. -DERDCTL_FLOAT takes float in place of double. Not with"
        " -ffast-math: it would take NaN for a number.",
    ]
    out = [
        text
        for line in lines
        for text in textwrap.wrap(
            comment(line), 96, subsequent_indent="    ", break_long_words=False
        )
    ]
    return "\n".join(["/*", *(f" * {line}" for line in out), " */"])

"""The C of the online emulator, put together from its `parts/`.

The parts are C as it stands but for three places: PREFIX, and @...@ lines that are written here.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from importlib import resources

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import DIRECTIONS
from erdctl.core.version import __version__
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.model.faults import FaultKind
from erdctl.model.paper import QUANTITIES
from erdctl.model.parameters import Parameters

PARTS = ("numbers", "amplifier", "inverse", "motion", "step", "entries")
ALL = tuple(FaultKind)


@dataclass(frozen=True)
class Member:
    """One tunable number of the block.

    path : within PREFIX_params;  value : its default in `unit`;  title : in words
    """

    path: str
    value: float
    unit: str
    title: str


@dataclass(frozen=True)
class EmulatorBlock:
    """The emulator as C: two texts that compile by themselves, and what a wrapper must know.

    parameters : every member of PREFIX_params
    faults : whose factors count; those of the others are ignored
    """

    prefix: str
    header: str
    source: str
    parameters: tuple[Member, ...]
    faults: tuple[FaultKind, ...]


def write_emulator(
    parameters: Parameters,
    *,
    prefix: str,
    faults: Collection[FaultKind] = ALL,
    limits: EmulatorLimits | None = None,
    remarks: Collection[str] = (),
) -> EmulatorBlock:
    """The online emulator of a damper as `PREFIX.h` and `PREFIX.c`.

    prefix : a C identifier, of the names of all that can be seen;  faults : that can be emulated
    remarks : lines for the comment on top

    Raises UsageProblem for a prefix that is no identifier, or without any fault.
    """
    if not (prefix.isidentifier() and prefix.isascii()):
        raise UsageProblem(f"{prefix!r} is no name in C: letters, digits and _ only")
    chosen = tuple(kind for kind in FaultKind if kind in faults)
    if not chosen:
        raise UsageProblem("an emulator needs a fault: oil, electrical or deformation")
    found = members(parameters, limits or EmulatorLimits())
    places = {
        "@MEMBERS@": "\n".join(
            f"    PREFIX_real {m.path}; /* [{m.unit}] {m.title} */" for m in found
        ),
        "@DEFAULTS@": "\n".join(f"    p->{m.path} = K({float(m.value)!r});" for m in found),
        "@FAULTS@": "\n".join(
            f"    s->f_{k.short} = factor(s, s->f_{k.short}, f_{k.short});"
            if k in chosen
            else f"    (void)f_{k.short}; /* not exported */"
            for k in FaultKind
        ),
    }
    top = _top(parameters, chosen, remarks)
    header = top + _filled(_part("emulator.h"), places, prefix)
    source = top + _filled("".join(_part(f"{name}.c") for name in PARTS), places, prefix)
    return EmulatorBlock(prefix, header, source, found, chosen)


def members(parameters: Parameters, limits: EmulatorLimits) -> tuple[Member, ...]:
    """The members of PREFIX_params, with their values."""
    values, a = parameters.values, limits.amplifier
    found = [
        Member(f"{d}_{symbol}", values[f"{d}.{symbol}"], q.unit, f"{q.title}, {d}")
        for d in DIRECTIONS
        for symbol, q in QUANTITIES.items()
    ]
    return (
        *found,
        Member("duty_max", a.duty_max, "1", "highest duty"),
        Member("resolution", a.resolution, "1", "smallest step of the duty, 0 for none"),
        Member("slew", limits.slew, "1/s", "fastest change of the duty, 0 for no limit"),
        Member("update_period", limits.update_period, "s", "between changes, at least; 0 for any"),
        Member("temperature_max", limits.temperature_max, "degC", "above it the output is closed"),
        Member(
            "temperature_hysteresis", limits.temperature_hysteresis, "K", "it opens that much below"
        ),
    )


def _part(name: str) -> str:
    return (resources.files("erdctl.export.emulator") / "parts" / name).read_text(encoding="utf-8")


def _filled(text: str, places: dict[str, str], prefix: str) -> str:
    for place, lines in places.items():
        text = text.replace(place, lines)
    return text.replace("PREFIX", prefix)


def _top(parameters: Parameters, chosen: Collection[FaultKind], remarks: Collection[str]) -> str:
    lines = [
        "Online fault emulator of an electro-rheological damper, Eqs. 12, 13 and 24-35:"
        " the healthy damper, driven by duty_out, acts as a faulty one.",
        f"Written by erdctl {__version__}; do not edit, export again.",
        f"Faults: {', '.join(k.short for k in chosen)}.",
        *remarks,
    ]
    return "/* " + "\n   ".join(line.replace("*/", "* /") for line in lines) + " */\n\n"

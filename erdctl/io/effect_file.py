"""A learned law as source code: the file of an effect, and that of its test.

What is written is for an engineer to go on with: equation, parameters with bounds, starts and off
values are those of the law; what it is called, and its source in the literature, nobody learned.
"""

from __future__ import annotations

import builtins
import keyword
import re
import sys
from dataclasses import replace
from importlib.util import find_spec
from textwrap import wrap
from typing import Any, NamedTuple

import msgspec

from erdctl.core.errors import UsageProblem
from erdctl.core.quantity import Quantity, Scale
from erdctl.io import documents
from erdctl.io.diagnosis import SCHEMA
from erdctl.io.parameters import parse_parameters
from erdctl.model.corrected_equation import split
from erdctl.model.learned.law import Law, LawSlot, LearnedEffect
from erdctl.model.learned.surface import Surface
from erdctl.model.parameters import Parameters
from erdctl.model.slots import Values

WIDTH = 100
LONGEST = 50  # characters of a name, so that no line of the files is longer than WIDTH
DIGITS = 6  # of a start, and of a motion
STAGES = {LawSlot.FRICTION: "FRICTION", LawSlot.GAS: "GAS"}  # FLUID otherwise
# What a log must hold, and over which variable a misfit shows, by the beginning of a coordinate.
REQUIRES = {
    "duty": ("LEVELS", "DUTY"),
    "largest_duty": ("LEVELS", "DUTY"),
    "late_duty": ("STEPS", "SINCE_DUTY_STEP"),
    "fresh_duty": ("STEPS", "SINCE_DUTY_STEP"),
    "since_duty_step": ("STEPS", "SINCE_DUTY_STEP"),
    "since_reversal": ("REVERSALS", "SINCE_REVERSAL"),
    "path_since_reversal": ("REVERSALS", "SINCE_REVERSAL"),
    "unsettled_time": ("REVERSALS", "SINCE_REVERSAL"),
    "unsettled_way": ("REVERSALS", "SINCE_REVERSAL"),
    "xdot": ("SPEEDS", "XDOT"),
    "abs_xdot": ("SPEEDS", "XDOT"),
    "largest_xdot": ("SPEEDS", "XDOT"),
    "x": ("STROKE", "X"),
    "abs_x": ("STROKE", "X"),
    "largest_x": ("STROKE", "X"),
    "temperature": ("TEMPERATURE", "TIME"),
}
BY_TIME = ("TIME", "TIME")


class _Place(NamedTuple):
    """How a slot is written: its class, what its function returns, and the law's that gives it."""

    slot: str
    returns: str
    calls: str
    what: str
    more: str = ""


ADDED = _Place("TermSlot", "Array", "columns", "(k, n) forces at unit amplitudes [N]")
SCALED = _Place("ScaleSlot", "dict[str, Array]", "factors", "(n,) factors of groups [1]")
PLACES = {
    LawSlot.LAG: _Place("LagSlot", "Array", "lag", "(n,) factor of T_d [1]", ", rising=True"),
    LawSlot.DUTY: _Place("ControlSlot", "Array", "control", "(n,) duty that acts [1]"),
    LawSlot.DEFLECTION: _Place("MotionSlot", "Signals", "motion", "Motion of the piston"),
}


class _Corrected(msgspec.Struct):
    params: dict[str, Any]


class _Diagnosis(msgspec.Struct):
    corrected: _Corrected


def parameters_of(data: bytes, file: str) -> Parameters:
    """The parameters in a parameter file, or those of the corrected model in a diagnosis."""
    raw = documents.parsed(data, file)
    if isinstance(raw, dict) and raw.get("schema") == SCHEMA:
        found = documents.converted(raw, _Diagnosis, name=file).corrected
        data = documents.encode(found.params)
    return parse_parameters(data, file)


def learned_effect(parameters: Parameters, number: int | None, file: str) -> LearnedEffect:
    """The learned law of some parameters; number : which, from 1, where there are several.

    Raises UsageProblem if there is none, or not that one, or several and none is chosen.
    """
    found = [e for e in parameters.model.effects if isinstance(e, LearnedEffect)]
    if not found:
        raise UsageProblem(f"{file}: no learned law is in it; `learned` of a diagnosis has them")
    if number is None and len(found) > 1:
        names = ", ".join(f"{i} {e.name}" for i, e in enumerate(found, start=1))
        raise UsageProblem(f"{file}: {len(found)} laws are in it; choose one by --law: {names}")
    if number is not None and not 1 <= number <= len(found):
        raise UsageProblem(f"--law {number}: {file} has {len(found)}")
    return found[(number or 1) - 1]


def check_name(name: str, taken: tuple[str, ...]) -> None:
    """Raise UsageProblem for what cannot be the name of an effect, or is that of another one.

    The file is a module that a package has at its top, and imports as every other.
    """
    plain = name.isidentifier() and name.isascii() and name == name.lower()
    if not plain or name.startswith("_") or keyword.iskeyword(name):
        raise UsageProblem(f"'{name}': a name has small letters, digits and _, as stick_slip")
    if name in taken or name in ("new", "learned"):
        raise UsageProblem(f"'{name}': the catalogue has an effect of that name")
    if len(name) > LONGEST:
        raise UsageProblem(f"'{name}': expected at most {LONGEST} characters, found {len(name)}")
    if name.startswith("test"):
        raise UsageProblem(f"'{name}': pytest takes what begins with test for a test")
    if hasattr(builtins, name) or name == "annotations":
        raise UsageProblem(f"'{name}': Python has that name itself; choose another name")
    if name in sys.stdlib_module_names or find_spec(name) is not None:
        raise UsageProblem(f"'{name}': the file would hide a module of that name; choose another")


def effect_source(name: str, found: LearnedEffect, values: Values, origin: str) -> str:
    """The file NAME.py; values : of the whole model;  origin : what it was learned from."""
    law, own = found.law, found.local(values)
    requires, shows = REQUIRES.get(law.curve.coordinate, BY_TIME)
    quantities = [_begun(q, own) for q in found.quantities]
    symbols = [_paragraph(f"{q.symbol} : {q.title} [{q.unit}], {q.low:g} to {q.high:g}, "
                     + ("off at 0" if q.off == 0.0 else "at any value where it is off"))
               for q in quantities]  # fmt: skip
    learned = ", ".join(f"{q.symbol} = {own[q.symbol]:.4g}" for q in quantities)
    form = "None" if law.curve.form is None else f'"{law.curve.form}"'
    more = ["zero_first=True"] if law.curve.zero_first else []
    surface = law.curve if isinstance(law.curve, Surface) else None
    across: list[str] = []
    curve = call("CURVE = Curve(", [f'"{law.curve.coordinate}"', "KNOTS", form, *more], ")")
    if surface is not None:
        across = call("ACROSS = (", _numbers(surface.across.knots), ")")
        second = f'across=Curve("{surface.across.coordinate}", ACROSS)'
        curve = call("CURVE = Surface(", [f'"{surface.coordinate}"', "KNOTS", *more, second], ")")
    place = PLACES.get(law.slot, ADDED if law.slot.adds else SCALED)
    slot = f"{place.slot}({'' if law.slot.adds else name}{place.more})"
    columns = f"\n    columns={name}," if law.slot.adds else ""
    scale = ", Scale" if any(q.scale is Scale.LOG for q in quantities) else ""
    title = found.title.removeprefix("a ").capitalize()
    lines = [
        *wrap(f'"""{title}. To be filled in: what it is.', WIDTH),
        "",
        *(f"    {clause}" for clause in split(_equation(law), ", ")),
        "",
        *(line for letter, axis in zip("zy", law.curve.axes, strict=False) for line in _paragraph(
            f"{letter} : {axis.kind.words} [{axis.kind.unit}], from {axis.range[0]:.4g} to"
            f" {axis.range[1]:.4g}, where it was learned; beyond, {axis.ends}")),
        *(line for s in symbols for line in s),
        *_paragraph(f"Learned from {_plain(origin)}: {learned}"),
        "",
        "Source: to be filled in.",
        '"""',
        "",
        "from __future__ import annotations",
        "",
        f"from erdctl.core.quantity import Quantity{scale}",
        *(["from erdctl.core.recording import Array"] if "Array" in place.returns else []),
        "from erdctl.core.signals import Signals",
        "from erdctl.model.effect import Effect, Requirement, Stage, Variable",
        "from erdctl.model.learned.curve import Curve",
        "from erdctl.model.learned.law import Law, LawSlot",
        *(["from erdctl.model.learned.surface import Surface"] if surface else []),
        f"from erdctl.model.slots import {', '.join(sorted([place.slot, 'Values']))}",
        "",
        *call("KNOTS = (", _numbers(law.curve.knots), ")"),
        *across,
        *curve,
        f"LAW = Law(LawSlot.{law.slot.name}, CURVE)",
        "",
        "",
        f"def {name}(s: Signals, p: Values) -> {place.returns}:",
        f'    """{place.what}."""',
        f"    return LAW.{place.calls}(s, p)",
        "",
        "",
        "EFFECT = Effect(",
        f'    name="{name}",',
        f"    stage=Stage.{STAGES.get(law.slot, 'FLUID')},",
        f"    slot={slot},{columns}",
        *_argument("title", found.title),
        *_argument("equation", _equation(law)),
        *(["    alters=(", *_alters(law), "    ),"] if law.slot.groups else []),
        '    source="to be filled in",',
        *_argument("validity", found.validity),
        f"    requires=(Requirement.{requires},),",
        f"    shows=Variable.{shows},",
        *(["    smooth=True,"] if found.smooth else []),
        "    quantities=(",
        *(line for q in quantities for line in _quantity(q)),
        "    ),",
        "    writes_c=LAW.in_c,",
        ")  # fmt: skip",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def _begun(q: Quantity, own: Values) -> Quantity:
    """A parameter whose search begins where it was learned; amplitudes need no start."""
    if q.linear or not q.low <= own[q.symbol] <= q.high:
        return q
    start = float(f"{own[q.symbol]:.{DIGITS}g}")
    start = min(max(start, q.low), q.high)
    return replace(q, start=start, off=0.0 if q.off == 0.0 else start)


def _quantity(q: Quantity) -> list[str]:
    parts = [f'symbol="{q.symbol}"', f'unit="{q.unit}"', f'title="{q.title}"', f"low={q.low!r}",
             f"high={q.high!r}", f"start={q.start!r}"]  # fmt: skip
    parts += [f"off={q.off!r}"] if q.off != 0.0 else []
    parts += ["scale=Scale.LOG"] if q.scale is Scale.LOG else []
    parts += ["linear=True"] if q.linear else []
    return [f"        {line}" for line in call("Quantity(", parts, "),")]


def _equation(law: Law) -> str:
    """What becomes of the force, with z said in words."""
    said = law.equation.replace("Z", f"{max(map(abs, law.curve.range)):.4g}")
    said = said.replace("F -> F + ", "F = ")
    axes = zip("zy", law.curve.axes, strict=False)
    return ", ".join([said, *(f"{letter} = {axis.kind.words}" for letter, axis in axes)])


def _alters(law: Law) -> list[str]:
    f = law.curve.equation.replace("Z", f"{max(map(abs, law.curve.range)):.4g}")
    return [f'        ("{g}", "max(1 + {f}, 0) {{}}"),' for g in law.slot.groups]


def _argument(name: str, text: str) -> list[str]:
    """A text as an argument, in pieces where it is long."""
    whole = f'    {name}="{text}",'
    if len(whole) <= WIDTH:
        return [whole]
    pieces = wrap(text, WIDTH - 14, drop_whitespace=False, break_long_words=False)
    return [f"    {name}=(", *(f'        "{piece}"' for piece in pieces), "    ),"]


def call(begin: str, parts: list[str], end: str) -> list[str]:
    """A call or a list, in lines that are not too long."""
    if len(begin) + len(", ".join(parts)) + len(end) <= WIDTH - 8:
        return [begin + ", ".join(parts) + end]
    out = [begin]
    for part in parts:
        out.append(f"    {part},")
    return [*out, end]


def _numbers(values: tuple[float, ...]) -> list[str]:
    return [repr(float(v)) for v in values]


def _plain(text: str) -> str:
    """A text that ends no string and escapes nothing, whatever a file is called."""
    return re.sub(r"[^\w .,()+-]", "_", text, flags=re.ASCII)


def _paragraph(text: str) -> list[str]:
    return wrap(text, WIDTH, subsequent_indent="    ", break_long_words=False)

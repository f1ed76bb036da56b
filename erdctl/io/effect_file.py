"""A learned law as source code: the file of an effect, and that of its test.

What is written is for an engineer to go on with: equation, parameters with bounds, starts and off
values are those of the law; what it is called, and its source in the literature, nobody learned.
"""

from __future__ import annotations

import keyword
import re
from dataclasses import replace
from itertools import product
from textwrap import wrap
from typing import Any

import msgspec
import numpy as np

from erdctl.core.errors import UsageProblem
from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.io import documents
from erdctl.io.diagnosis import SCHEMA
from erdctl.io.parameters import parse_parameters
from erdctl.model.composed import Model
from erdctl.model.corrected_equation import split
from erdctl.model.learned.coordinates import along
from erdctl.model.learned.law import Law, LawSlot, LearnedEffect
from erdctl.model.parameters import Parameters
from erdctl.model.slots import Values

WIDTH = 100
DIGITS = 6  # of a start
SHOWN = 12  # samples of the test's motion
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
    "xdot": ("SPEEDS", "XDOT"),
    "abs_xdot": ("SPEEDS", "XDOT"),
    "largest_xdot": ("SPEEDS", "XDOT"),
    "x": ("STROKE", "X"),
    "abs_x": ("STROKE", "X"),
    "largest_x": ("STROKE", "X"),
}
BY_TIME = ("TIME", "TIME")


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
    """Raise UsageProblem for what cannot be the name of an effect, or is that of another one."""
    plain = name.isidentifier() and name.isascii() and name == name.lower()
    if not plain or name.startswith("_") or keyword.iskeyword(name):
        raise UsageProblem(f"'{name}': a name has small letters, digits and _, as stick_slip")
    if name in taken or name in ("new", "learned"):
        raise UsageProblem(f"'{name}': the catalogue has an effect of that name")


def effect_source(name: str, found: LearnedEffect, values: Values, origin: str) -> str:
    """The file NAME.py; values : of the whole model;  origin : what it was learned from."""
    law, own = found.law, found.local(values)
    z, (low, high) = law.curve.kind, law.curve.range
    requires, shows = REQUIRES.get(law.curve.coordinate, BY_TIME)
    quantities = [_begun(q, own) for q in found.quantities]
    symbols = [_paragraph(f"{q.symbol} : {q.title} [{q.unit}], {q.low:g} to {q.high:g}, "
                     + ("off at 0" if q.off == 0.0 else "at any value where it is off"))
               for q in quantities]  # fmt: skip
    learned = ", ".join(f"{q.symbol} = {own[q.symbol]:.4g}" for q in quantities)
    form = "None" if law.curve.form is None else f'"{law.curve.form}"'
    more = ", zero_first=True" if law.curve.zero_first else ""
    slot = "TermSlot()" if law.slot.adds else f"ScaleSlot({name})"
    columns = f"\n    columns={name}," if law.slot.adds else ""
    returns = "Array" if law.slot.adds else "dict[str, Array]"
    rows = "LAW.columns(s, p)" if law.slot.adds else "LAW.factors(s, p)"
    what = "(k, n) forces at unit amplitudes [N]" if law.slot.adds else "(n,) factors of groups [1]"
    uses = "TermSlot" if law.slot.adds else "ScaleSlot"
    scale = ", Scale" if any(q.scale is Scale.LOG for q in quantities) else ""
    lines = [
        f'"""{found.title.removeprefix("a ").capitalize()}. To be filled in: what it is.',
        "",
        *(f"    {clause}" for clause in split(_equation(law), ", ")),
        "",
        *_paragraph(f"z : {z.words} [{z.unit}], from {low:.4g} to {high:.4g}, where it was"
                    " learned; beyond these the law stays at its end value"),
        *(line for s in symbols for line in s),
        *_paragraph(f"Learned from {_plain(origin)}: {learned}"),
        "",
        "Source: to be filled in.",
        '"""',
        "",
        "from __future__ import annotations",
        "",
        f"from erdctl.core.quantity import Quantity{scale}",
        "from erdctl.core.recording import Array",
        "from erdctl.core.signals import Signals",
        "from erdctl.model.effect import Effect, Requirement, Stage, Variable",
        "from erdctl.model.learned.curve import Curve",
        "from erdctl.model.learned.law import Law, LawSlot",
        f"from erdctl.model.slots import {uses}, Values",
        "",
        *_call("LAW = Law(", [f"LawSlot.{law.slot.name}",
               f'Curve("{law.curve.coordinate}", {_numbers(law.curve.knots)}, {form}{more})'], ")"),
        "",
        "",
        f"def {name}(s: Signals, p: Values) -> {returns}:",
        f'    """{what}."""',
        f"    return {rows}",
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
        ")  # fmt: skip",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def test_source(name: str, found: LearnedEffect, parameters: Parameters) -> str:
    """The file test_NAME.py: what the law gave on a short motion, and that it is exactly off."""
    values = parameters.values
    paper = {n: values[n] for n in Model().quantities}
    own = found.local(values)
    t, x, xdot, duty = motion(found.law, own.get("tau"))
    force = Model((found,)).force(signals(t, x, xdot, duty), values)
    arrays = {"T": t, "X": x, "XDOT": xdot, "DUTY": duty, "FORCE": force}
    lines = [
        f'"""{name} as it was learned: its force on a short motion, and that it is exactly off."""',
        "",
        "from __future__ import annotations",
        "",
        "import numpy as np",
        "",
        "from erdctl.core.signals import Signals",
        "from erdctl.effects import get",
        "from erdctl.model.composed import Model, off_values",
        "",
        *(line for key, row in arrays.items() for line in _array(key, row)),
        *_call("PAPER = {", [f'"{n}": {v!r}' for n, v in paper.items()], "}"),
        *_call("LEARNED = {", [f'"{name}.{n}": {v!r}' for n, v in own.items()], "}"),
        "",
        "",
        "def motion() -> Signals:",
        "    step = np.append(np.diff(T), 0.0)",
        "    return Signals(T, X, XDOT, DUTY, step, np.array([0, len(T)]))",
        "",
        "",
        "def test_its_force_is_what_was_learned() -> None:",
        f'    force = Model((get("{name}"),)).force(motion(), {{**PAPER, **LEARNED}})',
        "    np.testing.assert_allclose(force, FORCE, rtol=1e-9, atol=1e-9 * np.ptp(FORCE))",
        "    assert not np.array_equal(force, Model().force(motion(), PAPER))",
        "",
        "",
        "def test_off_is_exactly_absent() -> None:",
        f'    model = Model((get("{name}"),))',
        "    force = model.force(motion(), {**PAPER, **off_values(model)})",
        "    assert np.array_equal(force, Model().force(motion(), PAPER))",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def motion(law: Law, tau: float | None) -> tuple[Array, Array, Array, Array]:
    """(n,) time, deflection, velocity and duty of a motion to and fro on which a law shows.

    Of the strokes and periods tried the least on which its coordinate moves as far as it does on
    most of them, within the range of the law.
    """
    part, tried = np.linspace(0.0, 1.0, SHOWN), []
    for amplitude, period in product(np.geomspace(1e-3, 1.0, 7), np.geomspace(1e-2, 1e2, 9)):
        angle = 3.0 * np.pi * part
        speed = 3.0 * np.pi / period * amplitude
        drive = (part * period, amplitude * np.sin(angle), speed * np.cos(angle),
                 np.where(part < 0.4, 0.1, 0.5))  # fmt: skip
        z = np.nan_to_num(along(law.curve.coordinate, signals(*drive), tau))
        tried.append((float(np.std(np.clip(z, *law.curve.range))), speed, drive))
    most = max(moved for moved, _, _ in tried)
    *_, drive = min((t for t in tried if t[0] >= 0.5 * most), key=lambda t: t[1])
    t, x, xdot, duty = (np.array([float(f"{v:.{DIGITS}g}") for v in a]) for a in drive)
    return t, x, xdot, duty


def signals(t: Array, x: Array, xdot: Array, duty: Array) -> Signals:
    """One record of these."""
    return Signals(t, x, xdot, duty, np.append(np.diff(t), 0.0), np.array([0, len(t)]))


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
    return [f"        {line}" for line in _call("Quantity(", parts, "),")]


def _equation(law: Law) -> str:
    """What becomes of the force, with z said in words."""
    f = law.curve.equation.replace("Z", f"{max(map(abs, law.curve.range)):.4g}")
    if law.slot.groups:
        what = ", ".join(f"F_{g} -> max(1 + {f}, 0) F_{g}" for g in law.slot.groups)
    else:
        what = f"F = ({f}) sign(xdot)" if law.slot is LawSlot.FRICTION else f"F = {f}"
    return f"{what}, z = {law.curve.kind.words}"


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


def _array(name: str, values: Array) -> list[str]:
    numbers = wrap(", ".join(repr(v) for v in values.tolist()) + ",", WIDTH - 4)
    return [f"{name} = np.array([", *(f"    {line}" for line in numbers), "])"]


def _call(begin: str, parts: list[str], end: str) -> list[str]:
    """A call or a list, in lines that are not too long."""
    if len(begin) + len(", ".join(parts)) + len(end) <= WIDTH - 8:
        return [begin + ", ".join(parts) + end]
    out = [begin]
    for part in parts:
        out.append(f"    {part},")
    return [*out, end]


def _numbers(values: tuple[float, ...]) -> str:
    return f"({', '.join(repr(float(v)) for v in values)})"


def _plain(text: str) -> str:
    """A text that ends no string and escapes nothing, whatever a file is called."""
    return re.sub(r"[^\w .,()+-]", "_", text, flags=re.ASCII)


def _paragraph(text: str) -> list[str]:
    return wrap(text, WIDTH, subsequent_indent="    ", break_long_words=False)

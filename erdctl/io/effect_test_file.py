"""The test of a learned law that became the file of an effect, as source code."""

from __future__ import annotations

from itertools import product
from textwrap import wrap

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.io.effect_file import DIGITS, WIDTH, call
from erdctl.model.composed import Model
from erdctl.model.learned.coordinates import Memory, along
from erdctl.model.learned.law import LearnedEffect
from erdctl.model.parameters import Parameters
from erdctl.model.slots import Values

SHOWN = 12  # samples of the motion
LEAST = 1e-6  # of the range of a force, that a law has to add to be seen


def test_source(name: str, found: LearnedEffect, parameters: Parameters) -> str:
    """The file test_NAME.py: what the law gave on a short motion, and that it is exactly off."""
    values = parameters.values
    paper = {n: values[n] for n in Model().quantities}
    own = found.local(values)
    shown = motion(found, values)
    force = Model((found,)).force(shown, values)
    acts = _acts(found, shown, values)
    arrays = {"T": shown.t, "X": shown.x, "XDOT": shown.xdot, "DUTY": shown.duty, "FORCE": force}
    warmth = ""
    if shown.temperature is not None:
        arrays["TEMPERATURE"], warmth = shown.temperature, ", temperature=TEMPERATURE"
    lines = [
        '"""As it was learned: the force on a short motion; and that it is exactly off."""',
        "",
        "from __future__ import annotations",
        "",
        "import numpy as np",
        "",
        "from erdctl.core.signals import Signals",
        "from erdctl.effects import get",
        "from erdctl.model.composed import Model, off_values",
        "",
        f'MODEL = Model((get("{name}"),))',
        *(line for key, row in arrays.items() for line in _array(key, row)),
        *call("PAPER = {", [f'"{n}": {v!r}' for n, v in paper.items()], "}"),
        *call("LEARNED = {", [f'"{name}.{n}": {v!r}' for n, v in own.items()], "}"),
        "",
        "",
        "def motion() -> Signals:",
        "    step = np.append(np.diff(T), 0.0)",
        f"    return Signals(T, X, XDOT, DUTY, step, np.array([0, len(T)]){warmth})",
        "",
        "",
        "def test_its_force_is_what_was_learned() -> None:",
        "    force = MODEL.force(motion(), {**PAPER, **LEARNED})",
        "    np.testing.assert_allclose(force, FORCE, rtol=1e-9, atol=1e-9 * np.ptp(FORCE))",
        *["    assert not np.array_equal(force, Model().force(motion(), PAPER))"][: int(acts)],
        "",
        "",
        "def test_off_is_exactly_absent() -> None:",
        "    force = MODEL.force(motion(), {**PAPER, **off_values(MODEL)})",
        "    assert np.array_equal(force, Model().force(motion(), PAPER))",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def motion(found: LearnedEffect, values: Values) -> Signals:
    """A motion to and fro on which a law shows, and with what the log must have for it.

    Of the strokes and periods tried the least on which its coordinate moves as far as it does on
    most of them, within the range of the law, and the force is another with it: a time constant
    does nothing where a step of the motion is many of them.
    """
    law, memory = found.law, Memory.of(found.local(values))
    part, tried = np.linspace(0.0, 1.0, SHOWN), []
    warmth = next((np.linspace(*a.range, SHOWN) for a in law.curve.axes if a.kind.logged), None)
    for amplitude, period in product(np.geomspace(1e-3, 1.0, 7), np.geomspace(1e-2, 1e2, 9)):
        angle = 3.0 * np.pi * part
        speed = 3.0 * np.pi / period * amplitude
        drive = _signals(
            part * period, amplitude * np.sin(angle), speed * np.cos(angle),
            np.where(part < 0.4, 0.1, 0.5), warmth,
        )  # fmt: skip
        moved = 1.0
        for axis in law.curve.axes:
            z = np.nan_to_num(along(axis.coordinate, drive, memory))
            moved *= float(np.std(np.clip(z, *axis.range)))
        tried.append((_acts(found, drive, values), moved, speed, drive))
    acting = [t for t in tried if t[0]] or tried
    most = max(moved for _, moved, _, _ in acting)
    *_, drive = min((t for t in acting if t[1] >= 0.5 * most), key=lambda t: t[2])
    return drive


def _acts(found: LearnedEffect, drive: Signals, values: Values) -> bool:
    """Whether the force is another with the law, by more than rounding."""
    force = Model((found,)).force(drive, values)
    less = Model().force(drive, values)
    return bool(np.max(np.abs(force - less)) > LEAST * np.ptp(force))


def _signals(t: Array, x: Array, xdot: Array, duty: Array, temperature: Array | None) -> Signals:
    """One record of these, with as many digits as a file shows."""

    def shown(values: Array) -> Array:
        return np.array([float(f"{v:.{DIGITS}g}") for v in values])

    t, step = shown(t), np.append(np.diff(shown(t)), 0.0)
    warmth = None if temperature is None else shown(temperature)
    ends = np.array([0, len(t)])
    return Signals(t, shown(x), shown(xdot), shown(duty), step, ends, temperature=warmth)


def _array(name: str, values: Array) -> list[str]:
    numbers = wrap(", ".join(repr(v) for v in values.tolist()) + ",", WIDTH - 4)
    return [f"{name} = np.array([", *(f"    {line}" for line in numbers), "])"]

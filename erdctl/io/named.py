"""What a lab's own names say: which of the contract's columns they are.

A name is taken for a contract column only if
it clearly says what it is and states its unit; where that leaves a choice, the user makes it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache

from erdctl.io.units import UNITS, WrongUnit, between

NAMES: Mapping[str, tuple[str, ...]] = {
    "t": (
        "t", "time", "elapsed time", "test time", "running time", "run time", "total time",
        "relative time", "timestamp", "time stamp", "x value", "zeit", "messzeit", "temps",
    ),
    "x": (
        "x", "displacement", "disp", "deflection", "defl", "stroke", "position", "pos", "travel",
        "axial displacement", "actuator displacement", "damper displacement", "piston displacement",
        "weg", "federweg", "kolbenweg", "hub", "einfederung", "course",
    ),
    "xdot": (
        "xdot", "velocity", "vel", "v", "axial velocity", "damper velocity", "piston velocity",
        "deflection velocity", "geschwindigkeit", "kolbengeschwindigkeit", "vitesse",
    ),
    "duty": (
        "duty", "duty cycle", "dutycycle", "pwm", "pwm duty", "pwm duty cycle", "pwm level",
        "tastgrad", "tastverhältnis", "tastverhaeltnis",
    ),
    "force": (
        "force", "load", "axial force", "axial load", "damper force", "damping force", "load cell",
        "f", "kraft", "dämpferkraft", "daempferkraft",
    ),
}  # fmt: skip

# A name with one of these words is not the measured channel.
_COMMANDED = {
    "command", "cmd", "setpoint", "set", "soll", "sollwert", "target", "demand", "reference",
    "ref", "desired", "error",
}  # fmt: skip
# Words that tell what a column is about, to list it where the user must choose.
_ABOUT = {
    target: {word for name in known for word in name.split() if len(word) > 2}
    - {"axial", "damper", "test", "run", "value", "total", "relative", "actuator", "cell", "level",
       "cycle", "piston"}
    for target, known in NAMES.items()
}  # fmt: skip

_CONTROL = ("duty", "pwm", "tastgrad", "tastverh")  # how a word about it begins
_BESIDE_CONTROL = {
    "carrier", "period", "periode", "status", "state", "enable", "enabled", "temperature", "temp",
}  # fmt: skip
_FREQUENCIES = ("Hz", "kHz", "MHz")


def plainly(name: str) -> str:
    """A name without the ways of writing it: `Duty_Cycle`, `duty-cycle` and `DUTY CYCLE`.

    >>> plainly(" Duty_Cycle")
    'duty cycle'
    """
    name = re.sub(r"(?<=[a-zä-ü])(?=[A-Z])", " ", name.strip())
    return " ".join(re.split(r"[\s_\-.:]+", name)).strip().casefold()


def may_be_control(name: str, unit: str | None) -> bool:
    """Whether a column may hold a duty, however it is called: then the duty is not 0.

    A command counts as well, since nothing measures a duty; what a PWM has beside it does not.

    >>> [may_be_control(n, None) for n in ("Duty %", "PWM_FL", "duty command", "PWM frequency")]
    [True, True, True, False]
    """
    words = plainly(name).split()
    about = any(word.startswith(_CONTROL) for word in words)
    other = unit in _FREQUENCIES or any(suits(unit or "1", t) for t in UNITS if t != "duty")
    beside = any(word in _BESIDE_CONTROL or "freq" in word for word in words)
    return about and not other and not beside


def is_called(name: str, target: str) -> bool:
    """Whether a name, without its unit, says that it is a contract column."""
    return plainly(name) in NAMES.get(target, ())


def is_about(name: str, target: str) -> bool:
    """Whether a name looks as if it had to do with a contract column."""
    words = set(plainly(name).split())
    return not words & _COMMANDED and (is_called(name, target) or bool(words & _ABOUT[target]))


@cache
def suits(unit: str, target: str) -> bool:
    """Whether a unit is one of the contract column's kind."""
    try:
        between(unit, UNITS[target])
    except WrongUnit:
        return False
    return True


def of_several(columns: Sequence[str]) -> bool:
    """Whether names differ by their last word only, as those of several dampers do."""
    firsts = {" ".join(plainly(c).split()[:-1]) for c in columns}
    return len(columns) > 1 and len(firsts) == 1 and firsts != {""}

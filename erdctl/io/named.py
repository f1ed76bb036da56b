"""What a lab's own names say: their units, and which of the contract's columns they are.

`Displacement (mm)`, `x [mm]`, `Force/kN`, `Time, s`. A name is taken for a contract column only if
it clearly says what it is and states its unit; where that leaves a choice, the user makes it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache

from erdctl.io.units import UNITS, WrongUnit, between, name_and_unit

# Spellings of labs, and what the unit is called here. Only these are seen behind a slash or a
# comma, and in parentheses: `F/l` and `Force (left)` state no unit.
_SAME = (
    "s", "ms", "min", "us", "µs", "ns", "h", "m", "mm", "cm", "um", "µm", "μm", "nm", "in", "ft",
    "m/s", "mm/s", "cm/s", "in/s", "ft/s", "m/min", "m/s^2", "m/s**2", "m/s²", "mm/s^2", "g", "N",
    "kN", "mN", "MN", "daN", "lbf", "kgf", "kip", "kp", "Nm", "Pa", "kPa", "MPa", "bar", "mbar",
    "psi", "V", "mV", "kV", "A", "mA", "W", "kW", "J", "Hz", "kHz", "rpm", "deg", "rad", "°",
    "°C", "°F", "degC", "degF", "K", "%", "percent", "kg", "N/mm", "N/m", "mV/V", "V/V", "dB",
)  # fmt: skip
_SPELT = {unit: unit for unit in _SAME} | {
    "µs": "us", "μs": "us", "µm": "um", "μm": "um", "kp": "kgf", "KN": "kN", "kn": "kN",
    "Kn": "kN", "°": "deg", "mm/sec": "mm/s", "m/sec": "m/s", "in/sec": "in/s", "sec": "s",
    "msec": "ms", "mm/s²": "mm/s^2", "m/s²": "m/s^2", "m*s-1": "m/s", "m s-1": "m/s", "m·s-1": "m/s",
    "m/s2": "m/s^2", "mm s-1": "mm/s", "mm·s-1": "mm/s", "m·s⁻¹": "m/s", "m s⁻¹": "m/s",
}  # fmt: skip
_WORDS = {
    "second": "s", "seconds": "s", "secs": "s", "sek": "s", "sekunden": "s", "sec": "s",
    "msec": "ms", "millisecond": "ms", "milliseconds": "ms", "minutes": "min", "inch": "in",
    "inches": "in", "metre": "m", "meter": "m", "metres": "m", "meters": "m", "millimetre": "mm",
    "millimeter": "mm", "millimetres": "mm", "millimeters": "mm", "newton": "N", "newtons": "N",
    "kilonewton": "kN", "kilonewtons": "kN", "volt": "V", "volts": "V", "ampere": "A",
    "amps": "A", "pct": "percent", "percent": "percent", "prozent": "percent", "celsius": "degC",
    "mm/sec": "mm/s", "m/sec": "m/s", "hertz": "Hz",
}  # fmt: skip
_PLAIN = {"-": "1", "--": "1", "–": "1", "1": "1", "n/a": "", "none": "", "": ""}
_IN = re.compile(r"(?P<name>.*\S)\s*\((?P<unit>[^()]*(?:\([^()]*\))?)\)\s*", re.DOTALL)
_BEHIND = re.compile(r"(?P<name>.*?\S)\s*(?:/|,\s|\s+in\s+)\s*\(?(?P<unit>[^()]+?)\)?\s*", re.DOTALL)

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


def unit_spelt(text: str) -> str | None:
    """The unit that a text is and nothing else: "" for no unit, None if it is none.

    Check: "[mm]", "(kN)", "Sec" are mm, kN, s; "left" is none; "-" is 1.
    >>> [unit_spelt(t) for t in ("[mm]", "(kN)", "Sec", "left", "-")]
    ['mm', 'kN', 's', None, '1']
    """
    text = text.strip()
    if text[:1] + text[-1:] in ("[]", "()", "<>", "{}"):
        text = text[1:-1].strip()
    if text in _PLAIN or text.casefold() in _PLAIN:
        return _PLAIN.get(text, _PLAIN.get(text.casefold(), ""))
    return _SPELT.get(text) or _WORDS.get(text.casefold())


def stated(column: str) -> tuple[str, str | None]:
    """A column's name and the unit that it states, if it does.

    Check: `Force/kN` is Force in kN; `F/l` and `Force (left)` are names.
    >>> [stated(n) for n in ("Force/kN", "Time, s", "F/l", "Force (left)", "x [mm]")]
    [('Force', 'kN'), ('Time', 's'), ('F/l', None), ('Force (left)', None), ('x', 'mm')]
    """
    name, unit = name_and_unit(column)
    if unit is not None:
        return name.strip(), unit_spelt(unit) or unit
    for form in (_IN, _BEHIND):
        found = form.fullmatch(column)
        if found is not None:
            unit = unit_spelt(found["unit"])
            if unit:
                return found["name"].strip(), unit
    return column, None


def plainly(name: str) -> str:
    """A name without the ways of writing it: `Duty_Cycle`, `duty-cycle` and `DUTY CYCLE`.

    >>> plainly(" Duty_Cycle")
    'duty cycle'
    """
    name = re.sub(r"(?<=[a-zä-ü])(?=[A-Z])", " ", name.strip())
    return " ".join(re.split(r"[\s_\-.:]+", name)).strip().casefold()


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

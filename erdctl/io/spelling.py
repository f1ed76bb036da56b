"""How units stand beside names: `x [mm]`, `Displacement (mm)`, `Force/kN`, `Time, s`."""

from __future__ import annotations

import re

_BRACKETS = re.compile(r"(?P<name>.*\S)\s*\[(?P<unit>[^\[\]]*)\]\s*", re.DOTALL)
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
    "msec": "ms",
    "mm/s²": "mm/s^2", "m/s²": "m/s^2", "m*s-1": "m/s", "m s-1": "m/s", "m·s-1": "m/s",
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
_BEHIND = re.compile(
    r"(?P<name>.*?\S)\s*(?:/|,\s|\s+in\s+)\s*\(?(?P<unit>[^()]+?)\)?\s*", re.DOTALL
)


def name_and_unit(name: str) -> tuple[str, str | None]:
    """A column's name and the unit in brackets behind it: `Defl FL [mm]`."""
    found = _BRACKETS.fullmatch(name)
    return (found["name"], found["unit"]) if found else (name, None)


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

"""Numbers as people read them: mm, ms, mm/s and kN where files hold SI, an error, a bound."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite

from erdctl.model.effect import Effect

# From an SI unit: how many shown units make one, the shown unit, and from which value in SI on the
# SI unit is shown after all.
SHOWN: dict[str, tuple[float, str, float]] = {
    "m": (1e3, "mm", 10.0),
    "s": (1e3, "ms", 1.0),
    "m/s": (1e3, "mm/s", 10.0),
    "m/N": (1e6, "mm/kN", 1e3),
    "degC": (1.0, "°C", float("inf")),
}
LARGE = 1e4  # N, from which on forces are read in kN
AT_BOUND = "at its bound"
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def scaled(unit: str, size: float = 0.0) -> tuple[float, str]:
    """Factor from an SI unit, and the unit that people read a value of that size in.

    size : largest of the values that stand together [the unit];  a unit that people read as it is
    has the factor 1
    Check: 2 mm is 0.002 m times 1000; 12 kN is 12000 N times 0.001; 900 N stay N.
    >>> scaled("m", 0.002), scaled("N", 12000.0), scaled("N", 900.0)
    ((1000.0, 'mm'), (0.001, 'kN'), (1.0, 'N'))
    """
    if unit == "N":
        return (1e-3, "kN") if LARGE <= abs(size) < float("inf") else (1.0, "N")
    factor, shown, limit = SHOWN.get(unit, (1.0, unit, 0.0))
    return (factor, shown) if abs(size) < limit else (1.0, unit)


def number(value: float | None, digits: int = 4) -> str:
    """A number with so many significant digits, or a dash; no exponent below a million.

    Check: 12345.6 with four digits is 12350.
    >>> number(12345.6), number(0.25), number(None), number(2.5e-7), number(-0.0)
    ('12350', '0.25', '-', '2.5e-07', '0')
    """
    if value is None:
        return "-"
    text = f"{value + 0.0:.{digits}g}"  # a zero has no sign
    return f"{float(text):.0f}" if "e+" in text and abs(value) < 1e6 else text


def with_unit(value: float | None, unit: str, digits: int = 4) -> str:
    """One value, in SI given, as people read it.

    Check: 0.0425 s is 42.5 ms; a number without unit has none.
    >>> with_unit(0.0425, "s"), with_unit(0.5, "1"), with_unit(23456.0, "N")
    ('42.5 ms', '0.5', '23.46 kN')
    """
    if value is None:
        return "-"
    factor, shown = scaled(unit, value)
    return f"{number(value * factor, digits)} {_after(shown)}".rstrip()


def _after(unit: str) -> str:
    """A unit behind a number: nothing for 1, and "/m" for 1/m."""
    return unit.removeprefix("1")


def error_of(
    stderr: float | None,
    factor: float = 1.0,
    *,
    at_bound: bool = False,
    value: float | None = None,
    within: Sequence[float] | None = None,
) -> str:
    """What stands where a standard error would: it, the 95 % interval, the side left of a bound.

    >>> error_of(0.002), error_of(0.002, 1e3, within=(1e-3, 7e-3))
    ('0.002', '1 to 7')
    >>> error_of(None, at_bound=True), error_of(None, at_bound=True, value=0.0, within=(0.0, 77.0))
    ('at its bound', 'at its bound, < 77')
    """
    if at_bound:
        side = _one_side(value, within)
        return AT_BOUND if side is None else f"{AT_BOUND}, {side[0]} {number(side[1] * factor, 2)}"
    if within is not None:
        return " to ".join(number(end * factor, 4) for end in within)
    return number(None if stderr is None else stderr * factor, 2)


def _one_side(value: float | None, within: Sequence[float] | None) -> tuple[str, float] | None:
    """Sign and end of the interval of a value at its bound; None where there is none."""
    if value is None or within is None or not within[0] < within[1]:
        return None
    return ("<", within[1]) if value <= within[0] else (">", within[0])


def estimate(
    value: float | None,
    unit: str,
    stderr: float | None = None,
    *,
    at_bound: bool = False,
    within: tuple[float, float] | None = None,
) -> str:
    """A value with its standard error and unit, as a sentence holds it.

    within : the 95 % interval, of which only one side is said at a bound
    >>> estimate(0.002, "m", 1.2e-5), estimate(0.0, "N/m", at_bound=True)
    ('2 +- 0.012 mm', '0 N/m (at its bound)')
    >>> estimate(13.21, "s", within=(13.205, 13.215))
    '13.21 (13.205 to 13.215) s'
    >>> estimate(0.0, "N/m", at_bound=True, within=(0.0, 77.0))
    '< 77 N/m (at its bound)'
    """
    if value is None:
        return "not identified"
    factor, shown = scaled(unit, value)
    if within is not None and not at_bound:
        low, high = (number(end * factor, 5) for end in within)
        return f"{number(value * factor)} ({low} to {high}) {_after(shown)}".rstrip()
    error = "" if stderr is None or at_bound else f" +- {number(stderr * factor, 2)}"
    one_sided = _one_side(value, within) if at_bound else None
    if one_sided is not None:
        side, end = one_sided
        factor, shown = scaled(unit, end)
        return f"{side} {number(end * factor, 2)} {_after(shown)}".rstrip() + f" ({AT_BOUND})"
    text = f"{number(value * factor)}{error} {_after(shown)}".rstrip()
    return f"{text} ({AT_BOUND})" if at_bound else text


def percent_of(value: float, whole: float) -> str:
    """A part in per cent, or a dash of nothing.

    >>> percent_of(2.0, 160.0), percent_of(1.0, 0.0)
    ('1.25 %', '-')
    """
    return f"{number(100 * value / whole, 3)} %" if whole > 0.0 and isfinite(value) else "-"


def typeset(unit: str) -> str:
    """A unit as print has it: raised powers, a dash for none.

    Check: N s^2/m^2 is N s²/m².
    >>> typeset("N s^2/m^2"), typeset("1"), typeset("degC")
    ('N s²/m²', '–', '°C')
    """
    if unit == "1":
        return "–"
    head, *powers = unit.replace("degC", "°C").split("^")
    for power in powers:
        end = next((i for i, c in enumerate(power) if c not in "-0123456789"), len(power))
        head += power[:end].translate(RAISED) + power[end:]
    return head


def largest(values: Iterable[float | None]) -> float:
    """The size of the largest of some values, which decides the unit of a column."""
    return max((abs(v) for v in values if v is not None and isfinite(v)), default=0.0)


def headline(effect: Effect, values: Mapping[str, float | None]) -> str:
    """An effect's main numbers as a phrase: its own words, with each {symbol} as people read it.

    values : by symbol, SI.  `Effect.said` is e.g. "{g} of free play"; "{f:%}" is in per cent. One
    that says nothing is told by its first parameter.
    >>> from erdctl.effects import get
    >>> headline(get("backlash"), {"g": 0.002})
    '2 mm of free play'
    """
    shown = {q.symbol: _Shown(values.get(q.symbol), q.unit) for q in effect.quantities}
    first = effect.quantities[0]
    said = effect.said or f"{first.title.partition(',')[0]}: {{{first.symbol}}}"
    return said.format(**shown)


class _Shown:
    """A value that writes itself into a phrase."""

    def __init__(self, value: float | None, unit: str) -> None:
        self.value, self.unit = value, unit

    def __format__(self, how: str) -> str:
        if self.value is None:
            return "an unknown amount"
        if how == "%":
            return f"{number(100 * self.value, 3)} %"
        return with_unit(self.value, self.unit, 3)

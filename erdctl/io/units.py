"""Unit conversion, and `--map "x=Defl FL[mm]"`: a log's own names and units to the contract's."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.recording import Array
from erdctl.io.spelling import name_and_unit as name_and_unit

if TYPE_CHECKING:
    import pint

# Contract columns and their units; "" is a plain number.
UNITS = {
    "t": "s",
    "x": "m",
    "xdot": "m/s",
    "duty": "",
    "force": "N",
    "temperature": "degC",
    "force_model": "N",
}
RECORD = "record"
TARGETS = (*UNITS, RECORD)

_EXAMPLES = {
    "s": "s, ms, min",
    "m": "m, mm, um, in",
    "m/s": "m/s, mm/s, in/s",
    "": "1, percent, %",
    "N": "N, kN, lbf, kgf",
    "degC": "degC, degF, K",
}
_KINDS = {
    "a length": "m",
    "a time": "s",
    "a speed": "m/s",
    "an acceleration": "m/s^2",
    "a force": "N",
    "a mass": "kg",
    "a pressure": "Pa",
    "a voltage": "V",
    "a current": "A",
    "a charge": "C",
    "a temperature": "K",
    "a frequency": "Hz",
    "an energy": "J",
    "a power": "W",
    "a stiffness": "N/m",
    "a damping coefficient": "N*s/m",
    "a plain number": "",
}
# Signs for "no unit", and the letters that mean a temperature wherever one is expected.
_LONGEST = 80  # characters of a unit
_PLAIN = {"-", "1", ""}
_TEMPERATURES = {"C": "degC", "F": "degF", "°C": "degC", "°F": "degF"}

# pint tokenizes units as Python and raises whatever its tokenizer does, so only what looks like
# a unit gets there. Even then it slips on some: TypeError for logarithmic units (exact fractions
# cannot follow them), KeyError for units that cancel, AssertionError for prefixes alone.
_SLIPS = (ValueError, TypeError, KeyError, AssertionError, ArithmeticError)
_NAME = r"(?:[^\W\d_]+(?:_[^\W\d_]+)*|%|°[CF]|1)"
_POWER = r"(?:\s*(?:\^|\*\*)\s*-?\d|⁻?[¹²³])?"
_BETWEEN = r"(?:\s*[*/·⋅]\s*|\s+)"
_PLAIN_FACTOR = rf"{_NAME}{_POWER}"
_FACTOR = rf"(?:{_PLAIN_FACTOR}|\({_PLAIN_FACTOR}(?:{_BETWEEN}{_PLAIN_FACTOR})*\){_POWER})"
_UNIT = rf"{_FACTOR}(?:{_BETWEEN}{_FACTOR})*"
# `980.665 N`: so much of the unit for 1 in the file.
_SCALED = re.compile(
    r"(?P<factor>(?:[0-9]{1,15}\.?[0-9]{0,15}|\.[0-9]{1,15})(?:[eE][+-]?[0-9]{1,2})?)"
    r"(?:\s*[*·]?\s*(?P<unit>[^0-9\s.*].*))?"
)


@dataclass(frozen=True)
class Conversion:
    """values * factor + offset, exact until it meets the values."""

    factor: Fraction = Fraction(1)
    offset: Fraction = Fraction(0)

    def __call__(self, values: Array) -> Array:
        """Converted values; the same array if there is nothing to convert.

        Check: 12.3 mm is exactly 0.0123 m (12.3 * 0.001 is not); 212 degF is 100 degC.
        >>> between("mm", "m")(np.array([12.3])).tolist()
        [0.0123]
        >>> between("degF", "degC")(np.array([212.0])).round(9).tolist()
        [100.0]
        """
        out = values
        if self.factor.numerator == -1 or self.factor.numerator == 1:
            divisor = self.factor.denominator * self.factor.numerator
            if divisor != 1:
                out = values / float(divisor)
        else:
            out = values * float(self.factor)
        return out + float(self.offset) if self.offset else out

    def signed(self, sign: Fraction) -> Conversion:
        """The same with the sign changed where `sign` is negative."""
        return self if sign > 0 else Conversion(-self.factor, -self.offset)


def conversion(unit: str, target: str, said: str) -> Conversion:
    """From a unit as the user wrote it to the SI unit of a contract column.

    said : where, for messages, e.g. `--map "x=Defl FL[mm]"`
    Raises UsageProblem if it is no unit, or a unit of something else.
    """
    wanted = UNITS[target]
    try:
        return between(unit, wanted)
    except WrongUnit as error:
        raise UsageProblem(
            f"{said}: '{target}' mapped with {error}; expected something like {examples(target)}"
        ) from None


def factor_between(given: str, wanted: str, label: str) -> float:
    """Factor from one unit to another, for units without an offset.

    label : what carries the unit, for the message
    Raises InputProblem if `given` is no unit or of another dimension.
    Check: "mm" to "m" is 0.001.
    >>> factor_between("mm", "m", "the stroke")
    0.001
    """
    try:
        found = between(given, wanted)
    except WrongUnit as error:
        raise InputProblem(
            f"{label} is given in {error}; expected {wanted or 'a plain number'}"
        ) from None
    return float(found.factor)


def listed(columns: Sequence[str], most: int = 20) -> str:
    """Column names for a message."""
    more = f" and {len(columns) - most} more" if len(columns) > most else ""
    return ", ".join(columns[:most]) + more


class WrongUnit(Exception):
    """Says what is wrong, to be completed by what was expected."""


def examples(target: str) -> str:
    """Units that a contract column may come in."""
    return _EXAMPLES[UNITS[target]]


@cache
def between(given: str, wanted: str) -> Conversion:
    """From one unit to another of the same dimension. Raises WrongUnit."""
    given = given.strip()
    if wanted == "degC":
        given = _TEMPERATURES.get(given, given)
    given = "" if given in _PLAIN else given
    if given == wanted:
        return Conversion()
    scaled = _SCALED.fullmatch(given)
    if scaled is not None and Fraction(scaled["factor"]) > 0:
        # Volts of a sensor: 980.665 N stands for each.
        of_one = between(scaled["unit"] or "", wanted)
        return Conversion(Fraction(scaled["factor"]) * of_one.factor, of_one.offset)
    import pint

    # A unit of hundreds of factors would take its parser beyond what Python can nest.
    if len(given) > _LONGEST:
        raise WrongUnit(f"'{given[:30]}...' of {len(given)} characters, which is not a unit")
    if given and not re.fullmatch(_UNIT, given):
        raise WrongUnit(f"'{given}', which is not a unit")
    registry = _registry()
    try:
        unit, target = registry.parse_units(given), registry.parse_units(wanted)
        zero, one = (_quantity(v, unit).to(target).magnitude for v in (0, 1))
        if float(one - zero) == 0.0:
            raise OverflowError("a factor that is no float")
    except pint.DimensionalityError:
        said = f"unit '{given}'" if given else "no unit (- or 1)"
        raise WrongUnit(f"{said}, which is {_kind(unit)}") from None
    except (pint.PintError, *_SLIPS) as error:
        raise WrongUnit(f"'{given}', which is not a unit") from error
    return Conversion(Fraction(one) - Fraction(zero), Fraction(zero))


@cache
def _registry() -> pint.UnitRegistry[Any]:
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


def _quantity(value: int, unit: pint.Unit) -> Any:
    return _registry().Quantity(Fraction(value), unit)


def _kind(unit: pint.Unit) -> str:
    registry = _registry()
    for kind, example in _KINDS.items():
        if registry.parse_units(example).dimensionality == unit.dimensionality:
            return kind
    return "something else"

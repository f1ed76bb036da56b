"""Decimal sign and thousands separator: what the numbers of a file prove, and where they do not."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from erdctl.core.errors import InputProblem
from erdctl.io.text.cells import NUMBER, Dialect, kind_of
from erdctl.io.text.options import DECIMALS, FORMS_OF, THOUSANDS, TextOptions

_CALLED = {sign: name for name, sign in (*THOUSANDS.items(), *DECIMALS.items())}
POINT, COMMA = ".", ","


@dataclass
class SignsProven:
    """Cells that prove a sign, each with its line; the first of every kind.

    decimal : sign -> a cell in which it can only be the decimal sign
    thousands : sign -> a cell in which it can only separate thousands
    either : sign -> a cell in which it may be either
    """

    decimal: dict[str, tuple[str, int]] = field(default_factory=dict)
    thousands: dict[str, tuple[str, int]] = field(default_factory=dict)
    either: dict[str, tuple[str, int]] = field(default_factory=dict)

    def add(self, cell: str, line: int) -> None:
        """Take a number into account.

        Check: 0.5 proves a decimal point, 1.234 nothing, 1.234,5 both signs.
        >>> proven = evidence_of([("1.234", 1)])
        >>> (proven.decimal, list(proven.either))
        ({}, ['.'])
        >>> proven = evidence_of([("1.234,5", 2), ("0.5", 3)])
        >>> (sorted(proven.decimal), list(proven.thousands))
        ([',', '.'], ['.'])
        """
        body = cell.lstrip("+-")
        mantissa, exponent, _ = body.lower().partition("e")
        place = (cell, line)
        for sign in (" ", "'"):
            spread = mantissa
            for other in FORMS_OF[sign]:
                spread = spread.replace(other, sign)
            if sign in spread:
                self.thousands.setdefault(sign, place)
                mantissa = spread.replace(sign, "")
        points, commas = mantissa.count(POINT), mantissa.count(COMMA)
        if points and commas:
            last = POINT if mantissa.rfind(POINT) > mantissa.rfind(COMMA) else COMMA
            self.decimal.setdefault(last, place)
            self.thousands.setdefault(COMMA if last == POINT else POINT, place)
        elif points > 1 or commas > 1:
            self.thousands.setdefault(POINT if points else COMMA, place)
        elif points or commas:
            whole, sign, fraction = mantissa.partition(POINT if points else COMMA)
            groups = len(fraction) == 3 and 1 <= len(whole) <= 3 and whole[0] != "0"
            kept = self.either if groups and not exponent else self.decimal
            kept.setdefault(sign, place)


def settle(found: SignsProven, separator: str, options: TextOptions, file: str) -> tuple[str, str]:
    """The decimal sign and the thousands separator ("" for none).

    Raises InputProblem where the numbers contradict each other, or allow two readings.
    """
    if options.decimal is not None:
        decimal = options.decimal
    elif options.thousands in (POINT, COMMA):
        decimal = COMMA if options.thousands == POINT else POINT
    else:
        decimal = _decimal(found, separator, file)
    other = COMMA if decimal == POINT else POINT
    if options.thousands is not None:
        return decimal, options.thousands
    sure = [sign for sign in found.thousands if sign != decimal]
    if len(sure) > 1:
        raise _contradiction(found.thousands[sure[0]], found.thousands[sure[1]], file=file)
    if not sure and other in found.either:
        cell, line = found.either[other]
        raise InputProblem(
            f"'{cell}' beside numbers with a decimal {_CALLED[decimal]}: if the {_CALLED[other]}"
            f" separates thousands, say so: --text thousands={_CALLED[other]}; else export the"
            " columns with one decimal sign",
            file=file,
            row=line,
        )
    return decimal, sure[0] if sure else ""


def _decimal(found: SignsProven, separator: str, file: str) -> str:
    signs = dict(found.decimal)
    for sign, place in found.thousands.items():
        if sign in (POINT, COMMA):
            signs.setdefault(COMMA if sign == POINT else POINT, place)
    if len(signs) > 1:
        raise _contradiction(*list(signs.values())[:2], file=file)
    if signs:
        return next(iter(signs))
    # Where commas separate cells, 1.234 is a number as the contract writes it, but "1,234" in
    # quotes may be either; without any sign there is nothing to decide.
    if not found.either or (separator == COMMA and COMMA not in found.either):
        return POINT
    if len(found.either) > 1:
        raise _contradiction(*list(found.either.values())[:2], file=file)
    ((sign, (cell, line)),) = found.either.items()
    raise InputProblem(
        f"'{cell}' may be {cell.replace(COMMA, POINT)} or {re.sub('[.,]', '', cell)}, and no number"
        f" of the file shows which; say so: --text decimal={_CALLED[sign]}, or --text"
        f" thousands={_CALLED[sign]}",
        file=file,
        row=line,
    )


def _contradiction(one: tuple[str, int], two: tuple[str, int], *, file: str) -> InputProblem:
    return InputProblem(
        f"numbers in two notations, '{one[0]}' and '{two[0]}' (row {two[1]}); say which holds,"
        " e.g. --text decimal=point,thousands=comma, or export it in one",
        file=file,
        row=one[1],
    )


def evidence_of(numbers: Iterable[tuple[str, int]]) -> SignsProven:
    """What numbers, each with its line, prove."""
    out = SignsProven()
    for cell, line in numbers:
        out.add(cell, line)
    return out


def otherwise(cell: str, dialect: Dialect) -> str:
    """What to say of a cell that is a number in another notation, "" if it is none.

    Check: 1,5 can only be 1.5; 1,076 may be 1076 as well, so none of the two is said to be meant.
    >>> otherwise("1,5", Dialect())
    ' with a decimal point: 1.5'
    >>> otherwise("1,076", Dialect())
    ' with a decimal point; if the comma separates thousands: --text thousands=comma'
    """
    if kind_of(cell) != NUMBER:
        return ""
    said = f" with a decimal {_CALLED[dialect.decimal]}"
    for called, sign in THOUSANDS.items():
        new = sign not in ("", dialect.decimal, dialect.thousands)
        if new and replace(dialect, thousands=sign).number.match(cell):
            return f"{said}; if the {called} separates thousands: --text thousands={called}"
    other = COMMA if dialect.decimal == POINT else POINT
    if other not in cell:
        return ""
    once = cell.count(other) == 1 and dialect.decimal not in cell
    return f"{said}: {cell.replace(other, dialect.decimal)}" if once else said

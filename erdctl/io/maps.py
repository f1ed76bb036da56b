"""`--map` options: which column of a log is which of the contract's, and in what unit."""

from __future__ import annotations

from collections.abc import Mapping as Mapping_
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.spelling import name_and_unit, stated, unit_spelt
from erdctl.io.units import (
    RECORD,
    TARGETS,
    UNITS,
    Conversion,
    WrongUnit,
    between,
    conversion,
    listed,
)


@dataclass(frozen=True)
class Mapping:
    """One `--map`: which of the log's columns a contract column is, and in what unit.

    spec : as it was written;  said : where, for messages
    """

    target: str
    source: str
    spec: str
    said: str = "--map"

    @property
    def quoted(self) -> str:
        """As messages quote it: `--map "x=Defl FL[mm]"`."""
        return f'{self.said} "{self.spec}"'

    @property
    def unit(self) -> str | None:
        """The unit that the option gives, if it gives one."""
        return name_and_unit(self.source)[1]

    def is_in(self, columns: Sequence[str], units: Mapping_[str, str]) -> bool:
        """Whether a log has the column, and states no other unit for it than this does.

        units : as the log states them for columns, apart from those in names
        """
        if self.target == "duty" and self.source == "0":
            return True  # that there was no control needs no column
        bare = self.source[1:].strip() if self.source.startswith("-") else ""
        for name in (self.source, bare):
            found = _find(name, columns) if name else None
            if found is not None:
                return self._agrees(units.get(found[0]) or stated(found[0])[1])
        return False

    def _agrees(self, unit: str | None) -> bool:
        if unit is None or self.unit is None or self.target == RECORD:
            return True
        own, other = (unit_spelt(u) or u.strip() for u in (self.unit, unit))
        if own == other:
            return True
        try:
            return between(own, UNITS[self.target]) == between(other, UNITS[self.target])
        except WrongUnit:
            return False

    def find(self, columns: Sequence[str], file: str) -> tuple[str, Conversion]:
        """The log's column, and how its values become SI.

        The log's name may carry its unit: `x=Defl FL[mm]` finds `Defl FL`, `Defl FL[mm]` and
        `Defl FL [mm]`; `x=Defl FL` finds them too. A minus before the name changes the sign.
        Raises InputProblem if there is no such column, UsageProblem for a wrong unit.
        """
        found = _find(self.source, columns)
        if found is None and self.source.startswith("-"):
            found = _find(self.source[1:].strip(), columns)
            if found is not None and self.target != RECORD:
                return found[0], self._conversion(found[1], Fraction(-1))
        if found is None:
            raise self._missing(columns, file)
        return found[0], self._conversion(found[1], Fraction(1))

    def _conversion(self, unit: str | None, sign: Fraction) -> Conversion:
        if self.target == RECORD:
            return Conversion()
        plain = Conversion() if unit is None else conversion(unit, self.target, self.quoted)
        return plain.signed(sign)

    def _missing(self, columns: Sequence[str], file: str) -> InputProblem:
        from difflib import get_close_matches

        name = name_and_unit(self.source)[0].lstrip("-")
        by_lower = {c.lower(): c for c in columns}
        close = [by_lower[c] for c in get_close_matches(name.lower(), by_lower, 3, 0.6)]
        hint = f"; close to it: {', '.join(close)}" if close else ""
        return InputProblem(
            f"{self.quoted}: the log has no column '{name}'{hint}; it has {listed(columns)}",
            file=file,
        )


def parse_maps(
    specs: Sequence[str], said: str = "--map", before: Sequence[Mapping] = ()
) -> tuple[Mapping, ...]:
    """The `--map` options, checked as far as possible without a log.

    said : where they stand, for messages;  before : mappings that hold already
    Raises UsageProblem for unknown or repeated columns and for wrong units.
    """
    out: list[Mapping] = []
    wrong: list[str] = []
    for spec in specs:
        try:
            out.append(_parsed(spec, (*before, *out), said))
        except UsageProblem as error:
            wrong.append(str(error))
    if wrong:
        raise UsageProblem(";\n".join(wrong))
    return tuple(out)


def _parsed(spec: str, before: Sequence[Mapping], said: str) -> Mapping:
    target, equals, source = (part.strip() for part in spec.partition("="))
    if not (target and equals and source):
        raise UsageProblem(f'{said} "{spec}": write COLUMN=NAME[UNIT], e.g. --map "force=F_fl[N]"')
    if target not in TARGETS:
        from difflib import get_close_matches

        close = get_close_matches(target, TARGETS, 1, 0.4)
        hint = f"did you mean '{close[0]}'? " if close else ""
        raise UsageProblem(
            f"{said} \"{spec}\": unknown column '{target}'; {hint}Columns are {', '.join(TARGETS)}"
        )
    for other in before:
        if other.target == target:
            raise UsageProblem(f"{said}: '{target}' is mapped twice, keep one of the two")
        if other.source == source:
            raise UsageProblem(
                f"{said}: '{source}' is mapped to both '{other.target}' and '{target}'"
            )
    mapping = Mapping(target, source, spec, said)
    if mapping.unit is not None and target != RECORD:
        conversion(mapping.unit, target, mapping.quoted)
    return mapping


def _find(source: str, columns: Sequence[str]) -> tuple[str, str | None] | None:
    name, unit = name_and_unit(source)
    if source in columns:
        return source, unit
    if name in columns:
        return name, unit
    # `Defl FL [mm]` for `Defl FL[mm]`; and `Defl FL [mm]` for `Defl FL` unless ambiguous
    parted = {c: name_and_unit(c) for c in columns}
    for column, parts in parted.items():
        if parts == (name, unit):
            return column, unit
    same = [c for c, parts in parted.items() if parts[0] == name and unit is None]
    if len(same) == 1:
        return same[0], parted[same[0]][1]
    # `Displacement` for `Displacement (mm)`, whose unit is the file's to state
    other = [c for c in columns if stated(c)[0] == name and c not in same]
    if len(other) == 1 and not same:
        return other[0], unit
    blank = [c for c in columns if c.strip() in (source, name)]
    return (blank[0], unit) if len(blank) == 1 and not same else None

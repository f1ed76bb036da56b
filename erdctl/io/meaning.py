"""Columns of other names that clearly are the contract's, and those where the user must say."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from erdctl.core.errors import InputProblem
from erdctl.io.named import NAMES, is_about, is_called, may_be_control, of_several, plainly, suits
from erdctl.io.sources import TableSource
from erdctl.io.spelling import stated
from erdctl.io.stored import from_stored, si


@dataclass(frozen=True)
class Meant:
    """What the names of a log say of one contract column.

    column : the only one that it can be, None if there is none or a choice
    likely : all that it may be;  why : what keeps `column` from being taken
    """

    target: str
    column: str | None
    likely: tuple[str, ...] = ()
    why: str = ""

    def suggestion(self, source: TableSource) -> str:
        """An option that would say it."""
        return f'--map "{self.target}={in_a_unit(source, self.likely[0], self.target)}"'


def unit_of_column(source: TableSource, column: str) -> str | None:
    """The unit that the file states for a column, in a field of its own or in the name."""
    return source.units.get(column) or stated(column)[1]


def one_unit(source: TableSource, column: str, target: str) -> str | None:
    """The same for a contract column. Raises InputProblem where field and name differ."""
    field, name = source.units.get(column), stated(column)[1]
    if field and name and suits(name, target):
        by_field = from_stored(field, target, column, source.name)
        if by_field != from_stored(name, target, column, source.name):
            raise InputProblem(
                f"in {field} by its own field and in {name} by its name; say which it is:"
                f' --map "{target}={column}[{field}]" or [{name}]',
                file=source.name,
                column=column,
            )
    return field or name


def in_a_unit(source: TableSource, column: str, target: str) -> str:
    """A column as `--map` takes it: with the unit that its name hints at, where it states none."""
    unit = unit_of_column(source, column)
    if unit and suits(unit, target):
        return column
    if target != "duty" or (unit is None and is_called(column, target)):
        return f"{column}[{si(target)}]"
    words = set(plainly(column).replace("%", " % ").split())
    if words & {"%", "pct", "percent", "prozent"}:
        return f"{column}[%]"
    return f"{column}[UNIT]"


def meant(source: TableSource, target: str, taken: Collection[str]) -> Meant:
    """The column that a contract column is, as far as names and units leave no choice."""
    free = [c for c in source.columns if c not in taken]
    if target == "t" and source.text is not None:
        stamps = [c for c in source.text.forms if c in free]
        beside = set(source.text.dates.values())
        clocks = [c for c in stamps if c not in beside]
        named = [c for c in free if c not in stamps and _fits(source, c, target)]
        if len(clocks) == 1 and not named:
            return Meant(target, clocks[0], (clocks[0],))
        if clocks and not named:
            return Meant(target, None, tuple(clocks), "several columns hold times")
    if target not in NAMES:
        return Meant(target, None)
    about = [c for c in free if is_about(stated(c)[0], target)]
    fitting = [c for c in about if _fits(source, c, target)]
    bare = [c for c in about if unit_of_column(source, c) is None]
    if len(fitting) == 1 and is_called(stated(fitting[0])[0], target):
        return Meant(target, fitting[0], (fitting[0],))
    if len(fitting) > 1:
        why = "several columns may be it"
        if of_several([stated(c)[0] for c in fitting]):
            why = "several columns may be it, as of several dampers; read one damper at a time"
        return Meant(target, None, tuple(fitting), why)
    # A bare letter may mean anything.
    exact = [c for c in bare if is_called(stated(c)[0], target) and len(c.strip()) > 1]
    if exact and not fitting:
        return Meant(target, None, tuple(exact), "its unit is not stated")
    if target == "duty" and not exact:
        some = [c for c in free if may_be_control(stated(c)[0], unit_of_column(source, c))]
        if some:
            why = "its unit or its damper is not plain; --map duty=0 if none of it is the control"
            return Meant(target, None, tuple(some), why)
    return Meant(target, None, (*fitting, *bare), "")


def _fits(source: TableSource, column: str, target: str) -> bool:
    unit = unit_of_column(source, column)
    if unit is None or not is_about(stated(column)[0], target):
        return False
    return suits(unit, target)


def blocks(found: Meant) -> bool:
    """Whether going on without it would be a wrong number: a duty that is there is not 0."""
    return found.target == "duty" and found.column is None and bool(found.why)

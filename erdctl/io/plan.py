"""Which column of a log is which of the contract's, and how its values become SI."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial

import pyarrow as pa

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.instants import in_seconds
from erdctl.io.maps import Mapping
from erdctl.io.meaning import Meant, blocks, meant, one_unit, unit_of_column
from erdctl.io.problems import Problems
from erdctl.io.roles import Roles
from erdctl.io.sources import TableSource, read_source
from erdctl.io.spelling import stated
from erdctl.io.stored import from_stored, si, with_unit
from erdctl.io.units import (
    RECORD,
    TARGETS,
    UNITS,
    Conversion,
    listed,
    name_and_unit,
)

Report = Callable[[str], None]
# Which column of the log a contract column is, and how its values become SI.
ColumnPlan = dict[str, tuple[str, Conversion]]


def plan_columns(
    source: TableSource,
    mappings: Sequence[Mapping],
    *,
    needed: Sequence[str],
    left: Collection[str] = (),
    say: Report,
) -> ColumnPlan:
    """The columns that the log has, by `--map` and by their names.

    A unit given with `--map` holds; else the one that the file states for the column, in a unit
    field or as `x [mm]`; else SI.
    needed : contract columns without which it is no log;  left : those taken only if mapped
    say : takes a line for everything that was assumed or converted
    Raises InputProblem for missing columns and for stored units that do not fit, UsageProblem.
    """
    stating = _Stated(source, say)
    problems = Problems(source.name)
    plan: ColumnPlan = {}
    declined = {m.target for m in mappings if _declines(m, source)}
    for mapping in mappings:
        found = problems.attempt(partial(stating.mapped, mapping))
        if found is not None and mapping.target not in declined:
            plan[mapping.target] = found
    failed = {m.target for m in mappings} - set(plan)
    unclear: list[Meant] = []
    for target in TARGETS:
        if target in plan or target in left or target in failed:
            continue
        taken = {column for column, _ in plan.values()}
        column = _by_name(source, target, say)
        if column is None:
            one = meant(source, target, {*taken, *(t for t in TARGETS if t in source.columns)})
            column = one.column
            if column is None and (target in needed or (needed and blocks(one))):
                unclear.append(one)
            elif column is None and one.why:
                say(f"'{target}' not taken from {listed(one.likely)}: {one.why}; --map says it")
        if column is not None and column not in taken:
            convert = problems.attempt(partial(stating.conversion, target, column))
            plan[target] = (column, convert or Conversion())
    if unclear:
        taken = {column for column, _ in plan.values()}
        error = _missing(unclear, [c for c in source.columns if c not in taken], source)
        problems.met.append(error)
    if problems.met and source.text is not None:
        say(f"read as: {source.text.read_as}")
    problems.settle()
    stating.tell(plan)
    return plan


def _declines(mapping: Mapping, source: TableSource) -> bool:
    """`--map duty=0`: there was no control, whatever columns may look like one."""
    return mapping.target == "duty" and mapping.source == "0" and "0" not in source.columns


class _Stated:
    """Units that the log states, and what there is to say about them."""

    def __init__(self, source: TableSource, say: Report) -> None:
        self.source, self.say = source, say
        self.by_map: set[str] = set()
        self.converted: list[str] = []
        self.assumed: list[str] = []

    def mapped(self, mapping: Mapping) -> tuple[str, Conversion]:
        source = self.source
        self.by_map.add(mapping.target)
        if _declines(mapping, source):
            return "0", Conversion()
        column, convert = mapping.find((*source.columns, *source.clocks), source.name)
        if column in source.clocks:
            column = "t"
        stored = source.units.get(column)
        if mapping.target == RECORD:
            return column, convert
        if mapping.unit is None:
            if name_and_unit(column)[1] is None:
                convert = self.conversion(mapping.target, column).signed(convert.factor)
            return column, convert
        if source.text is not None and column in source.text.forms:
            raise UsageProblem(
                f"{mapping.quoted}: '{column}' holds dates or times, which need no unit"
            )
        if stored is not None:
            self.compare(mapping, column, stored, convert)
        if source.layout is not None and column == "t":
            # The containers' own time comes in the seconds that the file says it has.
            done = from_stored(stored or "s", "t", column, source.name)
            convert = Conversion(convert.factor / done.factor)
        return column, convert

    def compare(self, mapping: Mapping, column: str, stored: str, convert: Conversion) -> None:
        """What `--map` says holds: people correct wrong units by it. But it is said."""
        try:
            same = from_stored(stored, mapping.target, column, "").signed(convert.factor)
        except InputProblem:
            same = None
        if same != convert:
            self.say(
                f"the unit of '{column}' is {stored} in the file and {mapping.unit} by"
                f" {mapping.said}; {mapping.said} holds"
            )

    def conversion(self, target: str, column: str) -> Conversion:
        if target == RECORD:
            return Conversion()
        unit = one_unit(self.source, column, target)
        if unit is None:
            if self.source.layout is not None and target != "duty":
                self.assumed.append(f"{column} as {si(target)}")
            return Conversion()
        if self.source.layout is not None and target == column == "t":
            return Conversion()
        found = from_stored(unit, target, column, self.source.name)
        if found != Conversion():
            self.converted.append(f"{column} from {unit} to {si(target)}")
        return found

    def tell(self, plan: ColumnPlan) -> None:
        text = self.source.text
        other = [t for t, (column, _) in plan.items() if t not in (column, column.strip())]
        guessed = [t for t in other if t not in self.by_map]
        if guessed and text is None:
            self.say(f"by their names, {_taken({t: plan[t] for t in guessed}, self.source)}")
        if self.converted and text is None:
            self.say(f"converted {', '.join(self.converted)}")
        if self.assumed:
            self.say(
                f"no unit is stored with some channels; taken {', '.join(self.assumed)}; --map"
                " says otherwise"
            )


def _by_name(source: TableSource, target: str, say: Report) -> str | None:
    if target in source.columns:
        return target
    near = [c for c in source.columns if c.strip() == target]
    if not near and target in UNITS:
        near = [c for c in source.columns if stated(c)[0].strip() == target]
        if len(near) > 1 or not all(_fits(c, target) for c in near):
            say(f"{listed(near)} not taken as '{target}'; --map says otherwise")
            return None
    if near and source.text is None:  # of a text, one line says everything
        say(f"column '{near[0]}' is taken as '{target}'")
    return near[0] if near else None


def _fits(column: str, target: str) -> bool:
    try:
        from_stored(stated(column)[1] or "", target, column, "")
    except InputProblem:
        return False
    return True


def _missing(missing: Sequence[Meant], free: Sequence[str], source: TableSource) -> InputProblem:
    """All that could not be found, and the options that would say it."""
    names = " and ".join(f"'{one.target}'" for one in missing)
    reasons = [
        f"'{one.target}' may be {', '.join(repr(c) for c in one.likely)} ({one.why})"
        for one in missing
        if one.why and one.likely
    ]
    text = source.text
    if text is not None and text.interval and missing[0].target == "t":
        reasons.append(
            f"the interval is stated: --text interval={text.interval:g} makes a time of it"
        )
    if text is not None and not text.header.line:
        reasons.append("without a header row columns have numbers")
        options = [f'--map "{m.target}=column_{i}[UNIT]"' for i, m in enumerate(missing, 1)]
    else:
        options = [_example(one, free, source) for one in missing]
    why = "".join(f"; {reason}" for reason in reasons)
    return InputProblem(
        f"no column {names}; the log has {listed(source.columns)}{why}; say which it is, in its"
        f" own unit, e.g. {' '.join(options)}",
        file=source.name,
        column=missing[0].target,
    )


def _example(one: Meant, free: Sequence[str], source: TableSource) -> str:
    if one.likely:
        return one.suggestion(source)
    from difflib import get_close_matches

    by_lower = {c.lower(): c for c in free}
    close = get_close_matches(one.target, by_lower, 1, 0.3)
    return f'--map "{one.target}={by_lower[close[0]] if close else "NAME[UNIT]"}"'


def _taken(plan: ColumnPlan, source: TableSource) -> str:
    """Columns of other names, and the units that they were read in."""
    out = []
    for target, (column, convert) in plan.items():
        if column.strip() == target and convert == Conversion():
            continue
        if source.text is not None and column in source.text.forms:
            continue  # said where they were read
        unit = unit_of_column(source, column)
        known = unit is None or stated(column)[1] is not None
        named = target if column.strip() == target else f"{target} is '{column}'"
        out.append(named if known else f"{named} in {unit}")
    return ", ".join(out)


def in_contract_names(table: pa.Table, plan: ColumnPlan, say: Report) -> pa.Table:
    """The log's table with mapped columns renamed; a column that had such a name steps aside."""
    targets = {column: target for target, (column, _) in plan.items()}
    names = []
    for name in table.column_names:
        new = targets.get(name, name)
        if new in plan and name not in targets:
            new = f"{name} (original)"
            say(f"the log's own column '{name}' is kept as '{new}'")
        names.append(new)
    return table.rename_columns(names)


def read_planned(
    source: TableSource,
    plan: ColumnPlan,
    mappings: Sequence[Mapping],
    wanted: Sequence[str],
    *,
    others: Sequence[str] = (),
    want_hash: bool = False,
    say: Report,
) -> tuple[pa.Table, ColumnPlan, str]:
    """The wanted columns, what is left to convert of them, and the hash of the file.

    others : columns other than the plan's that hold numbers

    The channels of a container come on one time base, and a time of their own in seconds.
    Raises InputProblem for whole numbers of a sensor whose scale nobody states.
    """
    for remark in source.remarks:
        say(remark)
    clock, seconds = plan.get("t", ("t", Conversion()))
    notes: list[str] = []
    hear = say if source.text is None else notes.append
    try:
        numbers = [column for target, (column, _) in plan.items() if target != RECORD]
        table, digest = read_source(
            source,
            wanted,
            numbers=[*numbers, *others],
            labels=[plan[RECORD][0]] if RECORD in plan else [],
            roles=Roles({column: target for target, (column, _) in plan.items()}, seconds, hear),
            want_hash=want_hash,
        )
    finally:
        if source.text is not None:
            said = [f"read as: {source.text.read_as}", *notes, _taken(plan, source)]
            say(", ".join(filter(None, said)))
    if clock in table.column_names and (found := in_seconds(table.column(clock), clock)):
        at = table.column_names.index(clock)
        table = table.set_column(at, with_unit(pa.field(clock, pa.float64()), si("t")), found[0])
        plan = plan | {"t": (clock, Conversion())}
        say(found[1])
    if source.layout is not None:
        _refuse_counts(table, source, plan, {m.target for m in mappings if m.unit is not None})
        if clock != "t":
            plan = plan | {"t": (clock, Conversion())}
    return table, plan, digest


def _refuse_counts(
    table: pa.Table, source: TableSource, plan: ColumnPlan, given: Collection[str]
) -> None:
    """A force in whole numbers of no unit is what the converter counted, not newtons."""
    for target, (column, _) in plan.items():
        stated = target in given or column in source.units or name_and_unit(column)[1] is not None
        whole = pa.types.is_integer(table.schema.field(column).type)
        if stated or not whole or target in ("t", "duty", RECORD):
            continue
        raise InputProblem(
            f"whole numbers ({table.schema.field(column).type}) without a unit or a scaling, which"
            f" may be counts of a converter; if they are in a unit, say so: --map"
            f' "{target}={column}[{si(target)}]"; else export scaled values',
            file=source.name,
            column=column,
        )

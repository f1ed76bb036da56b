"""One damper out of a log that holds several: `--where "damper=FL"`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pyarrow as pa

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.recording import Index
from erdctl.io.named import plainly
from erdctl.io.units import listed

ALL = "*"
NAMES = (
    "damper", "damper id", "unit", "specimen", "specimen id", "unit under test", "dut", "sample id",
    "shock", "shock absorber", "part", "part number", "serial", "serial number", "dämpfer",
    "prüfling",
)  # fmt: skip
DAMPER = "damper"
_CORNERS = {
    "fl", "fr", "rl", "rr", "vl", "vr", "hl", "hr", "front left", "front right", "rear left",
    "rear right", "vorne links", "vorne rechts", "hinten links", "hinten rechts",
}  # fmt: skip
_OF_ONE = {"damper", "specimen", "dut", "shock", "serial", "sn", "dämpfer", "prüfling"}
_MOST = 1000  # different values; more are no dampers


@dataclass(frozen=True)
class Where:
    """Rows to read: those with one of these values in a column; ALL for every one, on purpose."""

    column: str
    values: tuple[str, ...]


def parse_where(specs: Sequence[str]) -> tuple[Where, ...]:
    """The `--where` options; of one column several values may be given.

    Raises UsageProblem.
    """
    chosen: dict[str, list[str]] = {}
    for spec in specs:
        column, equals, value = (part.strip() for part in spec.partition("="))
        if not (column and equals and value):
            raise UsageProblem(f'--where "{spec}": write COLUMN=VALUE, e.g. --where "damper=FL"')
        chosen.setdefault(column, []).append(value)
    return tuple(Where(column, tuple(values)) for column, values in chosen.items())


def damper_columns(columns: Sequence[str]) -> list[str]:
    """Columns that by their names say which damper a row is of."""
    return [c for c in columns if plainly(c) in NAMES]


def damper_of(group: str) -> str | None:
    """The damper that the name of a group of channels says: a corner of a car, or its number.

    >>> [damper_of(n) for n in ("FL", "/run3_FrontLeft/data", "Damper_12", "run_1")]
    ['FL', 'front left', 'Damper_12', None]
    """
    words = plainly(group.replace("/", " ")).split()
    for corner in (*words, *(f"{a} {b}" for a, b in pairwise(words))):
        if corner in _CORNERS:
            return group if words == [corner] else corner
    return group if len(words) > 1 and words[0] in _OF_ONE else None


def needed_columns(columns: Sequence[str], where: Sequence[Where], file: str) -> list[str]:
    """Columns to read to choose rows. Raises InputProblem if one is not there."""
    for one in where:
        if one.column not in columns:
            raise InputProblem(
                f"--where {one.column}=...: the log has no column '{one.column}'; it has"
                f" {listed(columns)}",
                file=file,
            )
    return list(dict.fromkeys([*damper_columns(columns), *(one.column for one in where)]))


def chosen_rows(table: pa.Table, where: Sequence[Where], file: str) -> Index | None:
    """Rows of the damper that was asked for; None for all of them.

    Raises InputProblem if the log holds several dampers and none, or one that is not there, was
    chosen.
    """
    import pyarrow.compute as pc

    asked = {one.column: one.values for one in where}
    keep = np.ones(table.num_rows, dtype=bool)
    for name in dict.fromkeys([*damper_columns(table.column_names), *asked]):
        if name not in table.column_names:
            continue
        column = table.column(name)
        if pa.types.is_dictionary(column.type):
            column = column.cast(column.type.value_type)
        try:
            text = column.cast(pa.string()).fill_null("")
        except (pa.ArrowNotImplementedError, pa.ArrowInvalid):
            continue
        values = pc.unique(text).to_pylist()
        wanted = asked.get(name)
        if wanted is None:
            if 1 < len(values) <= _MOST:
                options = " or ".join(f'--where "{name}={v}"' for v in values[:3])
                raise InputProblem(
                    f"holds {len(values)} dampers ({listed(values, 8)}), which are never taken"
                    f' together unasked; choose: {options}, or all as one: --where "{name}={ALL}"',
                    file=file,
                    column=name,
                )
            continue
        if ALL in wanted:
            continue
        unknown = [v for v in wanted if v not in values]
        if unknown:
            raise InputProblem(
                f"--where {name}={unknown[0]}: there is no such value; there are {listed(values)}",
                file=file,
                column=name,
            )
        keep &= np.asarray(pc.is_in(text, value_set=pa.array(list(wanted))))
    if keep.all():
        return None
    rows = np.flatnonzero(keep).astype(np.intp)
    if not rows.size:
        raise InputProblem("no row is left by --where", file=file)
    return rows

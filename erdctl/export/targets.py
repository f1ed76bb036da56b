"""What can be exported: one line for each suffix. Writers are imported when they are needed.

Which programs a file is for says `serves.py`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from erdctl.core.errors import UsageProblem

if TYPE_CHECKING:
    from erdctl.export.emulator.limits import EmulatorLimits
    from erdctl.export.origin import Origin
    from erdctl.export.tables.grid import Asked
    from erdctl.model.faults import FaultKind
    from erdctl.model.parameters import Parameters

Progress = Callable[[str, str], None]
TABLE = ("--duty", "--speed", "--points", "--amplitude", "--temperature")
EMULATOR = ("--emulate", "--duty-max", "--resolution", "--slew", "--update-rate",
            "--max-temperature")  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Order:
    """What is wanted.

    parameters, origin : of the damper, and the file that they stand in;  path : to write
    table : which table;  emulate : the faults of an emulator, none for the damper itself
    limits : of an emulator;  fmi : version of an FMU
    """

    parameters: Parameters
    origin: Origin
    path: str
    table: Asked
    emulate: tuple[FaultKind, ...] = ()
    limits: EmulatorLimits
    fmi: str = "2"
    progress: Progress = field(default=lambda stage, what: None)


Writer = Callable[[Order], Sequence[str]]


def _table(order: Order) -> Sequence[str]:
    from erdctl.core.progress import part_of
    from erdctl.export.tables.files import write_table

    return write_table(
        order.parameters, order.path, order.table, order.origin,
        lambda i, n: order.progress("simulating", part_of("the table and its errors", i, n)),
    )  # fmt: skip


def _sources(order: Order) -> Sequence[str]:
    from erdctl.export.source_files import write_sources

    return write_sources(order.parameters, order.path, order.emulate, order.limits)


def _fmu(order: Order) -> Sequence[str]:
    from erdctl.export.fmu.file import write_fmu

    order.progress("building", "the FMU for all platforms; the first time takes longer")
    return write_fmu(order.parameters, order.path, order.emulate, order.limits, order.fmi)


@dataclass(frozen=True)
class Exported:
    """One suffix.

    title : what it is;  write : gives remarks for the user;  options : that mean something for it
    """

    title: str
    write: Writer
    options: tuple[str, ...]


TARGETS: Mapping[str, Exported] = {
    ".c": Exported("C99 source, and its header beside it", _sources, EMULATOR),
    ".fmu": Exported("FMU for co-simulation", _fmu, (*EMULATOR, "--fmi")),
    ".dpr": Exported("damper property file", _table, (*TABLE, "--positive")),
    ".csv": Exported("force over speed and duty", _table, TABLE),
    ".mat": Exported("force over speed and duty, for MATLAB", _table, TABLE),
}


def target(path: str, given: Sequence[str]) -> Exported:
    """The target of a file by its suffix.

    given : the options that the user gave
    Raises UsageProblem for another suffix, and for an option that means nothing there.
    """
    suffix = os.path.splitext(path)[1].lower()
    found = TARGETS.get(suffix)
    known = ", ".join(TARGETS)
    if found is None:
        what = f"the suffix '{suffix}'" if suffix else "no suffix"
        raise UsageProblem(f"'{path}' has {what}, by which export tells what to write: {known}")
    foreign = [option for option in given if option not in found.options]
    if foreign:
        where = [s for s, t in TARGETS.items() if foreign[0] in t.options]
        raise UsageProblem(
            f"{foreign[0]} means nothing for a {suffix} file, only for {', '.join(where)}"
            if where else f"{foreign[0]} means nothing for any file"
        )  # fmt: skip
    return found

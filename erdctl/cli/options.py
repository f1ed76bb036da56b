"""Arguments and options that several commands share."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from typing import Annotated

import typer


def effect_names(incomplete: str) -> list[str]:
    """Completes names of effects, also behind a comma."""
    from erdctl.effects import names

    return after_comma(incomplete, names())


def schema_names(incomplete: str) -> list[str]:
    """Completes names of documents."""
    from erdctl.io.shapes import SCHEMAS

    return [name for name in (*SCHEMAS, "proof", "proof-on") if name.startswith(incomplete)]


def picture_kinds(incomplete: str) -> list[str]:
    """Completes kinds of pictures."""
    from erdctl.report.pictures import names

    return [name for name in names() if name.startswith(incomplete)]


def kinds_of_plot(incomplete: str) -> list[str]:
    """Completes the kind in `--plot KIND:FILE`."""
    return [f"{kind}:" for kind in picture_kinds(incomplete)]


def fault_kinds(incomplete: str) -> list[str]:
    """Completes the kind in `--fault KIND=FACTOR`."""
    from erdctl.model.faults import FaultKind

    return [f"{k.short}=" for k in FaultKind if k.short.startswith(incomplete)]


def emulated_faults(incomplete: str) -> list[str]:
    """Completes kinds of faults, also behind a comma."""
    from erdctl.model.faults import FaultKind

    return after_comma(incomplete, [kind.short for kind in FaultKind])


def after_comma(incomplete: str, names: Iterable[str]) -> list[str]:
    """The lists that some names make of one whose last name is incomplete.

    Check: behind "backlash,co" comes what begins with co, and backlash stays.
    >>> after_comma("backlash,co", ["backlash", "coulomb_friction"])
    ['backlash,coulomb_friction']
    """
    head, comma, last = incomplete.rpartition(",")
    return [f"{head}{comma}{name}" for name in names if name.startswith(last)]


class OutputFormat(StrEnum):
    """Formats that a table can be written in."""

    CSV = "csv"
    PARQUET = "parquet"
    ARROW = "arrow"
    MAT = "mat"
    MDF = "mdf"
    TDMS = "tdms"


Logs = Annotated[
    list[str],
    typer.Argument(
        metavar="LOG...", help="Bench logs: CSV, Parquet, Arrow, MAT, HDF5, MDF, TDMS; - is stdin."
    ),
]
Params = Annotated[str, typer.Argument(metavar="PARAMS", help="Parameter file; - is stdin.")]
Maps = Annotated[
    list[str],
    typer.Option(
        "--map",
        metavar="COLUMN=NAME[UNIT]",
        help="A log's own column and unit, e.g. --map 'x=Defl FL[mm]'. May be repeated.",
    ),
]
Text = Annotated[
    list[str],
    typer.Option(
        "--text",
        metavar="KEY=VALUE,...",
        help="How a text log is written, where that is not clear: encoding, separator, decimal,"
        " thousands, date, header, units, interval; e.g. --text decimal=comma,date=dmy.",
    ),
]
Where = Annotated[
    list[str],
    typer.Option(
        "--where",
        metavar="COLUMN=VALUE",
        help="Only these rows of a log, e.g. one damper: --where damper=FL. May be repeated.",
    ),
]
Out = Annotated[str, typer.Option("--output", "-o", metavar="FILE", help="Where to; - is stdout.")]
Faults = Annotated[
    list[str],
    typer.Option(
        "--fault",
        autocompletion=fault_kinds,
        metavar="KIND=FACTOR@START:END",
        help="oil, electrical or deformation, e.g. oil=0.5@15:31. May be repeated.",
    ),
]
Date = Annotated[
    str | None,
    typer.Option("--date", metavar="YYYY-MM-DD", help="Date of the test, for provenance."),
]
Damper = Annotated[
    str | None,
    typer.Option("--damper", metavar="TEXT", help="The damper tested, for provenance."),
]
Operator = Annotated[
    str | None, typer.Option("--operator", metavar="TEXT", help="Who tested it, for provenance.")
]
Cluster = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Of a Dask scheduler, tcp://HOST:PORT, or its scheduler file (*.json): the work is"
        " done there.",
    ),
]
EXIT_CODES = (
    "Exit codes: 0 done; 1 a check you asked for failed; 2 wrong usage; 3 bad input data or"
    " parameter file; 4 the computation could not be completed."
)

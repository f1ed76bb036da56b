"""Arguments and options that several commands share."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer


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
        metavar="LOG...", help="Bench logs: CSV, Parquet, Arrow, MAT, MDF or TDMS; - is stdin."
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
Out = Annotated[str, typer.Option("--output", "-o", metavar="FILE", help="Where to; - is stdout.")]
Faults = Annotated[
    list[str],
    typer.Option(
        "--fault",
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
EXIT_CODES = (
    "Exit codes: 0 done; 1 a check you asked for failed; 2 wrong usage; 3 bad input data or"
    " parameter file; 4 the computation could not be completed."
)

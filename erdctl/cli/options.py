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
        metavar="KIND=FACTOR@START:END",
        help="oil, electrical or deformation, e.g. oil=0.5@15:31. May be repeated.",
    ),
]
EXIT_CODES = (
    "Exit codes: 0 done; 1 a check you asked for failed; 2 wrong usage; 3 bad input data or"
    " parameter file; 4 the computation could not be completed."
)

"""`erdctl convert`."""

from __future__ import annotations

from typing import Annotated

import typer

from erdctl.cli.options import Maps, OutputFormat, Text


def command(
    log: Annotated[str, typer.Argument(metavar="IN", help="A log in any format; - is stdin.")],
    output: Annotated[
        str, typer.Argument(metavar="OUT", help="Where to, format by suffix; - is stdout.")
    ],
    maps: Maps = [],
    text: Text = [],
    format: Annotated[
        OutputFormat | None, typer.Option(help="Format of OUT, whatever its suffix; stdout: CSV.")
    ] = None,
    running_time: Annotated[
        bool,
        typer.Option(
            "--running-time",
            help="Let the time go on from record to record, for what happens once in a log.",
        ),
    ] = False,
) -> None:
    """Convert a log between CSV, Parquet, Arrow, MAT, HDF5, MDF4 and TDMS.

    Columns of a bench log (t, x, xdot, duty, force, temperature) are written in SI under these
    names; all others keep values, names and units. A column `record` makes records: a struct array
    in MAT, groups in MDF4 and TDMS. MAT, MDF4 and TDMS are read and written whole, in memory; long
    Parquet and Arrow files go by in stretches, and may be larger than memory.

    Units: one that the file states is converted to SI; one given with --map overrides it; one of
    the wrong kind is refused; without any, SI is assumed. Whole numbers without unit and scaling
    are refused, since they may be counts of a converter; a gain or offset in the file is applied to
    whole numbers only, and it is said. Units are stored in the header of CSV
    (`p [bar]`; columns of a bench log are SI and have plain names), in field metadata of Parquet
    and Arrow, as the channel's unit in MDF4 and TDMS, and in the struct `units` of MAT.

    Text: encoding, separator, decimal sign, header, row of units, dates and times are recognised,
    and one line says what was assumed. Where two readings are possible, the command stops and names
    the key of --text that decides. Columns are taken for those of a bench log where name and unit
    are clear, as in `Displacement (mm)`; else --map says it, for a file in volts with a factor.
    Runs whose time begins anew become records, as for every other command, and a column `record`
    names them. A time that falls in another way and records that come back are refused, as by every
    other command; values out of range are converted with a warning.

    Time bases: the time is the channel t or time (also T or Time, if its unit or its values do not
    speak against it; where two may be it, --map says which), else the file's own sampling interval.
    Channels with several rates are resampled to the times of force (without it, of x), motion and
    force linearly, the duty held; a gap that would be bridged is refused. The command says what it
    did. Groups of the same channels are records; where they are called after several dampers (FL,
    FR), --where chooses one. Libraries: MAT v5 to v7 needs none, the others pip install
    'erdctl[formats]'.

    \b
    Examples:
      erdctl convert bench.mf4 bench.parquet
      erdctl convert bench.tdms bench.csv --map "x=Defl FL" --map "force=F_fl[kN]"
      erdctl convert bench.csv bench.mat
      erdctl convert --running-time bench.parquet - | erdctl diagnose -
      erdctl convert lab.txt out.parquet --text decimal=comma --map "force=Load (N)[0.98 N]"
    """
    from erdctl.cli.in_force import IN_FORCE
    from erdctl.core.progress import part_of
    from erdctl.io.convert import converted_in_parts, read_converted
    from erdctl.io.formats import CONTAINERS
    from erdctl.io.tables import behind, output_format, table_writer, write_table
    from erdctl.report.text import progress, say

    def warn(line: str) -> None:
        say(line, "warning")

    wanted, project = format and format.value, IN_FORCE.get()
    kind = output_format(output, wanted)  # a wrong suffix shows before a long reading
    with progress() as step:
        parts = None
        if kind not in CONTAINERS and project is None and not running_time:
            parts = converted_in_parts(log, maps=maps, say=say, warn=warn, progress=step)
        if parts is not None:
            with table_writer(output, wanted) as writer, behind(writer) as write:
                for part in parts:
                    write(part)
            return
        step("reading", part_of(log, 1, 2))
        table = read_converted(
            log,
            maps=maps,
            text=text,
            project=None if project is None else project.reading,
            goes_on=running_time,
            say=say,
            warn=warn,
        )
        step("writing", part_of(output, 2, 2))
        write_table(table, output, wanted)

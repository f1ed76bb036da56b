"""`erdctl simulate`."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from erdctl.cli.options import Faults, Maps, Out, OutputFormat, Params, Text, Where
from erdctl.cli.pictures import Plots


def command(
    params: Params,
    log: Annotated[
        str | None, typer.Argument(metavar="[LOG]", help="Drive: a bench log; - is stdin.")
    ] = None,
    output: Out = "-",
    drive: Annotated[
        list[str],
        typer.Option(
            metavar="KIND:KEY=VALUE,...",
            help="A described drive in place of LOG, e.g. sine:freq=1,amp=0.01,duty=0.2; kinds"
            " sine, sweep, triangle, bumps, hold, noise. May be repeated: one record each.",
        ),
    ] = [],
    fault: Faults = [],
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
    format: Annotated[
        OutputFormat | None, typer.Option(help="Format on stdout; default CSV.")
    ] = None,
    causal: Annotated[
        bool,
        typer.Option(
            "--causal",
            help="As an exported block (C, FMU) has it: without effects of the bench.",
        ),
    ] = False,
    plot: Plots = [],
) -> None:
    """Simulate the damper force over a log or a described drive.

    Writes the log's columns and `force_model`. A record starts with F_ER at the steady value of
    its first sample; the duty is held from each sample to the next; sign(0) = 0.

    What is known at a sample is of the past alone, as on a vehicle: the force is that of the block
    which `erdctl export` writes, to the last digits. Of a record that begins at rest the direction
    of the first motion is known as well; a block takes it for compression unless it is told
    (first_compressing of an FMU, the function PREFIX_begin of C). Effects of the bench (a drift of
    the load cell, a skew of its clock) are no part of a block; --causal leaves them out here too,
    and says so, to check one against the other. A fit, which has the whole log, looks ahead in two
    places, which cost little: `fluid_inertia`, and how `presliding_friction` begins.

    A long Parquet or Arrow file is read in stretches, and may be larger than memory.

    \b
    Examples:
      erdctl simulate damper.json drive.csv -o out.parquet
      erdctl simulate damper.json --drive sine:freq=1,amp=0.01,duty=0.2
      erdctl simulate damper.json drive.csv --fault oil=0.5@15:31 --fault electrical=0.8@31:46
      erdctl simulate damper.json drive.csv | erdctl validate -
      erdctl simulate damper.json drive.csv --causal -o as_exported.csv
      erdctl simulate damper.json drive.csv --fault oil=0.5 --plot faults.png -o out.parquet
    """
    from erdctl.cli.long import REPLACED, simulate_long
    from erdctl.cli.pictures import draw, wanted
    from erdctl.core.errors import UsageProblem
    from erdctl.io.formats import CONTAINERS
    from erdctl.io.parameters import read_parameters
    from erdctl.io.tables import append_column, output_format, write_table
    from erdctl.model.simulate import Remarks, simulate
    from erdctl.report.text import progress, say

    if (log is None) == (not drive):
        raise UsageProblem("simulate needs either a LOG or --drive, e.g. --drive sine:freq=1")
    if params == "-" and log == "-":
        raise UsageProblem("PARAMS and LOG cannot both be stdin")
    asked = wanted(plot, "faults" if fault else "loops")
    parameters = read_parameters(params)
    if causal:
        from erdctl.export.as_block import as_block

        parameters, said = as_block(parameters)
        for line in said:
            say(line)
    if log is not None:
        from erdctl.cli.reading import read_logs

        options: dict[str, Any] = {
            "maps": maps,
            "where": where,
            "need_force": False,
            "keep_table": True,
        }
        # A picture, and a file of channels, take the whole log.
        if (
            not asked
            and output_format(output, format and format.value) not in CONTAINERS
            and simulate_long(parameters, log, fault, output, format and format.value, options)
        ):
            return
        read = read_logs([log], text=text, report=say, **options)
        recording, table = read.recording, read.table
        assert table is not None
    else:
        from erdctl.bench.drive import drives
        from erdctl.io.tables import table_of

        recording = drives(drive)
        table = table_of(recording)
    remarks = Remarks(parameters, fault)
    remarks.add(recording)
    again = "force_model" in table.column_names
    for line in [*([REPLACED] if again else []), *remarks.lines()]:
        say(line)
    for line in remarks.of_faults():
        say(line, "warning")
    with progress() as step:
        force = simulate(parameters, recording, fault, progress=step)
    write_table(append_column(table, "force_model", force), output, format and format.value)
    if asked:
        from erdctl.report.subject import Subject
        from erdctl.report.subjects import about, of_faults

        draw(
            asked,
            Subject(
                recording=recording, modelled=force, parameters=parameters,
                cases=of_faults(parameters, recording, fault) if fault else {},
                about=about(recording),
            ),
        )  # fmt: skip

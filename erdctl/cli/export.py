"""`erdctl export`."""

from __future__ import annotations

import textwrap
from enum import StrEnum
from typing import Annotated

import typer

from erdctl.cli.options import Params, emulated_faults
from erdctl.export.serves import ONLINE, served


class Fmi(StrEnum):
    """Version of FMI."""

    TWO = "2"
    THREE = "3"


class Positive(StrEnum):
    """Which way a damper property file counts as positive."""

    EXTENSION = "extension"
    COMPRESSION = "compression"


def command(
    params: Params,
    output: Annotated[
        str,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help="Where to; its suffix says what: .c, .fmu, .dpr, .csv, .mat.",
        ),
    ],
    duty: Annotated[
        list[float],
        typer.Option(
            metavar="V",
            help="Duty of the table, 0..1; may be repeated for .csv and .mat. By default 0 in a"
            " .dpr, and 11 levels of the range that was seen in a map.",
        ),
    ] = [],
    speed: Annotated[
        float | None,
        typer.Option(metavar="M/S", help="Highest speed of a table; by default what was seen."),
    ] = None,
    points: Annotated[
        int | None, typer.Option(metavar="N", help="Speeds in each direction; by default 20.")
    ] = None,
    amplitude: Annotated[
        float | None,
        typer.Option(
            metavar="M",
            help="Amplitude of the sines whose peaks make a table; by default half of what was"
            " seen.",
        ),
    ] = None,
    temperature: Annotated[
        float | None,
        typer.Option(metavar="C", help="Temperature of a table, where a learned law has it."),
    ] = None,
    positive: Annotated[
        Positive | None,
        typer.Option(
            help="What a .dpr counts as positive speed and force; by default extension, as Adams"
            " Car reads it."
        ),
    ] = None,
    fmi: Annotated[
        Fmi | None,
        typer.Option(help="Version of an FMU; by default 2, which most programs read."),
    ] = None,
    emulate: Annotated[
        str | None,
        typer.Option(
            metavar="KIND,...",
            autocompletion=emulated_faults,
            help="The online emulator of oil, electrical, deformation in place of the damper:"
            " faulty duty from the healthy one.",
        ),
    ] = None,
    duty_max: Annotated[
        float | None, typer.Option(metavar="V", help="Emulator: highest duty; by default 0.45.")
    ] = None,
    resolution: Annotated[
        float | None, typer.Option(metavar="V", help="Emulator: smallest step of the duty.")
    ] = None,
    slew: Annotated[
        float | None,
        typer.Option(metavar="V/S", help="Emulator: fastest change of the duty per second."),
    ] = None,
    update_rate: Annotated[
        float | None,
        typer.Option(metavar="HZ", help="Emulator: how often the duty can change."),
    ] = None,
    max_temperature: Annotated[
        float | None,
        typer.Option(
            metavar="C", help="Emulator: no output above this temperature; by default 60."
        ),
    ] = None,
) -> None:
    """Export a damper to another program: its suffix says what FILE becomes.

    \b
    SERVED

    ONLINE

    A table holds the force at the highest speed of steady sines, in both directions. What it
    cannot hold (hysteresis, lag, the gas spring) is said in the file, with the NRMSE that this
    costs. Effects of the bench (a drift of the force channel, a time skew) are no part of the
    damper: they are left out, and the command says so. PARAMS is a parameter file or a diagnosis,
    whose corrected model is exported.

    \b
    Examples:
      erdctl export damper.json -o damper.c
      erdctl export damper.json -o emulator.c --emulate oil,electrical --update-rate 1000
      erdctl export damper.json -o damper.fmu
      erdctl export damper.json -o damper.dpr --duty 0.3
      erdctl export damper.json -o map.csv
      erdctl export damper.json -o map.mat --duty 0 --duty 0.2 --duty 0.4 --points 40
      erdctl identify bench.csv | erdctl export - -o map.csv
    """
    from hashlib import sha256

    from erdctl.core.errors import UsageProblem
    from erdctl.export.emulated import emulated
    from erdctl.export.emulator.limits import EmulatorLimits
    from erdctl.export.origin import Origin
    from erdctl.export.tables.grid import POINTS, Asked
    from erdctl.export.targets import EMULATOR, Order, target
    from erdctl.io import documents
    from erdctl.io.effect_file import parameters_of
    from erdctl.mimic.trusted import refuse_untrusted
    from erdctl.model.amplifier import Amplifier
    from erdctl.report.text import progress, say

    options = {
        "--duty": duty or None, "--speed": speed, "--points": points, "--amplitude": amplitude,
        "--temperature": temperature,
        "--positive": positive, "--fmi": fmi, "--emulate": emulate, "--duty-max": duty_max,
        "--resolution": resolution, "--slew": slew, "--update-rate": update_rate,
        "--max-temperature": max_temperature,
    }  # fmt: skip
    given = [name for name, value in options.items() if value is not None]
    wanted = target(output, given)
    asked = Asked(
        duty=tuple(duty), speed=speed, points=POINTS if points is None else points,
        amplitude=amplitude, temperature=temperature,
        extension=positive is not Positive.COMPRESSION,
    )  # fmt: skip
    amplifier = {"duty_max": duty_max, "resolution": resolution, "slew": slew,
              "update_rate": update_rate}  # fmt: skip
    limits = EmulatorLimits(
        amplifier=Amplifier(**{k: v for k, v in amplifier.items() if v is not None}),
        **({} if max_temperature is None else {"temperature_max": max_temperature}),
    )
    if emulate is None and (emulator := [o for o in given if o in EMULATOR]):
        raise UsageProblem(f"{emulator[0]} is of an emulator; add --emulate oil, for instance")
    faults = () if emulate is None else emulated(emulate)
    data = documents.read_bytes(params)
    name = "stdin" if params == "-" else params
    parameters = parameters_of(data, name)
    refuse_untrusted(parameters, name)
    with progress() as step:
        remarks = wanted.write(Order(
            parameters=parameters, origin=Origin(name=name, sha256=sha256(data).hexdigest()),
            path=output, table=asked, emulate=faults, limits=limits,
            fmi=(fmi or Fmi.TWO).value, progress=step,
        ))  # fmt: skip
    for line in remarks:
        say(line)


def _served(width: int = 86) -> str:
    """Suffixes and what they serve, in two columns, within the indentation of the help."""
    first = 2 + max(map(len, served()))
    rows = [
        textwrap.fill(
            serves, width, initial_indent=f"{suffixes:{first}}", subsequent_indent=" " * first,
            break_on_hyphens=False,
        )
        for suffixes, serves in served().items()
    ]  # fmt: skip
    return textwrap.indent("\n".join(rows), "    ").lstrip()


# The pages have the same words, from the same place.
command.__doc__ = (command.__doc__ or "").replace("SERVED", _served()).replace("ONLINE", ONLINE)

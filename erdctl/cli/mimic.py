"""`erdctl mimic`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from erdctl.cli.options import (
    Damper,
    Date,
    Faults,
    Maps,
    Operator,
    Out,
    OutputFormat,
    Params,
    Text,
    Where,
)
from erdctl.cli.pages import Report, check_report
from erdctl.cli.pictures import Plots

if TYPE_CHECKING:
    from erdctl.cli.pictures import Wanted
    from erdctl.mimic.sequence import PwmSequence
    from erdctl.model.parameters import Parameters


def command(
    params: Params,
    log: Annotated[
        str,
        typer.Argument(metavar="LOG", help="Motion and healthy duty: a bench log; - is stdin."),
    ],
    fault: Faults = [],
    output: Out = "-",
    manifest: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Manifest (JSON); by default OUTPUT.manifest.json."),
    ] = None,
    duty: Annotated[
        float | None, typer.Option(metavar="V", help="Healthy duty, in place of the log's.")
    ] = None,
    duty_max: Annotated[
        float, typer.Option(metavar="V", help="Highest duty; 0.45 is the highest the paper tested.")
    ] = 0.45,
    resolution: Annotated[
        float, typer.Option(metavar="V", help="Smallest step of the duty; 0 for none.")
    ] = 0.0,
    slew: Annotated[
        float | None, typer.Option(metavar="V/S", help="Fastest change of the duty per second.")
    ] = None,
    update_rate: Annotated[
        float | None, typer.Option(metavar="HZ", help="How often the duty can change.")
    ] = None,
    carrier: Annotated[float, typer.Option(metavar="HZ", help="PWM carrier.")] = 25_000.0,
    full_scale: Annotated[float, typer.Option(metavar="V", help="Voltage at duty 1.")] = 5_000.0,
    max_temperature: Annotated[
        float, typer.Option(metavar="C", help="Refuse a log with a higher temperature (Sec. 5.4).")
    ] = 60.0,
    ignore_temperature: Annotated[
        bool,
        typer.Option("--ignore-temperature", help="Do without the limit on the temperature."),
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Write even if the log got too hot.")
    ] = False,
    uncompensated: Annotated[
        bool, typer.Option("--uncompensated", help="The paper's static inverse, Eqs. 27, 31, 35.")
    ] = False,
    report: Report = None,
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
    date: Date = None,
    damper: Damper = None,
    operator: Operator = None,
    format: Annotated[
        OutputFormat | None, typer.Option(help="Format on stdout; default CSV.")
    ] = None,
    plot: Plots = [],
) -> None:
    """Mimic faults on a healthy damper: the PWM sequence to push to the amplifiers (Sec. 6).

    Writes the log's motion with `duty` replaced, the four channels duty_fl to duty_rr, and the
    force to expect, in any format of `convert` by suffix; MAT is laid out for Simulink. The default
    compensates the lag T_d and never leaves the amplifier's limits. Where no duty can produce the
    faulty force, the duty is zero and the missing force is reported as out of reach. Parameters
    with effects (from diagnose) are inverted by iteration, and the gain over the paper's parameters
    alone is reported. Effects of the force channel (a time skew, a drift) are not compensated.

    \b
    Examples:
      erdctl mimic damper.json drive.csv --fault oil=0.5@15:31 --fault electrical=0.8@31:46 \\
        --fault deformation=0.7@46 -o pwm.csv --report pwm.html
      erdctl mimic damper.json drive.csv --fault oil=0.5 --update-rate 200 -o pwm.mat
      erdctl mimic damper.json drive.csv --fault oil=0.5 | erdctl simulate damper.json -
      erdctl mimic damper.json drive.csv --fault oil=0.5 -o pwm.csv --plot f-v.png --plot duty:v.png
    """
    import math
    from hashlib import sha256

    from erdctl.cli.pictures import wanted
    from erdctl.cli.reading import labelled, read_logs
    from erdctl.core.errors import InputProblem, UsageProblem
    from erdctl.core.labels import labels_of
    from erdctl.io import documents, pwm
    from erdctl.io.parameters import parse_parameters
    from erdctl.io.temperature import files_of, guarded
    from erdctl.mimic.sequence import at_duty, sequence, strain, too_hot
    from erdctl.mimic.trusted import refuse_untrusted
    from erdctl.model.amplifier import Amplifier
    from erdctl.model.faults import parse_fault
    from erdctl.model.simulate import remarks
    from erdctl.report.text import progress, say

    if not fault:
        raise UsageProblem("mimic needs at least one --fault, e.g. --fault oil=0.5@15:31")
    if params == "-" and log == "-":
        raise UsageProblem("PARAMS and LOG cannot both be stdin")
    check_report(report)
    asked = wanted(plot, "mimic")
    labels = labels_of(date, damper, operator)
    amplifier = Amplifier(
        carrier=carrier, full_scale=full_scale, duty_max=duty_max, resolution=resolution,
        slew=math.inf if slew is None else slew, update_rate=update_rate,
    )  # fmt: skip
    faults = [parse_fault(f) for f in fault]
    data = documents.read_bytes(params)
    parameters = parse_parameters(data, "stdin" if params == "-" else params)
    refuse_untrusted(parameters, "stdin" if params == "-" else params)
    read = read_logs(
        [log],
        maps=maps,
        text=text,
        where=where,
        need_force=False,
        keep_table=True,
        want_hash=True,
        report=say,
    )
    read = labelled(read, labels)
    guard = guarded(
        read, max_temperature, declined=ignore_temperature, say_map="--map {}",
        say_decline="--ignore-temperature to do without the limit",
    )  # fmt: skip
    for line in guard.lines():
        say(line)
    heat = None if guard.limit is None else too_hot(read.recording, guard.limit)
    if heat is not None and not force:
        raise InputProblem(
            f"{heat}; nothing was written (--force overrides, Sec. 5.4)",
            file=files_of(read.recording),
        )
    if heat is not None:
        say(heat, "warning")
    recording = at_duty(read.recording, duty, "--duty")
    for line in remarks(parameters, recording):
        say(line)
    with progress() as step:
        found = sequence(
            parameters, recording, faults, amplifier, static=uncompensated, progress=step
        )
    for line in strain(found):
        say(line, "warning")
    pwm.write(found, read.table, output, format and format.value)
    if manifest is None and output != "-":
        manifest = f"{output}.manifest.json"
    if manifest is not None:
        document = pwm.manifest(
            found, amplifier=amplifier, parameters_sha256=sha256(data).hexdigest(),
            faults=[str(f) for f in faults], temperature=guard.document(),
        )  # fmt: skip
        documents.write(document, manifest)
    if report is not None:
        import sys

        from erdctl.cli.pages import write_report
        from erdctl.report.page.mimic import mimic_page
        from erdctl.report.page.render import Run

        run = Run(
            words=sys.argv[1:], logs=recording.sources, labels=recording.labels,
            details=[("parameters", f"{params}, SHA-256 {sha256(data).hexdigest()}")],
        )  # fmt: skip
        page = mimic_page(found.plans, recording, found.healthy, static=uncompensated, run=run)
        write_report(page, report)
    if asked:
        _draw(asked, found, parameters)
    _show(found)


def _draw(asked: list[Wanted], sequence: PwmSequence, parameters: Parameters) -> None:
    """Pictures of each faulty damper; of several, each has its name in the file's."""
    import os
    from dataclasses import replace

    from erdctl.cli.pictures import draw
    from erdctl.report.subjects import of_plan

    for channel, plan in sequence.plans.items():
        named = asked
        if len(sequence.plans) > 1:
            named = [replace(w, path=f"-{channel}".join(os.path.splitext(w.path))) for w in asked]
        draw(named, of_plan(plan, parameters, sequence.recording, static=sequence.static))


def _show(found: PwmSequence) -> None:
    from erdctl.mimic.sequence import held_back, idle, way_back, worth
    from erdctl.report.text import say, table

    plans = found.plans
    reaches = [(channel, r) for channel, plan in plans.items() for r in plan.reaches]
    # Of a static inverse its own figures alone: the others are of sequences that are not sent.
    corrected = not found.static and any(r.plain is not None for _, r in reaches)
    others = [] if found.static else ["paper's inverse"]
    header = [
        "fault", "damper", "NRMSE", *(["without effects"] if corrected else []), *others,
        "out of reach", "missing rms", "max",
    ]  # fmt: skip
    rows = [
        [
            str(r.fault), channel, *r.figures(static=found.static),
            f"{100 * r.out_of_reach:.1f} %", f"{r.missing_rms:.2f} N", f"{r.missing_max:.2f} N",
        ]
        for channel, r in reaches
    ]  # fmt: skip
    table("Expected force against the ideal faulty force, while each fault acts", header, rows)
    for line in (*worth(found), *way_back(found)):
        say(line)
    for line in held_back(found):
        say(f"{line}; --duty-max raises it", "warning")
    for line in idle(found):
        say(line, "warning")

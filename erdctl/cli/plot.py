"""`erdctl plot`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from erdctl.cli.options import Faults, Logs, Maps, Text, Where, picture_kinds

if TYPE_CHECKING:
    from erdctl.io.logs import Log
    from erdctl.report.subject import Subject


def command(
    logs: Logs,
    output: Annotated[
        str,
        typer.Option("--output", "-o", metavar="FILE", help="Picture: .png, .svg or .pdf."),
    ],
    kind: Annotated[
        str | None,
        typer.Option(
            metavar="KIND",
            help="One of the list above; loops, or faults.",
            autocompletion=picture_kinds,
        ),
    ] = None,
    params: Annotated[
        str | None,
        typer.Option(metavar="PARAMS", help="Model to draw with the log; - is stdin."),
    ] = None,
    before: Annotated[
        str | None, typer.Option(metavar="PARAMS", help="Model to compare that one with.")
    ] = None,
    fault: Faults = [],
    record: Annotated[
        list[str], typer.Option(metavar="NAME", help="Only this record. May be repeated.")
    ] = [],
    span: Annotated[
        str | None,
        typer.Option(metavar="START:END", help="Only this time of each record, in s."),
    ] = None,
    overlay: Annotated[
        str,
        typer.Option(
            metavar="log|corner|date|folder|NAME=PATTERN",
            help="What several logs are told apart by: each log, or what their paths say; a"
            " pattern is a regular expression, its first group or all of it the label, e.g."
            " 'damper=D[0-9]+'.",
        ),
    ] = "log",
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
) -> None:
    """Draw a bench log, and models over it.

    \b
    Kinds:
      loops         force against deflection and velocity, coloured by PWM level
      static        the static and the dynamic model (--params)
      time          force over time, measured and model, and their difference
      motion        deflection, velocity and duty over time
      duty          a mimic sequence, with the stretches out of reach
      faults        healthy and with each --fault (--params)
      mimic         force against velocity per mimicked fault (erdctl mimic --plot)
      yield-force   yield force against duty, and the law (--params)
      misfit        misfit over velocity and duty, and over the variable that locates it
      before-after  loops of two models over the same samples (--before, --params)
      peak-force    force at the peak velocity of each stroke
      average       averaged force-velocity curve per PWM level
      slow          gas force and seal drag from slow strokes without field

    Time series keep the extremes of every pixel column, loops every pixel that a sample fills. A
    log with force_model needs no --params.

    \b
    Examples:
      erdctl plot bench.parquet -o loops.png
      erdctl plot bench.parquet --params damper.json --kind time --span 2:5 -o force.svg
      erdctl plot bench.csv --params new.json --before old.json --kind before-after -o both.pdf
      erdctl plot drive.csv --params damper.json --fault oil=0.5 -o faults.png
      erdctl plot dyno.csv --kind peak-force -o peaks.png
      erdctl plot a.csv b.csv later.csv --overlay 'test=([a-z]+)[.]csv' -o tests.png
    """
    from dataclasses import replace

    from erdctl.cli.pictures import Wanted, draw, prepare, wants
    from erdctl.cli.reading import read_logs
    from erdctl.report import pictures
    from erdctl.report.overlays import paths_told
    from erdctl.report.picture import suffix
    from erdctl.report.subject import part
    from erdctl.report.subjects import PROGRAMME
    from erdctl.report.subjects import overlay as together
    from erdctl.report.text import say

    title, labels = paths_told(logs, overlay)
    chosen = kind or ("faults" if fault else "loops")
    pictures.get(chosen)
    asked = [Wanted(chosen, output, suffix(output))]
    window = _seconds(span)
    stdin = [source for source in (*logs, params, before) if source == "-"]
    if len(stdin) > 1:
        from erdctl.core.errors import UsageProblem

        raise UsageProblem("only one of LOG, --params and --before can be stdin")
    others = PROGRAMME if wants(asked, "programme") else ()
    prepare()
    log = read_logs(
        logs,
        maps=maps,
        text=text,
        where=where,
        need_force=False,
        want_force=True,
        others=others,
        report=say,
    )
    subject = _subject(log, params, before, fault, regions=wants(asked, "regions"))
    subject = replace(subject, overlay=together(log.recording, title, labels))
    draw(asked, part(subject, record, window))


def _subject(
    log: Log, params: str | None, before: str | None, faults: list[str], *, regions: bool
) -> Subject:
    from erdctl.core.errors import UsageProblem
    from erdctl.io.parameters import read_parameters
    from erdctl.model.simulate import simulate
    from erdctl.report.subject import Subject
    from erdctl.report.subjects import about, located, of_faults, programme

    recording, modelled, earlier, cases, parameters = log.recording, log.force_model, None, {}, None
    if params is not None:
        parameters = read_parameters(params)
        modelled = simulate(parameters, recording, faults)
        if faults:
            cases = of_faults(parameters, recording, faults)
    elif faults:
        raise UsageProblem("--fault needs --params")
    if before is not None:
        earlier = simulate(read_parameters(before), recording)
    missing = modelled if earlier is None else earlier
    return Subject(
        recording=recording,
        modelled=modelled,
        before=earlier,
        parameters=parameters,
        cases=cases,
        programme=programme(log.others),
        regions=() if not regions or missing is None else located(recording, missing),
        about=about(recording),
    )


def _seconds(span: str | None) -> tuple[float, float] | None:
    from erdctl.core.errors import UsageProblem

    if span is None:
        return None
    start, colon, end = span.partition(":")
    try:
        low, high = float(start or "-inf"), float(end or "inf")
    except ValueError:
        colon = ""
        low = high = 0.0
    if not colon or not low < high:
        raise UsageProblem(f"--span is START:END in seconds, e.g. 2:5.5, not '{span}'")
    return low, high

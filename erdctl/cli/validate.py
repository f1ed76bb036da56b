"""`erdctl validate`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from erdctl.cli.options import Damper, Date, Maps, Operator, Text, Where
from erdctl.cli.pages import Report, check_report
from erdctl.cli.pictures import Plots
from erdctl.cli.rig import Accept, Strict

if TYPE_CHECKING:
    from erdctl.core.recording import Recording
    from erdctl.score.nrmse import Score, Validation


def command(
    arguments: Annotated[
        list[str],
        typer.Argument(
            metavar="[PARAMS] LOG...",
            help="Parameter file and logs; or one log that already has `force_model`.",
        ),
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Scores as JSON on stdout.")] = False,
    fail_above: Annotated[
        float | None,
        typer.Option(metavar="X", help="Exit 1 if the NRMSE of any PWM level is above X."),
    ] = None,
    normalise: Annotated[
        str, typer.Option(metavar="range|std|mean|rms", help="Denominator of the NRMSE.")
    ] = "range",
    report: Report = None,
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
    date: Date = None,
    damper: Damper = None,
    operator: Operator = None,
    plot: Plots = [],
    accept: Accept = [],
    strict: Strict = False,
) -> None:
    """Compare modelled and measured force: NRMSE per PWM level, direction and record.

    NRMSE per PWM level = RMSE / (max - min of the measured force at that level); the paper does
    not state its own denominator. Faults of the rig (see `inspect`) are said, and their samples
    count like all others: the scores are those of the log as it is.

    \b
    Examples:
      erdctl validate damper.json other.csv --report validation.html
      erdctl validate damper.json other.csv --json --fail-above 0.1
      erdctl simulate damper.json drive.csv | erdctl validate -
      erdctl validate damper.json other.csv --plot loops.png --plot time:force.png
    """
    from functools import partial

    from erdctl.bench.rig import look
    from erdctl.cli.pictures import draw, wanted, wants
    from erdctl.cli.reading import labelled, read_logs
    from erdctl.cli.rig import fail, show
    from erdctl.core.errors import CheckFailed, InputProblem, UsageProblem
    from erdctl.core.labels import labels_of
    from erdctl.report.text import progress, say
    from erdctl.score.nrmse import Normalise, validate

    if normalise not in list(Normalise):
        raise UsageProblem(f"--normalise takes {', '.join(Normalise)}, not '{normalise}'")
    check_report(report)
    labels = labels_of(date, damper, operator)
    read = partial(
        read_logs, maps=maps, text=text, where=where, need_force=True,
        want_hash=report is not None, report=say,
    )  # fmt: skip
    asked, parameters = wanted(plot, "loops"), None
    if len(arguments) == 1:
        log = read(arguments)
        modelled = log.force_model
        if modelled is None:
            raise InputProblem(
                "the log has no column force_model; give a parameter file before it",
                file=arguments[0],
            )
    else:
        from erdctl.io.parameters import read_parameters
        from erdctl.model.simulate import remarks, simulate

        params, *logs = arguments
        if params == "-" and "-" in logs:
            raise UsageProblem("PARAMS and LOG cannot both be stdin")
        parameters = read_parameters(params)
        log = read(logs)
        for line in remarks(parameters, log.recording):
            say(line)
        with progress() as step:
            modelled = simulate(parameters, log.recording, progress=step)
    log = labelled(log, labels)
    labels = dict(log.recording.labels)
    rig = look(log.recording, modelled).accept(accept)
    show(rig)
    found = validate(log.recording, modelled, Normalise(normalise))
    if as_json:
        from erdctl.io import documents
        from erdctl.io.validation import to_json

        documents.write(to_json(found, labels, rig.to_json()), "-")
    else:
        _show(found, log.recording)
    if report is not None:
        import sys

        from erdctl.cli.pages import write_report
        from erdctl.estimate.measurement_noise import of_recording
        from erdctl.report.page.render import Run
        from erdctl.report.page.validation import validation_page

        run = Run(words=sys.argv[1:], logs=log.recording.sources, labels=labels)
        page = validation_page(
            found, log.recording, modelled, noise=of_recording(log.recording, modelled),
            limit=fail_above, run=run, rig=rig.lines(),
        )  # fmt: skip
        write_report(page, report)
    if asked:
        from erdctl.report.subject import Subject
        from erdctl.report.subjects import about, located

        draw(
            asked,
            Subject(
                recording=log.recording, modelled=modelled, parameters=parameters,
                regions=located(log.recording, modelled) if wants(asked, "regions") else (),
                about=about(log.recording),
            ),
        )  # fmt: skip
    if fail_above is not None:
        over = [f"{d:g}: {s.nrmse:.4f}" for d, s in found.by_duty.items() if s.nrmse > fail_above]
        if over:
            raise CheckFailed(f"NRMSE above {fail_above:g} at PWM level {', '.join(over)}")
    if strict:
        fail(rig)


def _show(found: Validation, recording: Recording) -> None:
    from erdctl.report.readable import largest, number, percent_of, scaled, with_unit
    from erdctl.report.text import table

    assert recording.force is not None
    peak = largest((float(recording.force.max()), float(recording.force.min())))
    factor, unit = scaled("N", found.overall.rms)

    def row(label: str, s: Score) -> list[str]:
        error = number(s.rms * factor)
        return [label, str(s.samples), error, f"{s.nrmse:.4f}", percent_of(s.rms, peak)]

    header = ["", "samples", f"RMSE [{unit}]", "NRMSE", f"of peak {with_unit(peak, 'N')}"]
    by = f"NRMSE over the {found.normalise.value} of the measured force"
    rows = [row(f"{100 * d:g} %", s) for d, s in found.by_duty.items()]
    rows.append(row("all", found.overall))
    levels = [s.nrmse for s in found.by_duty.values()]
    table(f"{by}, per PWM level", header, rows, bars={3: [*levels, found.overall.nrmse]})
    for split, scores in (("direction", found.by_direction), ("record", found.by_record)):
        if split == "direction" or len(scores) > 1:
            rows = [row(name, s) for name, s in scores.items()]
            table(f"{by}, per {split}", header, rows, bars={3: [s.nrmse for s in scores.values()]})

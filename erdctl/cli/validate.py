"""`erdctl validate`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from erdctl.cli.options import Damper, Date, Maps, Operator, Text, Where
from erdctl.cli.pages import Report, check_report
from erdctl.cli.pictures import Plots
from erdctl.cli.rig import Accept, Strict

if TYPE_CHECKING:
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
        str,
        typer.Option(
            metavar="range|std|mean|rms", help="Denominator of the NRMSE; mean: of |force|."
        ),
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
    count like all others: the scores are those of the log as it is. A long Parquet or Arrow file is
    read in stretches, and may be larger than memory; --plot and --report take all of it.

    \b
    Examples:
      erdctl validate damper.json other.csv --report validation.html
      erdctl validate damper.json other.csv --json --fail-above 0.1
      erdctl simulate damper.json drive.csv | erdctl validate -
      erdctl validate damper.json other.csv --plot loops.png --plot time:force.png
    """
    from erdctl.bench.rig import look
    from erdctl.bench.rig.fault import sound
    from erdctl.bench.unknown_direction import unknown_direction
    from erdctl.cli.long import UNMODELLED, validate_long
    from erdctl.cli.pictures import draw, wanted, wants
    from erdctl.cli.reading import labelled, read_logs
    from erdctl.cli.rig import fail, show
    from erdctl.core.errors import CheckFailed, InputProblem, UsageProblem
    from erdctl.core.labels import labels_of
    from erdctl.core.signals import Signals
    from erdctl.report.text import progress, say
    from erdctl.score.nrmse import Normalise, validate

    if normalise not in list(Normalise):
        raise UsageProblem(f"--normalise takes {', '.join(Normalise)}, not '{normalise}'")
    if fail_above is not None and not fail_above >= 0.0:  # nor is any error above nan
        raise UsageProblem(f"--fail-above takes a number of 0 or more, not {fail_above:g}")
    check_report(report)
    labels = labels_of(date, damper, operator)
    options: dict[str, Any] = {
        "maps": maps, "where": where, "need_force": True, "want_hash": report is not None,
    }  # fmt: skip
    asked, parameters, logs = wanted(plot, "loops"), None, arguments
    if len(arguments) > 1:
        from erdctl.io.parameters import read_parameters

        params, *logs = arguments
        if params == "-" and "-" in logs:
            raise UsageProblem("PARAMS and LOG cannot both be stdin")
        parameters = read_parameters(params)
    long = unknown = as_fitted = None
    if report is None and not asked:  # which take the whole log
        long = validate_long(parameters, logs, Normalise(normalise), options)
    if long is not None:
        found, rig, peak, said = long
        rig, labels = rig.accept(accept), {**said, **labels}
    else:
        log = read_logs(logs, text=text, report=say, **options)
        modelled = log.force_model
        if parameters is not None:
            from erdctl.model.simulate import remarks, simulate

            for line in remarks(parameters, log.recording):
                say(line)
            with progress() as step:
                modelled = simulate(parameters, log.recording, progress=step)
        elif modelled is None:
            raise InputProblem(UNMODELLED, file=arguments[0])
        log = labelled(log, labels)
        labels = dict(log.recording.labels)
        rig = look(log.recording, modelled).accept(accept)
        found = validate(log.recording, modelled, Normalise(normalise))
        mended = sound(log.recording, rig.faults)
        if parameters is not None and mended is not log.recording:
            again = validate(mended, simulate(parameters, mended), Normalise(normalise))
            as_fitted = again.overall
        assert log.recording.force is not None
        peak = max(float(log.recording.force.max()), -float(log.recording.force.min()))
        unknown = unknown_direction(Signals.of(log.recording), log.recording.force - modelled)
    show(rig)
    if unknown is not None:
        say(unknown.text(found.overall.nrmse))
    if as_fitted is not None:
        say(
            "the errors below are with the channels as they are logged; on what fits take in their"
            f" place the NRMSE of all samples is {as_fitted.nrmse:.4f} ({as_fitted.rms:.4g} N)"
        )
    if as_json:
        from erdctl.io import documents
        from erdctl.io.validation import to_json

        documents.write(to_json(found, labels, rig.to_json(), unknown), "-")
    else:
        _show(found, peak)
    if report is not None:
        assert modelled is not None
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

        assert modelled is not None
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


def _show(found: Validation, peak: float) -> None:
    from erdctl.report.readable import number, percent_of, scaled, with_unit
    from erdctl.report.text import table
    from erdctl.score.nrmse import BIN

    factor, unit = scaled("N", found.overall.rms)

    def row(label: str, s: Score) -> list[str]:
        error = number(s.rms * factor)
        return [label, str(s.samples), error, f"{s.nrmse:.4f}", percent_of(s.rms, peak)]

    header = ["", "samples", f"RMSE [{unit}]", "NRMSE", f"of peak {with_unit(peak, 'N')}"]
    by = f"NRMSE over the {found.normalise.words} of the measured force"
    rows = [row(f"{100 * d:g} %", s) for d, s in found.by_duty.items()]
    rows.append(row("all", found.overall))
    levels = [s.nrmse for s in found.by_duty.values()]
    # 7.5 % is a level that no sample of a continuous control need have.
    bins = f", the middle of a bin of {100 * BIN:g} %" if found.binned else ""
    table(f"{by}, per PWM level{bins}", header, rows, bars={3: [*levels, found.overall.nrmse]})
    for split, scores in (("direction", found.by_direction), ("record", found.by_record)):
        if split == "direction" or len(scores) > 1:
            rows = [row(name, s) for name, s in scores.items()]
            table(f"{by}, per {split}", header, rows, bars={3: [s.nrmse for s in scores.values()]})

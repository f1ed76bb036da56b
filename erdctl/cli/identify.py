"""`erdctl identify`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from erdctl.cli.options import Damper, Date, Logs, Maps, Operator, Out, Text, Where
from erdctl.cli.pictures import Plots
from erdctl.cli.rig import Accept, Strict
from erdctl.estimate.method import Method

if TYPE_CHECKING:
    from erdctl.estimate.identify import Identification
    from erdctl.model.parameters import Parameters


def command(
    logs: Logs,
    output: Out = "-",
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
    date: Date = None,
    damper: Damper = None,
    operator: Operator = None,
    method: Annotated[
        Method, typer.Option(help="Fit all parameters jointly, or as the paper does (Sec. 4).")
    ] = Method.JOINT,
    robust: Annotated[bool, typer.Option("--robust", help="Weigh outliers down (Huber).")] = False,
    plot: Plots = [],
    accept: Accept = [],
    strict: Strict = False,
) -> None:
    """Identify the paper's ER damper model from bench logs.

    Fits by the paper's procedure and then all parameters jointly, with standard errors that allow
    for correlated residuals. A parameter that the logs cannot identify has the value null and a
    reason: T_d without duty steps, sigma and beta with one duty level. `inspect` shows it before.

    Faults of the rig are looked for first (see `inspect`): what they spoil is left out of the fit
    and said, and a log that is spoiled as a whole, by a wrong sign or unit, say, is refused.

    A log in Parquet or Arrow of more than 8 million samples is read to its end, and fitted to a
    sample of them: whole records, or windows of long ones, evenly drawn, the same in every run. It
    is said, and written to the provenance as `sample`.

    \b
    Examples:
      erdctl identify bench.parquet -o damper.json
      erdctl identify a.csv b.csv --map "force=F_fl[N]" --map "x=Defl FL[mm]" -o damper.json
      erdctl identify bench.csv | erdctl validate - other.csv
      erdctl identify bench.csv -o damper.json --plot loops.png --plot yield-force:law.svg
    """
    from dataclasses import replace

    from erdctl.bench.rig import look
    from erdctl.cli.long import drawn_long
    from erdctl.cli.pictures import draw, wanted
    from erdctl.cli.reading import labelled, read_logs
    from erdctl.cli.rig import fail, show
    from erdctl.core.labels import labels_of
    from erdctl.estimate.identify import identify
    from erdctl.io.identification import parameters_of
    from erdctl.io.parameters import write_parameters
    from erdctl.report.text import progress, say

    asked = wanted(plot, "loops")
    labels = labels_of(date, damper, operator)
    options: dict[str, Any] = {
        "maps": maps, "where": where, "need_force": True, "want_hash": True,
    }  # fmt: skip
    drawn = drawn_long(logs, options)
    if drawn is None:
        log = labelled(read_logs(logs, text=text, report=say, **options), labels)
        rig = look(log.recording).accept(accept)
    else:
        rig = drawn.rig.accept(accept)
    rig.refuse()
    show(rig)
    if drawn is None:
        recording = rig.usable()
    else:
        recording = replace(drawn.usable(rig), labels={**drawn.recording.labels, **labels})
    with progress() as step:
        found = identify(recording, robust=robust, progress=step)
    parameters = parameters_of(found, method, recording, rig.to_json())
    if drawn is not None:
        whence = {**parameters.provenance, "sample": drawn.to_json()}
        parameters = replace(parameters, provenance=whence)
    write_parameters(parameters, output)
    if asked:
        from erdctl.model.simulate import simulate
        from erdctl.report.subject import Subject
        from erdctl.report.subjects import about

        modelled = simulate(parameters, recording)
        draw(
            asked,
            Subject(
                recording=recording, modelled=modelled, parameters=parameters,
                about=about(recording),
            ),
        )  # fmt: skip
    _show(found, parameters)
    if strict:
        fail(rig)


def _show(found: Identification, parameters: Parameters) -> None:
    from erdctl.io.identification import residual_of
    from erdctl.report.readable import error_of, number, scaled
    from erdctl.report.text import say, table

    # Both fits stand side by side, whichever of them is written.
    rows = []
    for name, e in found.joint.items():
        factor, unit = scaled(e.unit, e.used)
        values = (e.value, found.two_step.get(name))
        fit, steps = (number(None if v is None else v * factor, 6) for v in values)
        error = error_of(e.stderr, factor, at_bound=e.at_bound, value=e.value, within=e.within)
        rows.append([name, unit, fit, error, steps])
    table(
        f"Identified from {residual_of(parameters.fits)}",
        ["parameter", "unit", "joint fit", "std. error", "paper's steps"],
        rows,
    )
    for line in [*parameters.caveats(), *parameters.warnings]:
        say(line)

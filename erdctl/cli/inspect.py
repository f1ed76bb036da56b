"""`erdctl inspect`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from erdctl.cli.options import Damper, Date, Logs, Maps, Operator, Text, Where
from erdctl.cli.rig import Strict
from erdctl.core.messages import counted

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from erdctl.bench.identifiability import Cover
    from erdctl.bench.inspection import Inspection, NoiseFloor
    from erdctl.core.progress import Progress
    from erdctl.core.recording import Recording
    from erdctl.diagnose.forecast import Forecast
    from erdctl.io.inspection import InspectionFile

LISTED = 40  # records in a table; the JSON has all


def command(
    logs: Logs,
    as_json: Annotated[bool, typer.Option("--json", help="Everything as JSON on stdout.")] = False,
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
    strict: Strict = False,
    forecast: Annotated[
        bool,
        typer.Option(
            "--forecast",
            help="Say from which size each effect would show in a diagnosis; takes seconds.",
        ),
    ] = False,
    params: Annotated[
        str | None,
        typer.Option(
            metavar="PARAMS",
            help="With --forecast: the damper, in place of a fit; needed without a force.",
        ),
    ] = None,
    noise: Annotated[
        float | None,
        typer.Option(
            metavar="N", min=0.0, help="With --forecast: force noise [N rms], in place of a guess."
        ),
    ] = None,
    date: Date = None,
    damper: Damper = None,
    operator: Operator = None,
) -> None:
    """Say what is in a log, and what it can and cannot show, before anything is fitted.

    Prints channels and their units, sampling rates, gaps, duty levels, stroke, speed and force
    reached, and an estimate of the force noise. Then it lists every parameter of the paper's model
    and every effect of the catalogue that the log cannot identify: what was found, what is needed,
    and a drive that would show it. identify and diagnose decide by the same rules.

    Faults of the rig come before that, each with its place and a remedy: a wrong sign or unit, an
    inverted duty, channels that are clipped, frozen or held (read at a slower rate than the log),
    spikes, bursts of noise, lost samples, records unlike the others in gain, zero, lag, noise or
    duty, and a velocity channel that does not follow x. A long Parquet or Arrow file is read in
    stretches, and may be larger than memory.

    --forecast says of every effect from which size this motion and control would show it, for the
    paper's model and the noise of the force: also of a drive that is only planned, which has no
    force, with --params and --noise.

    A LOG has the columns t [s], x [m], xdot [m/s], duty (0 to 1) and force [N], x and xdot positive
    in compression; record and temperature [degC] are optional. --map takes other names and units.

    \b
    Examples:
      erdctl inspect bench.csv
      erdctl inspect bench.parquet --json
      erdctl inspect bench.parquet --forecast
      erdctl inspect lab.csv --map "t=Time[ms]" --map "x=Defl FL[mm]" --map "force=F_fl[N]" \\
        --map "duty=PWM[%]"
    """
    from erdctl.bench.inspection import inspect
    from erdctl.cli.long import inspect_long
    from erdctl.cli.reading import labelled, read_logs
    from erdctl.cli.rig import fail, show
    from erdctl.core.errors import UsageProblem
    from erdctl.core.labels import labels_of
    from erdctl.core.progress import part_of
    from erdctl.effects import catalogue
    from erdctl.io import documents
    from erdctl.io.inspection import subject_of, to_json
    from erdctl.report.text import progress, say

    if not forecast and (params is not None or noise is not None):
        raise UsageProblem("--params and --noise go with --forecast")
    labels = labels_of(date, damper, operator)
    options: dict[str, Any] = {
        "maps": maps, "where": where, "need_force": False, "want_force": True,
        "want_hash": as_json,
    }  # fmt: skip
    long = None if forecast else inspect_long(logs, options, labels)  # which takes the whole log
    if long is not None:
        found, document = long
    else:
        log = labelled(read_logs(logs, text=text, report=say, **options), labels)
        with progress() as step:
            step("inspecting", part_of(f"{len(log.recording)} samples", 1, 1))
            found = inspect(log.recording, catalogue())
            ahead = _forecast(log.recording, params, noise, step) if forecast else None
        document = to_json(found, subject_of(log), ahead)
    show(found.rig)
    if as_json:
        documents.write(document, "-")
    else:
        _show(found, document)
        _show_forecast(document)
    if strict:
        fail(found.rig)


def _forecast(
    recording: Recording, params: str | None, noise: float | None, step: Progress
) -> Forecast:
    from erdctl.diagnose.forecast import forecast
    from erdctl.effects import catalogue
    from erdctl.io.parameters import read_parameters

    given = None if params is None else read_parameters(params)
    return forecast(recording, catalogue(), parameters=given, noise=noise, progress=step)


def _show_forecast(document: InspectionFile) -> None:
    from erdctl.report.text import table
    from erdctl.report.undetected import HEADER, undetected_rows

    if "forecast" in document:
        ahead = document["forecast"]
        title = f"What a diagnosis would show, at a white noise of {ahead['noise_rms']:.2g} N rms"
        table(title, HEADER, undetected_rows(ahead["effects"]))


def _show(found: Inspection, document: InspectionFile) -> None:
    from erdctl.report.readable import largest, number, scaled
    from erdctl.report.text import say, table

    def span(ends: Sequence[float] | None, unit: str = "1", digits: int = 4) -> list[str]:
        """Both ends in the unit that people read the larger one in."""
        if ends is None:
            return ["-", "-"]
        factor, shown = (100.0, "%") if unit == "%" else scaled(unit, largest(ends))
        return [f"{number(v * factor, digits)} {'' if shown == '1' else shown}".rstrip()
                for v in ends]  # fmt: skip

    # A zero of its own, as that of degF, is part of the conversion.
    shifted = any(c["offset"] for c in document["channels"])
    table(
        f"{counted(found.samples, 'sample')}, {found.duration:.6g} s in"
        f" {counted(len(found.records), 'record')}",
        ["channel", "column of the log", "times", *["plus"] * shifted,
         "is in", "lowest", "highest"],
        [
            [
                c["name"], c["column"], number(c["factor"]), *[number(c["offset"])] * shifted,
                c["unit"],
                *span(c["range"], "%" if c["name"] == "duty" else c["unit"]),
            ]
            for c in document["channels"] if c["range"] is not None
        ],
    )  # fmt: skip
    hot = any(r["temperature"] for r in document["records"])
    factor, newton = scaled("N", largest(f for r in document["records"] for f in r["force"] or []))
    rows = [
        [
            r["name"], str(r["samples"]), number(r["duration"]), number(r["rate"]),
            str(r["gaps"]), number(1e3 * (r["x"][1] - r["x"][0])), number(1e3 * r["speed"]),
            " to ".join(number(100 * d, 3) for d in r["duty"]),
            " to ".join(number(f * factor, 3) for f in r["force"] or []) or "-",
            *([span(r["temperature"])[1]] * hot),
        ]
        for r in document["records"][:LISTED]
    ]  # fmt: skip
    header = ["record", "samples", "length [s]", "rate [Hz]", "gaps", "stroke [mm]",
              "top speed [mm/s]", "duty [%]", f"force [{newton}]",
              *(["top [degC]"] * hot)]  # fmt: skip
    table("Records", header, rows)
    if len(found.records) > LISTED:
        say(f"{counted(len(found.records) - LISTED, 'more record')}; --json lists all")
    seconds = list(found.seconds_at.values())
    table(
        "Time at each duty level",
        ["duty", "time [s]"],
        [[f"{100 * d:g} %", number(s)] for d, s in found.seconds_at.items()],
        bars={1: seconds},
    )
    for line in _remarks(found, document):
        say(line)
    _show_coverage("parameters of the paper's model", found.parameters)
    _show_coverage("effects of the catalogue", found.effects)


def _remarks(found: Inspection, document: InspectionFile) -> Iterator[str]:
    yield f"xdot: {found.xdot}"
    gapped = [r for r in found.records if r.gaps]
    for r in gapped[:LISTED]:
        yield (
            f"record '{r.name}': {counted(r.missing, 'sample')} missing in"
            f" {counted(r.gaps, 'gap')}, the longest of {r.longest_gap:.4g} s at t ="
            f" {r.gap_at:.6g} s"
        )
    if len(gapped) > LISTED:
        yield f"gaps in {counted(len(gapped) - LISTED, 'more record')}; --json lists all"
    if all(r.force is None for r in found.records):
        yield "no column force: what follows is what this motion and duty would show with one"
    elif found.noise is None:
        yield "every record is too short for a guess at the force noise, which takes 4 samples"
    else:
        yield (
            f"force noise, from sample to sample: about {found.noise.rms:.2g} N rms (a guess,"
            f" before any fit){_resolution(found.noise)}"
        )
        if found.mass is not None:
            yield (
                f"inertia: a mass below {found.mass:.2g} kg makes less force than that noise,"
                " beyond what a spring would take up"
            )
    if document["other_columns"]:
        yield f"columns that are not used: {', '.join(document['other_columns'])}"


def _resolution(noise: NoiseFloor) -> str:
    """The smallest step; of a force that is no multiple of one it is a chance neighbour's."""
    if noise.resolution == 0.0:
        return "; every value seen of the force is the same"
    return (
        "; the smallest difference seen between two values of the force is"
        f" {noise.resolution:.2g} N"
    )


def _show_coverage(what: str, found: Sequence[Cover]) -> None:
    """One line for what the log shows, and one for each reason why it does not show the rest."""
    from erdctl.report.text import say

    able = [c.name for c in found if c.lack is None]
    say(f"{len(able)} of {len(found)} {what}: {', '.join(able) or 'none'}", "can be identified")
    together: dict[tuple[str, ...], list[str]] = {}
    for c in found:
        if c.lack is not None:
            measures = "; ".join(str(n) for n in c.checks if not n.met)
            drives = " ".join(f"--drive {d}" for d in c.drives)
            reason = "" if c.lack.reason == measures else f"{c.lack.reason}; "
            together.setdefault((reason, measures, drives), []).append(c.name)
    for (reason, measures, drives), names in together.items():
        say(
            f"{', '.join(names)}: {reason}{measures}; would show with {drives}",
            "cannot be identified",
        )

"""`erdctl diagnose`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from erdctl.cli.options import (
    Cluster,
    Damper,
    Date,
    Logs,
    Maps,
    Operator,
    Out,
    Text,
    Where,
    effect_names,
)
from erdctl.cli.pages import Report, check_report
from erdctl.cli.pictures import Plots
from erdctl.cli.rig import Accept, Strict
from erdctl.diagnose.thresholds import MOST_EFFECTS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from erdctl.diagnose.diagnosis import Diagnosis
    from erdctl.model.effect import Effect
    from erdctl.model.parameters import Parameters


def command(
    logs: Logs,
    params: Annotated[
        str | None,
        typer.Option(
            metavar="PARAMS",
            help="Diagnose the model of this parameter file in place of the paper's, and"
            " report its error on these logs; - is stdin.",
        ),
    ] = None,
    output: Out = "-",
    only: Annotated[
        list[str],
        typer.Option(
            "--effects",
            metavar="NAME,...",
            help="Test these effects only.",
            autocompletion=effect_names,
        ),
    ] = [],
    exclude: Annotated[
        list[str],
        typer.Option(
            metavar="NAME,...", help="Do not test these effects.", autocompletion=effect_names
        ),
    ] = [],
    record_gains: Annotated[
        bool,
        typer.Option(
            "--record-gains",
            help="Estimate record effects: one gain of the force per record, mean 1,"
            " reported apart and not as a finding.",
        ),
    ] = False,
    record_offsets: Annotated[
        bool,
        typer.Option(
            "--record-offsets",
            help="The same for a zero offset of the force per record [N], mean 0."
            " An offset that all records share stays a finding.",
        ),
    ] = False,
    max_effects: Annotated[
        int,
        typer.Option(
            min=1, max=MOST_EFFECTS, help="Most effects in one model; the data end it before."
        ),
    ] = MOST_EFFECTS,
    seed: Annotated[int, typer.Option(help="Of the regression of the lack-of-fit test.")] = 0,
    jobs: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Processes that fit hypotheses; default: all cores, 1 for a small log. The result"
            " is the same for any number.",
        ),
    ] = None,
    cluster: Cluster = None,
    fail_on_mismatch: Annotated[
        bool,
        typer.Option(
            "--fail-on-mismatch",
            help="Exit 1 unless the verdict is adequate and given parameters hold.",
        ),
    ] = False,
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
    """Locate a misfit, name the effects that the model lacks, and write the corrected model.

    Fits the paper's model alone and with each effect of the catalogue. Forward selection adds
    further effects; companion effects are also tested jointly. An effect is kept only if the error
    on data left out of the fit falls by more than its scatter (cross-validation). Samples whose
    direction of motion is lost in the noise of xdot have weight zero.

    Faults of the rig are looked for first (see `inspect`): what they spoil is left out, listed
    under `rig`, and never given the name of a physical effect.

    A lack-of-fit test of the residual then decides the verdict. adequate: the model, fitted to this
    log, is enough. explained: with the effects found, the residual is noise. unexplained: a misfit
    is left that no effect of the catalogue explains; the diagnosis says where it is and what it
    resembles, and which fault some of the records have, if one explains it.
    So is a log of one duty and one speed in which an effect was found, or of two duties and two
    kinds of motion at most in which several were, since others would do as well there; the drives
    that would tell them apart are named. And so is a log in which a channel stops at a limit, where
    the model holds within it: what lay beyond is not in the log.
    Look-alikes, which these data cannot tell apart, are listed with a drive on which they differ.

    The JSON holds the corrected parameter file under corrected.params (schema: erdctl schema
    diagnosis). What a log cannot show is listed as not testable, never as absent.

    \b
    Examples:
      erdctl diagnose bench.parquet -o diagnosis.json --report diagnosis.html
      erdctl diagnose a.csv b.csv --exclude thermal_fade --fail-on-mismatch
      erdctl diagnose bench.csv --effects backlash,mount_compliance
      erdctl diagnose bench.parquet --jobs 2 --max-effects 4
      erdctl diagnose bench.parquet --record-gains --record-offsets
      erdctl identify bench.csv | erdctl diagnose later.csv --params - -o diagnosis.json
      erdctl diagnose bench.csv -o diagnosis.json --plot before-after.png --plot misfit:map.svg
    """
    from functools import partial

    from erdctl.cli.pictures import draw, wanted
    from erdctl.cli.reading import labelled, read_logs
    from erdctl.cli.rig import fail, show
    from erdctl.core.cluster import cluster_or_none
    from erdctl.core.errors import CheckFailed, UsageProblem
    from erdctl.core.labels import labels_of
    from erdctl.diagnose.corrected import parameters
    from erdctl.diagnose.diagnosis import Verdict, diagnose
    from erdctl.diagnose.fault_wording import as_fault_text
    from erdctl.diagnose.jobs import worthwhile
    from erdctl.diagnose.one_after_another import with_a_fault_once
    from erdctl.diagnose.record_effects import Varying
    from erdctl.effects import candidates
    from erdctl.io import documents
    from erdctl.io.diagnosis import to_json
    from erdctl.report.text import progress, say

    check_report(report)
    asked = wanted(plot, "before-after")
    labels = labels_of(date, damper, operator)
    given, file = _given(params, logs)
    log = read_logs(
        logs, maps=maps, text=text, where=where, need_force=True, want_hash=True, report=say
    )
    log = labelled(log, labels)
    tested = candidates(_names(only), _names(exclude))
    if cluster is not None and jobs is not None:
        raise UsageProblem("--jobs is for this machine: leave it out with --cluster")
    with progress() as step, cluster_or_none(cluster) as there:
        run = partial(
            diagnose, candidates=tested, most=max_effects, given=given,
            free=Varying(gain=record_gains, offset=record_offsets), accepted=accept, seed=seed,
            jobs=jobs or worthwhile(log.recording, tested), cluster=there, progress=step,
        )  # fmt: skip
        found = with_a_fault_once(run, log.recording)
    document = to_json(found, file)
    documents.write(document, output)
    if report is not None:
        _report(found, document, report, seed)
    if asked:
        from erdctl.report.subjects import of_diagnosis

        draw(asked, of_diagnosis(found, parameters(found)))
    show(found.rig)
    _show(found)
    if strict:
        fail(found.rig)
    if fail_on_mismatch and found.verdict is not Verdict.ADEQUATE:
        raise CheckFailed(f"the paper's model does not hold: {found.verdict.value}")
    if fail_on_mismatch and found.as_fault is not None:
        raise CheckFailed(f"the given parameters do not hold: {as_fault_text(found)}")


def _given(params: str | None, logs: Sequence[str]) -> tuple[Parameters | None, dict[str, str]]:
    """The parameters of a file, and its name and hash."""
    import hashlib

    from erdctl.core.errors import UsageProblem
    from erdctl.io import documents
    from erdctl.io.parameters import parse_parameters

    if params is None:
        return None, {}
    if params == "-" and "-" in logs:
        raise UsageProblem("PARAMS and LOG cannot both be stdin")
    data = documents.read_bytes(params)
    found = parse_parameters(data, "stdin" if params == "-" else params)
    return found, {"name": params, "sha256": hashlib.sha256(data).hexdigest()}


def _names(options: Sequence[str]) -> list[str]:
    return [name.strip() for option in options for name in option.split(",") if name.strip()]


def _report(found: Diagnosis, document: dict[str, Any], path: str, seed: int) -> None:
    import sys

    from erdctl.cli.pages import write_report
    from erdctl.diagnose.corrected import baseline, parameters
    from erdctl.model.simulate import simulate
    from erdctl.report.page.diagnosis import diagnosis_page
    from erdctl.report.page.render import Run

    recording = found.problem.recording
    before, after = (simulate(p, recording) for p in (baseline(found), parameters(found)))
    run = Run(
        words=sys.argv[1:], logs=recording.sources, labels=recording.labels,
        details=[("seed", str(seed)), ("velocity", recording.xdot_note)],
    )  # fmt: skip
    write_report(diagnosis_page(document, recording, before=before, after=after, run=run), path)


def _show(found: Diagnosis) -> None:
    from math import nan

    from erdctl.diagnose.corrected import parameters
    from erdctl.diagnose.fault_wording import as_fault_text
    from erdctl.diagnose.learning.words import law_text
    from erdctl.diagnose.wording import finding_text, record_values, remaining_text, unseen_text
    from erdctl.model.corrected_equation import corrected_equation
    from erdctl.report.readable import headline, largest, number, percent_of, with_unit
    from erdctl.report.text import say, table

    def with_error(value: float, error: float | None) -> str:
        return number(value) + ("" if error is None else f" +- {number(error, 2)}")

    shown = {"paper's model": found.baseline, "corrected": found.corrected}
    if found.given is not None:
        shown = {"given": found.baseline, "refitted": found.refitted, "corrected": found.corrected}
    rows = [
        [f"{100 * d:g} %", *(f"{v.by_duty[d].nrmse:.4f}" for v in shown.values())]
        for d in found.baseline.by_duty
    ]
    force = found.problem.recording.force
    assert force is not None
    peak = largest((float(force.max()), float(force.min())))
    errors = [v.overall.rms for v in shown.values()]
    rows.append(["all", *(f"{v.overall.nrmse:.4f}" for v in shown.values())])
    rows.append(["all, rms", *(with_unit(e, "N") for e in errors)])
    rows.append([f"of {with_unit(peak, 'N')} peak", *(percent_of(e, peak) for e in errors)])
    title = f"Verdict: {found.verdict.value}. NRMSE over the range, per PWM level"
    bars = {
        i: [*(s.nrmse for s in v.by_duty.values()), v.overall.nrmse, nan, nan]
        for i, v in enumerate(shown.values(), start=1)
    }
    table(title, ["", *shown], rows, bars)
    values = record_values(found)
    if values:
        header = [k for k in ("gain", "offset") if k in values[0]]
        table(
            "Record effects, apart from the shared parameters",
            ["", *(f"{k} [{values[0][k]['unit']}]" for k in header)],
            [
                [v["name"], *(with_error(v[k]["value"], v[k]["stderr"]) for k in header)]
                for v in values
            ],
        )
    known = parameters(found)
    for finding in found.findings:
        effect = finding.effect
        own = {q.symbol: known.estimates[effect.key(q.symbol)] for q in effect.quantities}
        said = headline(effect, {symbol: e.value for symbol, e in own.items()})
        say(f"{said}: {finding_text(finding)}", effect.name)
        _say_parameters(effect, known, effect.name)
    if found.findings:
        for line in corrected_equation([f.effect for f in found.findings]):
            say(line, "corrected")
    for law in found.learned.laws if found.learned is not None else ():
        say(law_text(law), "learned")
        say(f"  {law.law.equation}", "learned")
        _say_parameters(law.finding.effect, known, "learned")
    for unseen in found.unseen:
        say(unseen_text(unseen), "unseen")
    for region in found.mismatch:
        say(region.text, "where")
    if changed := as_fault_text(found):
        say(changed, "given")
    say(remaining_text(found), "remains")


def _say_parameters(effect: Effect, known: Parameters, what: str) -> None:
    """An effect's parameters, and why any of them has no value."""
    from erdctl.report.readable import estimate
    from erdctl.report.text import say

    own = {q: known.estimates[effect.key(q.symbol)] for q in effect.quantities}
    for q, e in own.items():
        said = estimate(e.value, e.unit, e.stderr, at_bound=e.at_bound, within=e.within)
        if e.value is None:
            said += f", {estimate(e.assumed, e.unit)} in simulations"
        say(f"  {q.symbol} = {said}  ({q.title})", what)
    for reason in dict.fromkeys(e.reason for e in own.values() if e.reason):
        say(f"  not identified: {reason}", what)

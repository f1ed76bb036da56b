"""`erdctl compare`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from erdctl.cli.options import Maps, Text, Where
from erdctl.cli.pages import Report, check_report

if TYPE_CHECKING:
    from erdctl.compare.comparison import Compared

NAMED = 40  # unchanged dampers that are listed


def command(
    arguments: Annotated[
        list[str],
        typer.Argument(
            metavar="FILE...",
            help="Tables of campaigns, or parameter files and diagnoses, the earlier ones first;"
            " - is stdin.",
        ),
    ],
    output: Annotated[
        str | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help="The result: .json is the document, .csv, .md and .tex (booktabs) are tables.",
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The document to stdout.")] = False,
    limits: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Tolerance bands, TOML or JSON: a parameter or a score with low, high or both;"
            " exit 1 if one fails.",
        ),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Exit 1 also where a band cannot be told to hold.")
    ] = False,
    refit: Annotated[
        bool,
        typer.Option(
            "--refit",
            help="Fit the logs that the files name with the effects that any of the files has.",
        ),
    ] = False,
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
    report: Report = None,
    plot: Annotated[
        list[str],
        typer.Option(
            "--plot",
            metavar="FILE",
            help="The fleet at a glance: .png, .svg or .pdf. May be repeated.",
        ),
    ] = [],
    false_alarms: Annotated[
        float,
        typer.Option(
            metavar="P",
            min=1e-6,
            max=0.5,
            help="Chance that a change over time is told of any damper where none changes.",
        ),
    ] = 0.02,
) -> None:
    """Say what changed by more than its error: since last time, over months, against tolerances.

    Eight dated logs of a damper or more are followed over time: each parameter is constant, has a
    step, a ramp since a date, or a line, with the interval of the date and the rate a year. Logs
    scatter by more than the errors of their fits, which is read from the logs themselves; single
    outliers count little, and all dampers, parameters and dates that are looked at count. An
    effect that is not named has its off value, and may be as large as the size from which it
    would have been named.
    Fewer logs: the last against the first, by the errors of both fits. Parameter files that tell
    how their errors go together are judged together, too (chi2); others by standard errors alone.
    An effect that one file has and another lacks is in other parameters there. With --refit a log
    whose file lacks one is fitted again with the effects of all, and what then differs is the
    damper; it must lie where the file says, unchanged, and is read as identify does (--map, --text,
    --where).

    \b
    Limits, e.g. limits.toml (SI, or text with a unit; c_vis is meant in both directions):
      c_vis = { low = 45, high = 60 }
      "backlash.g" = { high = "0.5 mm" }
      nrmse = { high = 0.02 }
    A band passes or fails only if the 95 % interval lies all within or all without; else it cannot
    be told. What is judged is the trend at the last date, or else the last log. The parameters are
    those of a diagnosis's corrected model where there is one; nrmse and nrmse_worst are always of
    its baseline, the model before anything was found (in a campaign, the identified one).

    \b
    Examples:
      erdctl compare old.json new.json
      erdctl compare old.json new.json --refit
      erdctl compare results.parquet -o changes.csv --report fleet.html --plot fleet.png
      erdctl compare results.parquet --limits limits.toml --json
      erdctl compare damper.json --limits limits.toml
    """
    import sys

    from erdctl.compare.comparison import compare
    from erdctl.compare.tolerance import Holds
    from erdctl.core.errors import CheckFailed, InputProblem, UsageProblem
    from erdctl.io.campaign_in import histories
    from erdctl.io.limits_file import read_limits
    from erdctl.io.states import read_inputs
    from erdctl.report.changes import judged_text

    check_report(report)
    _check_outputs(output, plot)
    rules = [] if limits is None else read_limits(limits)
    again = None
    if refit:
        from functools import partial

        from erdctl.cli.refit import refitted

        again = partial(refitted, options={"maps": maps, "text": text, "where": where})
    elif maps or text or where:
        raise UsageProblem("--map, --text and --where are for the logs that --refit reads")
    given = read_inputs(arguments, again)
    found_histories = histories(given.table, given.covariances)
    if not any(h.logs for h in found_histories):
        raise InputProblem("no log with a result in it")
    _remark(given.table)
    found = compare(found_histories, rules=rules, across=given.documents, false_alarms=false_alarms)
    if output is not None:
        _write(found, output)
    if as_json:
        from erdctl.io import documents

        documents.write(_document(found), "-")
    if plot:
        _draw(found, plot)
    if report is not None:
        from erdctl.cli.pages import write_report
        from erdctl.report.page.comparison import comparison_page
        from erdctl.report.page.render import Run

        details = [("compared", ", ".join(arguments[:8]))]
        write_report(comparison_page(found, run=Run(words=sys.argv[1:], details=details)), report)
    _show(found)
    bad = (Holds.FAIL, Holds.UNKNOWN) if strict else (Holds.FAIL,)
    failing = [(d, j) for d in found.dampers for j in d.judged if j.holds in bad]
    if failing:
        damper, first = failing[0]
        more = f", and {len(failing) - 1} more" if len(failing) > 1 else ""
        raise CheckFailed(f"{damper.history.damper}: {judged_text(first)}{more}")


def _check_outputs(output: str | None, plots: list[str]) -> None:
    from erdctl.io.table_out import suffix_of
    from erdctl.report.picture import suffix

    if output is not None and output != "-" and not output.lower().endswith(".json"):
        suffix_of(output)
    for path in plots:
        suffix(path)


def _remark(table: Any) -> None:
    """Logs that nothing says the damper of."""
    import pyarrow.compute as pc

    from erdctl.report.text import say

    columns = [table.column(name) for name in ("damper", "corner")]
    lonely = pc.and_(*[pc.is_null(c) for c in columns])
    if pc.any(lonely).as_py():
        say(
            "logs without damper and corner stand each for a damper of its own; --damper of"
            " identify, or erdctl.toml, says whose they are"
        )


def _document(found: Compared) -> object:
    from erdctl.io.compared import Words, to_json
    from erdctl.report.changes import damper_texts, difference_text, pair_remarks, trend_text

    return to_json(found, Words(trend_text, difference_text, damper_texts, pair_remarks))


def _write(found: Compared, path: str) -> None:
    if path == "-" or path.lower().endswith(".json"):
        from erdctl.io import documents

        documents.write(_document(found), path)
        return
    from erdctl.io.table_out import write_table
    from erdctl.report.change_table import rows

    write_table(path, *rows(found, short=not path.lower().endswith(".csv")))


def _draw(found: Compared, plots: list[str]) -> None:
    from erdctl.io.atomic import output
    from erdctl.report.fleet_picture import fleet_figure
    from erdctl.report.picture import suffix, write

    for path in plots:
        figure = fleet_figure(found)
        with output(path) as stream:
            write(figure, stream, suffix(path))


def _show(found: Compared) -> None:
    from erdctl.compare.comparison import Attention
    from erdctl.compare.tolerance import Holds
    from erdctl.report.changes import damper_texts, head, pair_remarks
    from erdctl.report.text import listing, say

    urgent = [d for d in found.dampers if d.attention < Attention.QUIET]
    listing(
        head(found), {f"{d.history.damper}: {d.attention.words}": damper_texts(d) for d in urgent}
    )
    for kind in (Attention.QUIET, Attention.ALONE):
        some = [d.history.damper for d in found.dampers if d.attention is kind]
        if some:
            say(f"{kind.words}: {', '.join(some[:NAMED])}{' ...' if len(some) > NAMED else ''}")
    for line in dict.fromkeys(r for d in found.dampers for p in d.pairs for r in pair_remarks(p)):
        say(line)
    if any(d.judged for d in found.dampers):
        counts = ", ".join(f"{found.count(h)} {h.value}" for h in Holds)
        say(f"limits: {counts}")

"""`erdctl campaign`."""

from __future__ import annotations

from contextlib import contextmanager
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

from erdctl.cli.options import Cluster, Maps, Text, Where, effect_names
from erdctl.cli.rig import Accept
from erdctl.core.messages import counted

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from re import Pattern

    from erdctl.campaign.plan import Labelling, Reading
    from erdctl.campaign.run import Crew
    from erdctl.cli.in_force import InForce
    from erdctl.io.campaign_journal import Entry


class Action(StrEnum):
    """What is done with a campaign."""

    RUN = "run"


def command(
    action: Annotated[Action, typer.Argument(metavar="run", help="The word run.")],
    logs: Annotated[
        list[str],
        typer.Argument(
            metavar="PATH...",
            help="Logs: files, folders, patterns in quotes ('lab/**/*.csv'), URLs (s3://...); - is"
            " a list of them on stdin, one a line.",
        ),
    ],
    output: Annotated[
        str,
        typer.Option("--output", "-o", metavar="FILE.parquet", help="The table."),
    ],
    keep: Annotated[
        str | None,
        typer.Option(
            metavar="DIR",
            help="Where the JSON documents go, and what was done is kept; FILE without .parquet if"
            " not given.",
        ),
    ] = None,
    steps: Annotated[
        str,
        typer.Option(
            metavar="STEP,...", help="Of inspect, identify, validate and diagnose, which."
        ),
    ] = "identify,validate",
    diagnose_above: Annotated[
        float | None,
        typer.Option(
            metavar="NRMSE",
            min=0.0,
            help="Diagnose only logs that their own identified model misses by more.",
        ),
    ] = None,
    label: Annotated[
        str | None,
        typer.Option(
            metavar="REGEX",
            help="What a path says of its log, by names: damper, corner, date; others are"
            " conditions.",
        ),
    ] = None,
    group_by: Annotated[
        str | None,
        typer.Option(
            metavar="NAME,...", help="One identification over the logs that share these labels."
        ),
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Logs at a time; all cores if not given.")
    ] = None,
    cluster: Cluster = None,
    only: Annotated[
        list[str],
        typer.Option(
            "--effects", metavar="NAME,...", help="As in diagnose.", autocompletion=effect_names
        ),
    ] = [],
    exclude: Annotated[
        list[str],
        typer.Option(metavar="NAME,...", help="As in diagnose.", autocompletion=effect_names),
    ] = [],
    seed: Annotated[int, typer.Option(help="As in diagnose.")] = 0,
    maps: Maps = [],
    text: Text = [],
    where: Where = [],
    accept: Accept = [],
) -> None:
    """Run inspect, identify, validate and diagnose over many logs, into one table.

    The Parquet table has a row for each log, command and parameter, with what belongs to the log
    in each of them: labels, the score of its identified model (not of a diagnosis's corrected one),
    verdict, findings, rig faults, hashes. A log that cannot be done is a row with its error, and
    the exit code is then 1. The JSON documents of each log are in the folder of --keep.

    What is there and unchanged (by the log's SHA-256, the options and the version of erdctl) is not
    done again: a campaign that was ended anywhere, or to which logs were added, is taken up by the
    same command. The table does not depend on order, workers or interruptions. Where a project
    file holds (see `erdctl project`), it says how logs are read, and what --label does not.

    --cluster takes a Dask cluster in place of this machine: any that Dask starts, on SLURM,
    Kubernetes or a cloud, with erdctl in the workers' environment and one thread each (dask worker
    --nthreads 1). Its workers read the logs themselves, from a shared disk or by URL; only
    documents come back. Work lost with a worker is done again.

    \b
    Examples:
      erdctl campaign run lab -o results.parquet --diagnose-above 0.05 \\
        --label '(?P<damper>D[0-9]+)/(?P<date>[0-9-]+)'
      erdctl campaign run lab -o dampers.parquet --label '(?P<damper>D[0-9]+)/' --group-by damper
      find lab -name '*.csv' | erdctl campaign run - -o results.parquet --steps inspect
      erdctl campaign run 's3://bench/2024-05/**/*.parquet' -o may.parquet --cluster tcp://hpc:8786
    """
    from erdctl.campaign.labels import pattern_of
    from erdctl.campaign.plan import StepOptions, plan, steps_of
    from erdctl.campaign.run import entries, run
    from erdctl.cli.in_force import IN_FORCE
    from erdctl.core.errors import CheckFailed, UsageProblem
    from erdctl.effects import candidates
    from erdctl.io.campaign_journal import journal
    from erdctl.io.campaign_out import write_table
    from erdctl.io.found_logs import find_logs
    from erdctl.report.text import counting, say

    if cluster is not None and jobs is not None:
        raise UsageProblem("--jobs is for this machine; how many a cluster does at a time it knows")
    if output == "-" and keep is None:
        raise UsageProblem("-o - needs --keep DIR, for the documents")
    wanted = steps_of(steps, diagnose_above)
    chosen, left = _names(only), _names(exclude)
    candidates(chosen, left)  # an unknown name is refused before anything is begun
    _refuse_wrong(maps, text, where, accept)
    asked = StepOptions(
        steps=wanted, diagnose_above=diagnose_above, maps=tuple(maps), text=tuple(text),
        where=tuple(where), accept=tuple(accept), effects=chosen, exclude=left, seed=seed,
    )  # fmt: skip
    pattern = None if label is None else pattern_of(label)
    groups = _names([group_by] if group_by else [])
    project = IN_FORCE.get()
    if groups and pattern is None and project is None:
        raise UsageProblem("--group-by takes labels: say with --label what a path says of its log")
    found = _without_table(find_logs(logs, report=say), output)
    planned = plan(found, asked, *_as_said(pattern, project, groups))
    folder = keep or _stem(output)
    with journal(folder) as kept:
        with (
            _crew(jobs, cluster, len(planned)) as crew,
            counting("campaign", len(planned)) as count,
        ):
            tally = _Tally(count, project)
            run(planned, kept, crew, tally.take)
        rows = write_table(entries(planned, kept), output, folder)
    say(
        f"{counted(len(planned), 'log')} or group{'s' * (len(planned) != 1)}: {tally.new} done now,"
        f" {tally.before} before; {counted(rows, 'row')} in {output}, documents in {folder}"
    )
    if pattern is not None and (silent := sum(1 for p in found if not pattern.search(p))):
        without = counted(silent, "path")
        say(f"without labels by --label, which does not match: {without}", "warning")
    if tally.bad:
        raise CheckFailed(f"{tally.bad} of {len(planned)} could not be done: see column 'error'")


def _as_said(
    pattern: Pattern[str] | None, project: InForce | None, groups: Sequence[str]
) -> tuple[Labelling, Sequence[str], Reading]:
    """What paths say of their logs, by --label or the project file, and how that has them read."""
    from dataclasses import replace

    from erdctl.campaign.labels import labels_of_path
    from erdctl.core.errors import ErdctlError, UsageProblem
    from erdctl.io.project.labels import Labels
    from erdctl.io.project.reading import ProjectReading

    def labelling(path: str) -> Labels | None:
        given = pattern and labels_of_path(path, pattern)
        if project is None:
            return given
        try:
            return replace(project.reading, given={path: given or Labels()}).labels(path)
        except ErdctlError as error:  # a date that is none is a row, not the end
            raise UsageProblem(str(error)) from None

    def reading(labels: Mapping[str, Labels]) -> ProjectReading | None:
        if project is None:
            return None
        return ProjectReading(project.project, given=labels)

    return labelling, groups, reading


MOST_SAID = 20  # errors of logs on stderr; the table has all


class _Tally:
    """Counts what comes, and says what went wrong as it does."""

    def __init__(self, count: Callable[[str], None], project: InForce | None) -> None:
        self.count, self.project = count, project
        self.new, self.before, self.bad = 0, 0, 0

    def take(self, entry: Entry, new: bool) -> None:
        from erdctl.report.text import say

        self.new += new
        self.before += not new
        if self.project is not None:
            for what in entry.by_project:
                if what.startswith(("columns ", "text ", "where ")):  # its labels are in the table
                    self.project.use(what)
        if entry.error is not None:
            self.bad += 1
            if self.bad <= MOST_SAID:
                named = any(path in entry.error for path in entry.logs)
                say(entry.error if named else f"{entry.log}: {entry.error}", "error")
            if self.bad == MOST_SAID:
                say("errors of further logs are in the table only", "error")
        self.count(entry.log)


@contextmanager
def _crew(jobs: int | None, address: str | None, most: int) -> Iterator[Crew]:
    from erdctl.campaign.run import Crew, here
    from erdctl.core.cluster import cluster_or_none
    from erdctl.core.workers import cores

    with cluster_or_none(address) as there:
        if there is None:
            yield here(min(jobs or cores(), most))
        else:
            yield Crew(there.executor, there.in_hand)


def _refuse_wrong(
    maps: Sequence[str], text: Sequence[str], where: Sequence[str], accept: Sequence[str]
) -> None:
    """Options that are wrong for every log are said once, before any of them is read."""
    from erdctl.bench.rig.fault import CODES
    from erdctl.core.errors import UsageProblem
    from erdctl.io.dampers import parse_where
    from erdctl.io.maps import parse_maps
    from erdctl.io.text.options import parse_text_options

    parse_maps(maps)
    parse_where(where)
    parse_text_options(text)
    unknown = [code for code in accept if code not in CODES]
    if unknown:
        raise UsageProblem(f"no rig check '{unknown[0]}'; there are {', '.join(CODES)}")


def _without_table(found: list[str], output: str) -> list[str]:
    """Logs without the table of an earlier run that lies among them and is written anew."""
    from os.path import abspath

    from erdctl.core.errors import UsageProblem
    from erdctl.io.campaign_out import is_table

    among = [path for path in found if abspath(path) == abspath(output)]
    if among and not is_table(output):
        raise UsageProblem(
            f"-o {output} would be written over a log that is read here; name another file"
        )
    return [path for path in found if path not in among]


def _names(options: Sequence[str]) -> tuple[str, ...]:
    return tuple(n.strip() for option in options for n in option.split(",") if n.strip())


def _stem(output: str) -> str:
    """Where documents go beside a table."""
    from os.path import splitext

    stem, suffix = splitext(output)
    return stem if suffix else f"{output}.d"

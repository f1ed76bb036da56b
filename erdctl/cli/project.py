"""Say once, in a file, what holds for all logs of a folder: erdctl.toml.

Every command uses the nearest erdctl.toml, in the folder in which it is run or above (up to your
home, or the root), or the one that --project FILE or ERDCTL_PROJECT names; --no-project, or an
empty ERDCTL_PROJECT, leaves it aside. What is given on the command line wins over what the file
says of a damper, that over what it says of a corner, and that over the rest: column by column, key
by key. One line on stderr says what it changed (not with --quiet), and provenance keeps it.

\b
What may stand in it:
  logs = ["raw/**/*.csv"]      which files [columns], [text] and [where] are for; all, if not given
  [columns]                    x = "Defl FL[mm]", as --map
  [text], [where]              as --text and --where
  [amplifier]                  duty_max, resolution, slew, update_rate, carrier, full_scale
  [rig]                        max_temperature, accept, strict
  [options]                    robust = true, of every command that has --robust
  [options.diagnose]           of one command
  [labels]                     path, date, columns, damper: how damper, corner, date and
                               conditions are read
  [corner.fl.columns]          of one corner (fl, fr, rl, rr): all tables above but [labels]
  [damper.A07.amplifier]       of one damper, likewise

A log that has none of the named columns, as all that erdctl writes, is read as it is. A limit of
[amplifier] or [rig] that the command line goes beyond is said. The schema: erdctl schema project.

\b
Examples:
  erdctl project init raw/A07_20240501_25C.csv
  erdctl project show raw/A07_20240501_25C.csv
  erdctl project show --json
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from erdctl.cli.options import Logs, Text

if TYPE_CHECKING:
    from erdctl.io.project.project import Project


def init(
    logs: Logs,
    output: Annotated[
        str,
        typer.Option("--output", "-o", metavar="FILE", help="Where to; - is stdout."),
    ] = "erdctl.toml",
    text: Text = [],
) -> None:
    """Write a project file from a sample of your logs.

    Columns and units are recognised as every command recognises them; what is not clear stands in
    the file as a comment, to be completed. So do the limits, and what the names of files seem to
    say.

    \b
    Examples:
      erdctl project init raw/A07_20240501_25C.csv
      erdctl project init car.parquet -o -
    """
    import os

    from erdctl.core.errors import UsageProblem
    from erdctl.io.atomic import output as written
    from erdctl.io.project.sample import project_text
    from erdctl.report.text import say

    if output != "-" and os.path.exists(output):
        raise UsageProblem(f"{output} is there already; remove it, or name another with -o")
    folder = os.path.dirname(os.path.abspath(output)) if output != "-" else os.getcwd()
    found = project_text(logs, folder, text=text, say=say)
    with written(output) as stream:
        stream.write(found.encode())


def show(
    context: typer.Context,
    shown: Annotated[
        list[str], typer.Argument(metavar="[LOG...]", help="Files: what holds for each.")
    ] = [],
    as_json: Annotated[bool, typer.Option("--json", help="As JSON on stdout.")] = False,
) -> None:
    """Print what applies here, and where in which file it is said.

    Of a LOG its damper, corner, date and conditions as well: by its path, and by its columns where
    the project names some. Nothing is read of a LOG otherwise.

    \b
    Examples:
      erdctl project show
      erdctl project show --corner fl
      erdctl project show raw/A07_20240501_25C.csv --json
    """
    from erdctl.cli.app import all_commands
    from erdctl.cli.in_force import asked, file_of
    from erdctl.cli.project_options import check
    from erdctl.io import documents
    from erdctl.io.project.file import read_project
    from erdctl.report.text import show as line

    path = file_of(context)
    project = None if path is None else read_project(path)
    if project is not None:
        check(project, all_commands)
    document = _document(project, shown, asked(context, "damper"), asked(context, "corner"))
    if as_json:
        documents.write(document, "-")
        return
    if project is None:
        line("no project file applies here; erdctl project init LOG writes one")
        return
    line(f"{document['file']}, SHA-256 {document['sha256']}")
    for one in document["logs"]:
        if one["log"] is not None:
            said = ", ".join(f"{k} {v}" for k, v in one["labels"].items()) or "nothing"
            line(f"{one['log']}: {said} by its name or columns")
        for value in one["values"]:
            text = documents.encode(value["value"]).decode().strip().replace("\n", "")
            line(f"  {value['name']} = {text}  ({value['key']}, line {value['line']})")


def _document(
    project: Project | None, logs: list[str], damper: str | None, corner: str | None
) -> dict[str, Any]:
    """What holds in general, or for each log."""
    from erdctl.io.project.labels import Labels
    from erdctl.io.project.project import chosen
    from erdctl.io.project.reading import read_labels
    from erdctl.io.project.shown import values_of

    if project is None:
        return {"file": None, "sha256": None, "logs": []}
    out = []
    files: list[str | None] = [*logs] or [None]
    for log in files:
        labels = Labels() if log is None else read_labels(project, log)
        labels = chosen(labels, damper, corner)
        out.append({
            "log": log, "labels": labels.texts(), "values": values_of(project, labels, log),
        })  # fmt: skip
    return {"file": project.name, "sha256": project.sha256, "logs": out}


COMMANDS = {"init": init, "show": show}

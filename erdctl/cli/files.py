"""Which options and arguments name files: said once, for all commands.

A command then never writes over what it reads, nor over what else it writes; a test goes over the
options of all commands and fails for a text that is in none of these sets.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from erdctl.core.errors import InputProblem
from erdctl.io.identity import STDIN, STDOUT, Named

READS = frozenset({"log", "logs", "params", "before", "geometry", "arguments", "source", "limits"})
WRITES = frozenset({"output", "report", "manifest", "plot"})
# Names a directory that is empty or of the same work, so that nothing is in it to write over.
FOLDERS = frozenset({"keep"})
# With this flag a document goes to standard output.
TO_STDOUT = "as_json"
MOST = 3  # files that a message names
# Texts that name no file.
OTHERS = frozenset({
    "maps", "fault", "drive", "kind", "record", "span", "normalise", "only", "exclude", "name",
    "concealment", "motion", "colour", "text", "where", "date", "damper", "operator", "new_name",
    "emulate", "project", "corner", "shown", "overlay", "cluster", "label", "group_by", "steps",
})  # fmt: skip


def names(parameters: list[Any], given: Mapping[str, Any]) -> list[Named]:
    """The files of a call, those that are read first.

    parameters : of the command, as the command line declares them;  given : their values by name
    """
    found = [n for p in parameters for n in _named(p, given.get(p.name))]
    return sorted(found, key=lambda n: not n.reads)


def placed(problem: InputProblem, names: Sequence[Named]) -> InputProblem:
    """The problem with the file that it is in, which a computation over several does not know."""
    read = list(dict.fromkeys("stdin" if n.path == STDIN else n.path for n in names if n.reads))
    if problem.file is not None or not read or any(name in str(problem) for name in read):
        return problem
    more = f" and {len(read) - MOST} more" if len(read) > MOST else ""
    return InputProblem(str(problem), file=", ".join(read[:MOST]) + more)


def _named(parameter: Any, value: Any) -> Iterator[Named]:
    if parameter.name == TO_STDOUT and value:
        yield Named(STDOUT, _label(parameter), reads=False)
    if parameter.name not in READS | WRITES or value is None:
        return
    for path in [value] if isinstance(value, str) else value:
        yield Named(
            _picture(path) if parameter.name == "plot" else path, _label(parameter),
            reads=parameter.name in READS,
        )  # fmt: skip


def _label(parameter: Any) -> str:
    """The option as people write it, or what the help text calls the argument."""
    if parameter.param_type_name == "option":
        return str(max(parameter.opts, key=len))
    word = str(parameter.metavar or "").strip("[].")
    return word if word.isalpha() else "the argument"


def _picture(plot: str) -> str:
    """The file of `[KIND:]FILE`."""
    from erdctl.report import pictures

    kind, _, path = plot.partition(":")
    return path if path and kind in pictures.names() else plot

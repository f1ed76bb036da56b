"""A table for papers and spreadsheets: CSV, Markdown or LaTeX, by suffix."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from pathlib import Path

from erdctl.core.errors import UsageProblem
from erdctl.io.atomic import output

Cell = str | float | int | None
SUFFIXES = (".csv", ".md", ".tex")
_LATEX = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "&": r"\&", "%": r"\%", "$": r"\$",
    "#": r"\#", "_": r"\_", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
}  # fmt: skip


def suffix_of(path: str) -> str:
    """The suffix of a table; raises UsageProblem for another."""
    found = Path(path).suffix.lower()
    if found not in SUFFIXES:
        raise UsageProblem(f"'{path}': a table is one of {', '.join(SUFFIXES)}, a document .json")
    return found


def write_table(path: str, header: Sequence[str], rows: Sequence[Sequence[Cell]]) -> None:
    """Write a table whole. In CSV numbers have all their digits, in the others four."""
    write = {".csv": as_csv, ".md": as_markdown, ".tex": as_latex}[suffix_of(path)]
    with output(path) as stream:
        stream.write(write(header, rows).encode(errors="backslashreplace"))


def as_csv(header: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    """As spreadsheets read it; an empty cell for none."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([["" if c is None else c for c in row] for row in rows])
    return out.getvalue()


def as_markdown(header: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    """A pipe table, with numbers at the right.

    >>> print(as_markdown(["damper", "g [m]"], [["a|b", 0.00123456]]), end="")
    | damper | g [m] |
    |---|---:|
    | a\\|b | 0.001235 |
    """
    lines = [[_plain(c).replace("|", "\\|") for c in row] for row in [header, *rows]]
    rule = ["---:" if number else "---" for number in _numeric(header, rows)]
    texts = [f"| {' | '.join(line)} |" for line in lines]
    return "\n".join([texts[0], f"|{'|'.join(rule)}|", *texts[1:]]) + "\n"


def as_latex(header: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    """A tabular with rules of the package booktabs.

    >>> print(as_latex(["damper"], [["50 %"]]), end="")
    \\begin{tabular}{l}
    \\toprule
    damper \\\\
    \\midrule
    50 \\% \\\\
    \\bottomrule
    \\end{tabular}
    """
    kinds = "".join("r" if number else "l" for number in _numeric(header, rows))
    lines = [" & ".join(_escaped(_plain(c)) for c in row) + r" \\" for row in [header, *rows]]
    return "\n".join(
        [rf"\begin{{tabular}}{{{kinds}}}", r"\toprule", lines[0], r"\midrule", *lines[1:],
         r"\bottomrule", r"\end{tabular}", ""]
    )  # fmt: skip


def _numeric(header: Sequence[str], rows: Sequence[Sequence[Cell]]) -> list[bool]:
    """Columns that hold numbers, and nothing else."""
    return [
        any(row[i] is not None for row in rows) and not any(isinstance(row[i], str) for row in rows)
        for i in range(len(header))
    ]


def _plain(cell: Cell) -> str:
    if cell is None:
        return ""
    text = f"{cell:.4g}" if isinstance(cell, float) else str(cell)
    return re.sub(r"\s+", " ", text)


def _escaped(text: str) -> str:
    return "".join(_LATEX.get(c, c) for c in text)

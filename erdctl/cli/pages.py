"""`--report FILE.html`: the option, a check before the work begins, and the file."""

from __future__ import annotations

from typing import Annotated

import typer

Report = Annotated[
    str | None,
    typer.Option(
        "--report",
        metavar="FILE.html",
        help="The result as one self-contained page, for people without erdctl.",
    ),
]


def check_report(path: str | None) -> None:
    """Refuse a name before the work, not after it."""
    from pathlib import Path

    from erdctl.core.errors import UsageProblem

    if path is None:
        return
    if not path.lower().endswith((".html", ".htm")):
        raise UsageProblem(f"--report writes a page: name a file that ends in .html, not '{path}'")
    folder = Path(path).absolute().parent
    if not folder.is_dir():
        raise UsageProblem(f"cannot write to '{path}': no directory {folder}")


def write_report(page: str, path: str) -> None:
    """Write a page whole."""
    from erdctl.io.atomic import output

    with output(path) as stream:
        # The command line in it may name files by bytes that are no text.
        stream.write(page.encode(errors="backslashreplace"))

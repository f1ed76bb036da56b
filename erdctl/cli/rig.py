"""The rig before the physics, as the commands ask for it and say it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from erdctl.bench.rig import Rig

Accept = Annotated[
    list[str],
    typer.Option(
        "--accept",
        metavar="CODE",
        help="Of a rig check whose finding is right as it is, e.g. speed_unit. May be repeated.",
    ),
]
Strict = Annotated[
    bool, typer.Option("--strict", help="Exit 1 if the rig checks find anything at all.")
]


def show(rig: Rig) -> None:
    """One line for each fault, on stderr."""
    from erdctl.report.text import say

    for line in rig.lines():
        say(line, "rig")


def fail(rig: Rig) -> None:
    """Exit 1 if anything was found; for `--strict`, when all is written."""
    from erdctl.core.errors import CheckFailed

    if rig.faults:
        codes = ", ".join(dict.fromkeys(f.code for f in rig.faults))
        raise CheckFailed(f"the rig checks found {codes}")

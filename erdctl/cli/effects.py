"""`erdctl effects`."""

from __future__ import annotations

from typing import Annotated

import typer

from erdctl.cli.options import effect_names


def command(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]", help="An effect; without it, the list.", autocompletion=effect_names
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON on stdout.")] = False,
) -> None:
    """Print the catalogue of physical effects: equation, parameters, source.

    \b
    Examples:
      erdctl effects
      erdctl effects coulomb_friction
    """
    from erdctl.effects import candidates
    from erdctl.io import documents
    from erdctl.io.catalogue import facts_of
    from erdctl.report.text import show

    chosen = candidates(() if name is None else (name,))
    if as_json:
        documents.write([facts_of(e) for e in chosen], "-")
    elif name is None:
        width = max(len(e.name) for e in chosen)
        for e in chosen:
            show(f"{e.name.ljust(width)}  {e.stage.value:9} {e.title}")
    else:
        facts = facts_of(chosen[0])
        for key, value in facts.items():
            if key != "parameters":
                show(f"{key:10} {value}")
        for p in facts["parameters"]:
            show(f"{'parameter':10} {p['symbol']} [{p['unit']}] {p['title']},"
                 f" {p['low']:g} to {p['high']:g}, off at {p['off']:g}")  # fmt: skip

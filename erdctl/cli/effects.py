"""`erdctl effects`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from erdctl.model.effect import Effect


def command(
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="An effect; without it, the list.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON on stdout.")] = False,
) -> None:
    """Print the catalogue of physical effects: equation, parameters, source.

    \b
    Examples:
      erdctl effects
      erdctl effects coulomb_friction
    """
    from erdctl.core.errors import InputProblem, UsageProblem
    from erdctl.effects import catalogue, get
    from erdctl.io import documents

    try:
        chosen = catalogue() if name is None else (get(name),)
    except InputProblem as problem:
        raise UsageProblem(str(problem)) from None
    if as_json:
        documents.write([_facts(e) for e in chosen], "-")
    elif name is None:
        width = max(len(e.name) for e in chosen)
        for e in chosen:
            print(f"{e.name.ljust(width)}  {e.stage.value:9} {e.title}")
    else:
        facts = _facts(chosen[0])
        for key, value in facts.items():
            if key != "parameters":
                print(f"{key:10} {value}")
        for p in facts["parameters"]:
            print(f"{'parameter':10} {p['symbol']} [{p['unit']}] {p['title']},"
                  f" {p['low']:g} to {p['high']:g}, off at {p['off']:g}")  # fmt: skip


def _facts(effect: Effect) -> dict[str, Any]:
    return {
        "name": effect.name,
        "title": effect.title,
        "stage": effect.stage.value,
        "equation": effect.equation,
        "source": effect.source,
        "validity": effect.validity,
        "needs": "; ".join(r.value for r in effect.requires),
        "shows": effect.shows.value,
        "equivalent": ", ".join(effect.equivalents),
        "parameters": [
            {
                "symbol": q.symbol,
                "unit": q.unit,
                "title": q.title,
                "low": q.low,
                "high": q.high,
                "off": q.off,
            }
            for q in effect.quantities
        ],
    }

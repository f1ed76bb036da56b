"""`erdctl effects`."""

from __future__ import annotations

from typing import Annotated

import typer

from erdctl.cli.options import effect_names


def command(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]",
            help="An effect; without it, the list. Or the word new, to write one.",
            autocompletion=effect_names,
        ),
    ] = None,
    new_name: Annotated[
        str | None, typer.Argument(metavar="[NEW]", help="After new: the name of the effect.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON on stdout.")] = False,
    source: Annotated[
        str | None,
        typer.Option(
            "--from",
            metavar="FILE",
            help="With new: a diagnosis, or parameters, with a learned law.",
        ),
    ] = None,
    law: Annotated[
        int | None,
        typer.Option("--law", metavar="N", min=1, help="With new: which law, where several are."),
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.py",
            help="With new: the effect's file, not NEW.py here.",
        ),
    ] = None,
) -> None:
    """Print the catalogue of physical effects: equation, parameters, source.

    `effects new` writes a law that `diagnose` has learned as the file of an effect, and a test
    beside it (test_NEW.py): equation, parameters with bounds, starts and off values; what it is
    and where it is published is left to you. A package takes the file as it is, by the lines for
    its pyproject.toml that are printed. From then on `diagnose` names it.

    \b
    Examples:
      erdctl effects
      erdctl effects coulomb_friction
      erdctl effects new bore_wear --from learned.json -o bore_wear.py
    """
    if name == "new":
        _new(new_name, source, law, output, as_json=as_json)
        return
    from erdctl.core.errors import UsageProblem
    from erdctl.effects import candidates
    from erdctl.io import documents
    from erdctl.io.catalogue import facts_of
    from erdctl.report.text import show

    if new_name is not None or source or law or output:
        raise UsageProblem("--from, --law and -o go with: erdctl effects new NAME --from FILE")
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


def _new(
    name: str | None, source: str | None, law: int | None, output: str | None, *, as_json: bool
) -> None:
    """Write the file of an effect, and its test beside it."""
    import hashlib
    from pathlib import Path

    from erdctl.core.errors import UsageProblem
    from erdctl.core.messages import tell
    from erdctl.effects import names
    from erdctl.io.atomic import output as written
    from erdctl.io.documents import read_bytes
    from erdctl.io.effect_file import (
        check_name,
        effect_source,
        learned_effect,
        parameters_of,
    )
    from erdctl.io.effect_test_file import test_source

    if name is None or source is None or as_json:
        raise UsageProblem("write it as: erdctl effects new NAME --from diagnosis.json -o FILE.py")
    check_name(name, names())
    path = Path(output or f"{name}.py")
    if path.suffix != ".py" or path.stem != name:
        raise UsageProblem(f"{path}: the file of an effect has its name, {name}.py")
    beside = path.with_name(f"test_{path.name}")
    for file in (path, beside):
        if file.exists():
            raise UsageProblem(f"{file} is there already; remove it, or choose another name")
    data = read_bytes(source)
    parameters = parameters_of(data, source)
    found = learned_effect(parameters, law, source)
    origin = f"{Path(source).name} (sha256 {hashlib.sha256(data).hexdigest()[:12]})"
    texts = {
        path: effect_source(name, found, parameters.values, origin),
        beside: test_source(name, found, parameters),
    }
    for file, text in texts.items():
        with written(str(file)) as stream:
            stream.write(text.encode())
    tell(f"wrote {path} and {beside}: {found.title}")
    tell("a package declares it in its pyproject.toml:")
    tell('  [project.entry-points."erdctl.effects"]')
    tell(f'  {name} = "{name}:EFFECT"')

"""`erdctl schema`."""

from __future__ import annotations

from typing import Annotated

import typer


def command(
    name: Annotated[str, typer.Argument(metavar="NAME", help="parameters or geometry.")],
) -> None:
    """Print the JSON Schema of a document that erdctl reads or writes.

    \b
    Example:
      erdctl schema parameters
    """
    from erdctl.errors import UsageProblem
    from erdctl.io import documents, geometry, parameters

    schemas = {"parameters": parameters.json_schema, "geometry": geometry.json_schema}
    if name not in schemas:
        raise UsageProblem(f"there are schemas of {', '.join(schemas)}, not of '{name}'")
    documents.write(schemas[name](), "-")

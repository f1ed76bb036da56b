"""`erdctl schema`."""

from __future__ import annotations

from typing import Annotated

import typer

from erdctl.cli.options import schema_names


def command(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME",
            autocompletion=schema_names,
            help="parameters, geometry, inspection, validation, diagnosis, pwm, project,"
            " comparison, proof or proof-on.",
        ),
    ],
) -> None:
    """Print the JSON Schema of a document that erdctl reads or writes.

    parameters and geometry files; inspection (inspect --json), validation (validate --json),
    diagnosis (diagnose), pwm (the manifest that mimic writes), project (erdctl.toml), comparison
    (compare), proof (prove) and proof-on (prove --on).

    \b
    Examples:
      erdctl schema parameters
      erdctl schema diagnosis
    """
    from erdctl.core.errors import UsageProblem
    from erdctl.io import documents
    from erdctl.io.shapes import SCHEMAS
    from erdctl.prove import document, on_log_document

    schemas = {
        **SCHEMAS, "proof": document.json_schema, "proof-on": on_log_document.json_schema,
    }  # fmt: skip
    if name not in schemas:
        raise UsageProblem(f"there are schemas of {', '.join(schemas)}, not of '{name}'")
    documents.write(schemas[name](), "-")

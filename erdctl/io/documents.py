"""JSON documents: read with the path of whatever is wrong, written whole, with their schema."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.atomic import output

T = TypeVar("T", bound=msgspec.Struct)


def read_bytes(path: str) -> bytes:
    """All of a file, or of stdin for `-`."""
    if path == "-":
        return sys.stdin.buffer.read()
    try:
        return Path(path).read_bytes()
    except FileNotFoundError:
        raise UsageProblem(f"{path}: no such file") from None
    except OSError as error:
        raise UsageProblem(f"{path}: {error.strerror or error}") from None


def decode(data: bytes, kind: type[T], *, name: str, schema: str) -> T:
    """A document of the given kind.

    name : for messages;  schema : what its field "schema" must say
    Raises InputProblem with the path of the field that is missing or wrong.
    """
    if not data.strip():
        raise InputProblem("empty; expected a JSON document", file=name)
    try:
        raw = msgspec.json.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise InputProblem(f"not a JSON document: {error}", file=name) from None
    found = raw.get("schema") if isinstance(raw, dict) else None
    if found != schema:
        says = f"it says {found!r}" if found is not None else 'it has no field "schema"'
        raise InputProblem(f'expected a document of schema "{schema}", but {says}', file=name)
    try:
        return msgspec.convert(raw, kind)
    except msgspec.ValidationError as error:
        raise InputProblem(str(error), file=name) from None


def encode(document: object) -> bytes:
    """A document as indented JSON with a final newline."""
    return msgspec.json.format(msgspec.json.encode(document), indent=2) + b"\n"


def plain(document: object) -> Any:
    """A document as whoever reads its JSON gets it: dicts, lists, numbers, texts and None."""
    return msgspec.json.decode(msgspec.json.encode(document))


def write(document: object, path: str) -> None:
    """Write a document whole to a file, or to stdout for `-`."""
    with output(path) as stream:
        stream.write(encode(document))

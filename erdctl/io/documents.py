"""JSON documents: read with the path of whatever is wrong, written whole, with their schema."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.messages import as_text
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
    Raises InputProblem with the path of the field that is missing or wrong, or is there twice.
    """
    raw = parsed(data, name)
    found = raw.get("schema") if isinstance(raw, dict) else None
    if found != schema:
        says = f"it says {str(found)[:80]!r}" if found is not None else 'it has no field "schema"'
        raise InputProblem(f'expected a document of schema "{schema}", but {says}', file=name)
    return converted(raw, kind, name=name)


def converted(raw: object, kind: type[T], *, name: str, path: str = "") -> T:
    """What JSON holds as an object of the given kind.

    path : of `raw` within its document, like `.provenance`
    Raises InputProblem with the path of the field that is missing or wrong.
    """
    try:
        return msgspec.convert(raw, kind)
    except msgspec.ValidationError as error:
        message = str(error).replace("`$", f"`${path}")
        if path and "`$" not in message:
            message = f"{message} - at `${path}`"
        raise InputProblem(message, file=name) from None


def parsed(data: bytes, name: str) -> Any:
    """What a JSON document holds; InputProblem for one that is none."""
    if not data.strip():
        raise InputProblem("empty; expected a JSON document", file=name)
    try:
        raw = msgspec.json.decode(data)
        # msgspec takes the last of two fields of one name, and says nothing.
        json.loads(data, object_pairs_hook=_without_repeats)
    except RecursionError:
        raise InputProblem(
            "not a document of erdctl: brackets within brackets, hundreds deep", file=name
        ) from None
    except _Repeated as error:
        raise InputProblem(
            f"the field {error} is there twice in one object; keep one of the two", file=name
        ) from None
    except ValueError as error:  # of either parser, and of the encoding
        raise InputProblem(f"not a JSON document: {error}", file=name) from None
    return raw


class _Repeated(Exception):
    """Names a field that is in one object twice."""


def _without_repeats(pairs: list[tuple[str, Any]]) -> None:
    seen: set[str] = set()
    for key, _ in pairs:
        if key in seen:
            raise _Repeated(json.dumps(key[:80], ensure_ascii=False))
        seen.add(key)


def encode(document: object) -> bytes:
    """A document as indented JSON with a final newline.

    Bytes of a file's name that are no text, which JSON cannot hold, are written as `\\udcff`.
    """
    try:
        packed = msgspec.json.encode(document)
    except UnicodeEncodeError:
        packed = msgspec.json.encode(_all_text(msgspec.to_builtins(document)))
    return msgspec.json.format(packed, indent=2) + b"\n"


def _all_text(value: Any) -> Any:
    if isinstance(value, str):
        return as_text(value)
    if isinstance(value, dict):
        return {_all_text(k): _all_text(v) for k, v in value.items()}
    return [_all_text(v) for v in value] if isinstance(value, list) else value


def plain(document: object) -> Any:
    """A document as whoever reads its JSON gets it: dicts, lists, numbers, texts and None."""
    return msgspec.json.decode(msgspec.json.encode(document))


def write(document: object, path: str) -> None:
    """Write a document whole to a file, or to stdout for `-`."""
    with output(path) as stream:
        stream.write(encode(document))

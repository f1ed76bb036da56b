"""What functions take for the parameters of a damper."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from erdctl.io import documents
from erdctl.io.parameters import parse_parameters, to_document
from erdctl.model.parameters import Parameters


class HoldsParameters(Protocol):
    """A result with parameters: of `identify`, or of `diagnose` (those of the corrected model)."""

    @property
    def parameters(self) -> Parameters: ...


ParametersLike: TypeAlias = HoldsParameters | Mapping[str, Any] | str | os.PathLike[str]


@dataclass(frozen=True)
class Given:
    """Parameters as a command would read them; sha256 : of the bytes of their file."""

    parameters: Parameters
    name: str
    sha256: str


def given_parameters(given: ParametersLike) -> Given:
    """The parameters out of a result, a parameter document, or the path of a parameter file.

    What is in memory goes through the bytes of its file, so that a call and a command that reads
    that file cannot differ, and both state the same hash.
    Raises InputProblem for what is no parameter file, UsageProblem for no such file, TypeError.
    """
    if isinstance(given, str | os.PathLike):
        name = os.fspath(given)
        data = documents.read_bytes(name)
    elif isinstance(given, Mapping):
        name, data = "parameters", documents.encode(dict(given))
    else:
        found = getattr(given, "parameters", None)
        if not isinstance(found, Parameters):
            raise TypeError(
                "parameters are a result of identify or diagnose, the path of a parameter file or"
                f" its dict, not {type(given).__name__}"
            )
        name, data = "parameters", documents.encode(to_document(found))
    return Given(parse_parameters(data, name), name, hashlib.sha256(data).hexdigest())

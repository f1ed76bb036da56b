"""Libraries that only some users need, asked for by name where they are missing."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from erdctl.core.errors import ComputationProblem


class MissingLibrary(ComputationProblem):
    """An optional library is not installed; the message says how to install it."""


def need(module: str, *, extra: str, purpose: str) -> Any:
    """The module of an optional library.

    extra : the optional dependency of erdctl that brings it;  purpose : what it is needed for
    Raises MissingLibrary, which says what to install.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module.partition(".")[0]:
            raise  # the library is there, but broken
        raise _missing(module, extra, purpose) from None


def present(module: str, *, extra: str, purpose: str) -> None:
    """Raise MissingLibrary if an optional library is not installed; it is not imported."""
    if find_spec(module) is None:
        raise _missing(module, extra, purpose)


def _missing(module: str, extra: str, purpose: str) -> MissingLibrary:
    name = module.partition(".")[0]
    return MissingLibrary(f"{purpose} need the library {name}: pip install 'erdctl[{extra}]'")

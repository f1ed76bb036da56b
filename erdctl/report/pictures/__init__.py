"""The kinds of pictures: one file each, found by its file name; `PICTURE` in it declares it.

A kind is called like its file, with hyphens. Names are found without importing anything heavy.
"""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

from erdctl.core.errors import UsageProblem

if TYPE_CHECKING:
    from erdctl.report.kind import Picture


def names() -> tuple[str, ...]:
    """The names of all kinds."""
    return tuple(sorted(m.name.replace("_", "-") for m in iter_modules(__path__)))


def get(name: str) -> Picture:
    """The kind of that name; raises UsageProblem, with the names there are, for others."""
    if name not in names():
        raise UsageProblem(f"unknown picture '{name}'; known are {', '.join(names())}")
    found: Picture = import_module(f"{__name__}.{name.replace('-', '_')}").PICTURE
    return found

"""The catalogue of physical effects: one file each, found by its file name.

A file `erdctl/effects/NAME.py` holds a docstring, one pure function and `EFFECT`. Other packages
add effects through the entry-point group `erdctl.effects`: the effect's name, and its object.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules

from erdctl.core.errors import EffectFailed, ErdctlError, InputProblem, UsageProblem
from erdctl.core.messages import shown
from erdctl.model.effect import Effect

GROUP = "erdctl.effects"


@cache
def names() -> tuple[str, ...]:
    """Names of all effects, the package's own first."""
    from importlib.metadata import entry_points

    own = sorted(m.name for m in iter_modules(__path__))
    others = sorted(e.name for e in entry_points(group=GROUP))
    return tuple(dict.fromkeys([*own, *others]))


@cache
def get(name: str) -> Effect:
    """The effect of that name; only its own file is imported.

    Raises InputProblem, with the names there are, if the catalogue has none of that name, and
    EffectFailed if its file cannot be used.
    """
    # `__init__` would be found, too, and is this file.
    own = name.isidentifier() and name.isascii() and not name.startswith("_")
    if own and find_spec(f"{__name__}.{name}") is not None:
        return _loaded(name, f"{__name__}.{name}", "EFFECT")
    from importlib.metadata import entry_points

    for entry in entry_points(group=GROUP, name=name):
        return _loaded(name, entry.module, entry.attr)
    raise InputProblem(f"unknown effect '{shown(name, 80)}'; known are {', '.join(names())}")


def catalogue() -> tuple[Effect, ...]:
    """Every effect."""
    return tuple(get(name) for name in names())


def _loaded(name: str, module: str, attribute: str) -> Effect:
    """The effect that a module declares; says the file, whatever is wrong with it."""
    spec = find_spec(module)
    file = (spec.origin if spec is not None else None) or module
    try:
        found: object = getattr(import_module(module), attribute)
    except (ErdctlError, MemoryError):
        raise
    except Exception as error:  # an effect may come from anywhere, and fail in any way
        raise EffectFailed(file, f"{type(error).__name__}: {error}") from error
    if not isinstance(found, Effect):
        raise EffectFailed(file, f"{attribute} is {type(found).__name__}, expected an Effect")
    if found.name != name:
        raise EffectFailed(file, f"{attribute} is called '{found.name}', expected '{name}'")
    return found


def candidates(only: Iterable[str] = (), exclude: Iterable[str] = ()) -> tuple[Effect, ...]:
    """The effects that a user wants tested: `only` these, or else all, less `exclude`.

    Raises UsageProblem, with the names there are, for one that the catalogue has not.
    """
    try:
        barred = {get(name).name for name in exclude}
        chosen = tuple(get(name) for name in only) or catalogue()
    except InputProblem as problem:
        raise UsageProblem(str(problem)) from None
    return tuple(e for e in chosen if e.name not in barred)

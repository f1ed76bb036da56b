"""What a function of an effect returns, checked where it is used: the shape, and that it is finite.

Each raises EffectFailed with the function's file and line, what came back and what was expected.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from erdctl.core.errors import EffectFailed, ErdctlError
from erdctl.core.recording import Array
from erdctl.core.signals import Signals

Groups = Mapping[str, Array]

GROUPS = ("gas", "viscous", "yield")


def called(function: Callable[..., Any], *arguments: Any) -> Any:
    """What a function returns; whatever it raises becomes EffectFailed."""
    try:
        return function(*arguments)
    except (ErdctlError, MemoryError):
        raise
    except Exception as error:  # an effect may come from anywhere, and fail in any way
        raise EffectFailed(function, f"{type(error).__name__}: {error}") from error


def samples(function: Callable[..., Any], out: Any, s: Signals, what: str = "") -> Array:
    """(n,) finite values; what : of which they are, for the message."""
    if not isinstance(out, np.ndarray) or out.shape != (len(s),):
        of = f" for {what}" if what else ""
        raise EffectFailed(function, f"returned {in_words(out)}{of}, expected {len(s)} samples")
    return finite(function, out)


def groups(function: Callable[..., Any], out: Any, s: Signals) -> Groups:
    """(n,) factors of some groups."""
    if not isinstance(out, Mapping) or not set(out) <= set(GROUPS):
        raise EffectFailed(
            function, f"returned {in_words(out)}, expected factors of some of {', '.join(GROUPS)}"
        )
    for group, factor in out.items():
        samples(function, factor, s, f"group {group}")
    return out


def number(function: Callable[..., Any], out: Any) -> float:
    """A finite number."""
    if isinstance(out, (int, float, np.integer, np.floating)) and np.isfinite(out):
        return float(out)
    raise EffectFailed(function, f"gave {in_words(out)}, expected a finite number")


def finite(function: Callable[..., Any], out: Array) -> Array:
    """Finite numbers of 64 bits."""
    if out.dtype != np.float64 or not np.isfinite(out).all():
        raise EffectFailed(
            function,
            f"returned {out.dtype} values that are not all finite numbers of 64 bits",
        )
    return out


def in_words(out: object) -> str:
    """What came back, in words."""
    if isinstance(out, np.ndarray):
        return f"an array of shape {out.shape}"
    return f"{type(out).__name__} {out!r}"[:80]


def added_forces(
    function: Callable[..., Any], rows: int, s: Signals, p: Mapping[str, float]
) -> Array:
    """(k, n) forces at unit amplitudes, as many as the effect has linear parameters."""
    out = called(function, s, p)
    if not isinstance(out, np.ndarray) or out.shape != (rows, len(s)):
        raise EffectFailed(
            function,
            f"returned {in_words(out)}, expected {rows} x {len(s)} forces: a row for each linear"
            " parameter, a column for each sample",
        )
    return finite(function, out)


def checked_starts(
    function: Callable[..., Any], symbols: Sequence[str], s: Signals, rest: Array
) -> list[dict[str, float]]:
    """Starts of a search as plain numbers, one for each of some symbols."""
    out = []
    for start in called(function, s, rest):
        if not isinstance(start, Mapping) or set(start) != set(symbols):
            raise EffectFailed(
                function,
                f"gave the start {in_words(start)}, expected a number for each of {symbols}",
            )
        out.append({symbol: number(function, start[symbol]) for symbol in symbols})
    if not out:
        raise EffectFailed(function, "gave no start of a search")
    return out


def checked_most(
    function: Callable[..., Any], symbols: Sequence[str], s: Signals, force: Array
) -> dict[str, float]:
    """Largest values as plain numbers, of some of some symbols."""
    out = called(function, s, force)
    if not isinstance(out, Mapping) or not set(out) <= set(symbols):
        raise EffectFailed(
            function, f"returned {in_words(out)}, expected numbers for some of {symbols}"
        )
    return {symbol: number(function, value) for symbol, value in out.items()}

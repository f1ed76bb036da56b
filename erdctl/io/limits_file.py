"""Tolerance bands as a file: TOML or JSON, a parameter or a score with its low and high end."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from difflib import get_close_matches
from math import inf, isfinite

import msgspec

from erdctl.compare.tolerance import Band, Rule
from erdctl.core.errors import InputProblem
from erdctl.core.quantity import Quantity
from erdctl.core.recording import DIRECTIONS
from erdctl.effects import catalogue
from erdctl.io import documents
from erdctl.io.campaign_in import SCORES
from erdctl.io.units import factor_between
from erdctl.model.paper import QUANTITIES

END = float | str
_SIZED = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*")


class BandIn(msgspec.Struct, forbid_unknown_fields=True):
    """Ends of a band: a number in SI, or one with its unit as text, "0.5 mm"."""

    low: float | str | None = None
    high: float | str | None = None


def read_limits(path: str) -> list[Rule]:
    """The bands of a file, one rule for each parameter that is meant.

    `c_vis` is meant in both directions, `compression.c_vis` in one.
    Raises InputProblem for a name that nothing has, and for a band that holds nothing.
    """
    data = documents.read_bytes(path)
    raw = _tables(data, path)
    known = _known()
    out: dict[str, Rule] = {}
    for name, given in raw.items():
        band = documents.converted(given, BandIn, name=path, path=f".{name}")
        for full in _meant(name, known, path):
            unit, quantity = known[full]
            ends = (_end(band.low, unit, name, path), _end(band.high, unit, name, path))
            low, high = -inf if ends[0] is None else ends[0], inf if ends[1] is None else ends[1]
            if not low < high or (ends[0] is None and ends[1] is None):
                raise InputProblem(
                    f"{name}: expected low, high or both, with low below high", file=path
                )
            own = Band(low=low, high=high)
            out[full] = Rule(name=full, unit=unit, band=own)
            if quantity is not None:
                bounds = quantity.low, quantity.high
                out[full] = replace(out[full], off=quantity.off, bounds=bounds)
    if not out:
        raise InputProblem(
            'no band in it; write for instance: "backlash.g" = { high = "0.5 mm" }', file=path
        )
    return list(out.values())


def _tables(data: bytes, path: str) -> dict[str, object]:
    import tomllib

    if data.lstrip()[:1] == b"{":
        raw = documents.parsed(data, path)
    else:
        try:
            raw = tomllib.loads(data.decode())
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise InputProblem(f"not a TOML file, nor JSON: {error}", file=path) from None
    if not isinstance(raw, dict):
        raise InputProblem("expected a table of bands by name", file=path)
    return dict(_flat(raw))


def _flat(raw: dict[str, object], head: str = "") -> Iterator[tuple[str, object]]:
    """TOML makes a table in a table of [compression.c_vis]; names then go together again."""
    for name, given in raw.items():
        full = f"{head}.{name}" if head else name
        inner = given.values() if isinstance(given, dict) else ()
        if isinstance(given, dict) and given and all(isinstance(v, dict) for v in inner):
            yield from _flat(given, full)
        else:
            yield full, given


def _known() -> dict[str, tuple[str, Quantity | None]]:
    """Unit of everything that may have a band, and the parameter where it is an effect's."""
    out: dict[str, tuple[str, Quantity | None]] = {s: (unit, None) for s, unit in SCORES.items()}
    for d in DIRECTIONS:
        out |= {f"{d}.{s}": (q.unit, None) for s, q in QUANTITIES.items()}
    effects: Iterable[tuple[str, Quantity]] = (
        (e.key(q.symbol), q) for e in catalogue() for q in e.quantities
    )
    return out | {name: (q.unit, q) for name, q in effects}


def _meant(name: str, known: dict[str, tuple[str, Quantity | None]], path: str) -> list[str]:
    if name in known:
        return [name]
    both = [f"{d}.{name}" for d in DIRECTIONS if f"{d}.{name}" in known]
    if both:
        return both
    near = get_close_matches(name, [*known, *QUANTITIES], 3)
    hint = f"; did you mean {', '.join(near)}" if near else ""
    raise InputProblem(f"nothing is called '{name[:80]}'{hint}", file=path)


def _end(given: float | str | None, unit: str, name: str, path: str) -> float | None:
    """One end in SI."""
    if given is None or not isinstance(given, str):
        number, factor = given, 1.0
    else:
        found = _SIZED.fullmatch(given)
        if found is None:
            raise InputProblem(
                f"{name}: expected a number with its unit, not '{given[:40]}'", file=path
            )
        factor = 1.0
        if found[2]:
            factor = factor_between(found[2], unit, f"{path}: {name}")
        try:
            number = float(found[1])
        except ValueError:
            raise InputProblem(f"{name}: '{given[:40]}' is no number", file=path) from None
    if number is None:
        return None
    if not isfinite(number):
        raise InputProblem(f"{name}: expected a finite number", file=path)
    return number * factor

"""A car's log: columns of several dampers beside one another, told apart by fl, fr, rl, rr."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from erdctl.io.project.shape import CORNERS
from erdctl.io.sources import TableSource

_TOKEN = re.compile(r"(?<![A-Za-z0-9])(fl|fr|rl|rr)(?![A-Za-z0-9])", re.IGNORECASE)
_EDGES = re.compile(r"^[\s_.\-:]+|[\s_.\-:]+$")


@dataclass(frozen=True)
class CarCorner:
    """One corner of a log.

    own : its columns -> what they would be called without the corner;  others : of other corners
    """

    name: str
    own: dict[str, str]
    others: frozenset[str]

    def view(self, source: TableSource) -> TableSource:
        """The log as if it held this corner alone, under names without it."""
        kept = [c for c in source.columns if c not in self.others]
        units = {self.own.get(c, c): u for c, u in source.units.items() if c not in self.others}
        return replace(source, columns=tuple(self.own.get(c, c) for c in kept), units=units)

    def own_name(self, seen: str) -> str:
        """What a column of the view is called in the log."""
        return next((column for column, bare in self.own.items() if bare == seen), seen)


def corners_of(columns: Sequence[str]) -> list[CarCorner]:
    """The corners that names of columns tell; none where their names would be the same as others.

    Check: of F_fl, F_fr and t there are two corners, of which t is in neither.
    >>> [(c.name, c.own) for c in corners_of(["t", "F_fl", "F_fr"])]
    [('fl', {'F_fl': 'F'}), ('fr', {'F_fr': 'F'})]
    """
    found: dict[str, dict[str, str]] = {}
    for column in columns:
        token = _TOKEN.findall(column.replace("_", " "))
        if len(token) == 1:
            plain = _TOKEN.sub("", column.replace("_", " "), count=1)
            bare = " ".join(_EDGES.sub("", plain).split())
            found.setdefault(token[0].casefold(), {})[column] = bare or column
    everything = {c for own in found.values() for c in own}
    shared = [c for c in columns if c not in everything]
    if any(len({*own.values(), *shared}) < len(own) + len(shared) for own in found.values()):
        return []
    return [
        CarCorner(name, found[name], frozenset(everything - set(found[name])))
        for name in CORNERS if name in found
    ]  # fmt: skip

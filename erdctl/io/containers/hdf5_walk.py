"""What is in an HDF5 file, without leaving it and without going in circles."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from erdctl.core.memory import check_claim

_DEEPEST = 30
_MOST = 100_000  # groups and datasets


@dataclass(frozen=True, eq=False)
class Hdf5Group:
    """A group: path with a stroke at its end, the datasets in it by name, its attributes."""

    path: str
    datasets: tuple[tuple[str, Any], ...]
    attributes: dict[str, Any]

    @property
    def title(self) -> str:
        return self.path.rstrip("/").rpartition("/")[2] or "file"

    @property
    def around(self) -> str:
        return self.path.rstrip("/").rpartition("/")[0] + "/"


def walked(file: Any) -> tuple[list[Hdf5Group], list[str]]:
    """The groups of an open file, and remarks on what was not followed."""
    notes: list[str] = []
    out: list[Hdf5Group] = []
    _into(file["/"], "/", out, notes, set(), 0)
    return out, notes


def check_sizes(file: Any, size: int, name: str) -> None:
    """Raise InputProblem if all datasets of an open file, references followed, are more than
    memory holds or a log can have; size : bytes of the file."""
    found, _ = walked(file)
    total = sum(d.size * max(d.dtype.itemsize, 8) for f in found for _, d in f.datasets)
    check_claim(total, size, name, "its variables")


def attributes(item: Any) -> dict[str, Any]:
    """The attributes of a group or a dataset that can be read."""
    out: dict[str, Any] = {}
    for key in item.attrs:
        try:
            out[key] = item.attrs[key]
        except (OSError, TypeError, ValueError, RuntimeError):
            continue  # of a type that is not known: no unit, and no name of a column
    return out


def attribute(about: dict[str, Any], kinds: Sequence[str]) -> Any:
    """The first attribute called like one of `kinds`, else in any case of letters."""
    low = {k.casefold(): v for k, v in about.items()} | about
    return next((low[n] for k in kinds for n in (k, k.casefold()) if n in low), None)


def _in_order(group: Any) -> list[str]:
    """The names in a group as they were made, where the file keeps that; else `run_2` before
    `run_10`, as whoever counted them meant."""
    import h5py

    names = list(group)
    kept = group.id.get_create_plist().get_link_creation_order() & h5py.h5p.CRT_ORDER_TRACKED
    return names if kept else sorted(names, key=_counted)


def _counted(name: str) -> list[tuple[int, int, str]]:
    """A key by which whole numbers in names stand by their size."""
    parts = re.split(r"([0-9]+)", name)  # every second one is a number
    return [(0, int(p), "") if i % 2 else (1, 0, p) for i, p in enumerate(parts) if p]


def _into(
    group: Any, path: str, out: list[Hdf5Group], notes: list[str], seen: set[Any], depth: int
) -> None:
    import h5py

    place = h5py.h5o.get_info(group.id)
    if (place.fileno, place.addr) in seen or depth > _DEEPEST or len(seen) > _MOST:
        notes.append(f"'{path}' comes again inside of itself, or is too deep; not followed")
        return
    seen.add((place.fileno, place.addr))
    datasets, inside = [], []
    at = len(out)
    for key in _in_order(group):
        link = group.get(key, getlink=True)
        if not isinstance(link, h5py.HardLink):
            kind = "another file" if isinstance(link, h5py.ExternalLink) else "another place"
            notes.append(f"'{path}{key}' is a link to {kind}, left out")
            continue
        item = group[key]
        if isinstance(item, h5py.Group):
            inside.append((key, item))
        elif isinstance(item, h5py.Dataset) and item.shape:
            if item.is_virtual or item.external:
                notes.append(f"'{path}{key}' keeps its samples in other files, left out")
                continue
            datasets.append((key, item))
    for key, item in inside:
        _into(item, f"{path}{key}/", out, notes, seen, depth + 1)
    out.insert(at, Hdf5Group(path, tuple(datasets), attributes(group)))

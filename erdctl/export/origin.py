"""Where exported numbers come from, in lines that every file can hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from erdctl.core.messages import CELL, LONGEST, shown
from erdctl.core.version import __version__
from erdctl.model.parameters import Parameters

UNITS = {"x": "m", "xdot": "m/s", "duty": "1"}


@dataclass(frozen=True, kw_only=True)
class Origin:
    """A parameter file, as given.

    name : of the file, "stdin" for `-`;  sha256 : of its bytes
    """

    name: str
    sha256: str


def plain(text: str, most: int = CELL) -> str:
    r"""One line of ASCII: what stands in a file's name must not end a comment of another.

    Check: a line break becomes \n, and a letter with two dots the number of it.
    >>> plain("a\nö")
    'a\\n\\xf6'
    """
    return shown(text, most).encode("ascii", "backslashreplace").decode()


def whole(text: str) -> str:
    """The same of a longer remark."""
    return plain(text, LONGEST)


def lines(parameters: Parameters, origin: Origin) -> list[str]:
    """erdctl's version, hashes of parameters and logs, ranges that were seen, noise."""
    return [
        f"written by erdctl {__version__}",
        f"parameters: {plain(origin.name)}, SHA-256 {origin.sha256}",
        *identified(parameters),
    ]


def identified(parameters: Parameters) -> list[str]:
    """By which erdctl, from which logs, on which ranges; of a file that may hold anything there."""
    p = parameters.provenance
    out = [f"identified by erdctl {plain(str(p['erdctl']))}"] if "erdctl" in p else []
    logs = p.get("logs")
    for log in logs if isinstance(logs, list) else []:
        if isinstance(log, dict):
            out.append(
                f"log: {plain(str(log.get('name')))}, SHA-256 {plain(str(log.get('sha256')))}"
            )
    ranges = _ranges(p.get("ranges"))
    if ranges:
        out.append(f"identified on {', '.join(ranges)}")
    if isinstance(p.get("noise_rms"), float):
        out.append(f"noise of the force: {p['noise_rms']:.3g} N rms")
    for key in ("date", "damper", "operator"):
        if key in p:
            out.append(f"{key}: {plain(str(p[key]))}")
    return out


def _ranges(seen: object) -> Sequence[str]:
    known = seen if isinstance(seen, dict) else {}
    return [
        f"{name} {known[name][0]:.4g}..{known[name][1]:.4g} {unit}".removesuffix(" 1")
        for name, unit in UNITS.items()
        if name in known
    ]

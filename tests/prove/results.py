"""Made-up results and keys that the tests of the proof share."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from erdctl.prove.case import Sealed
from erdctl.prove.judge import Result
from erdctl.prove.score import Errors, Found, HiddenEffect

REGION = {
    "variable": "xdot", "low": -0.01, "high": 0.01, "share": 0.8, "time": 0.2, "width": 0.1,
}  # fmt: skip


def sealed(number: int = 1, seed: int = 7) -> Sealed:
    return Sealed(number, seed, "ab" * 32, Path("l"), Path("f"), Path("k"), Path("d"))


def key(*effects: tuple[str, float], kind: str = "single", **more: Any) -> dict[str, Any]:
    """A key with what a score needs; an effect called "stranger" is not in the catalogue."""
    return {
        "kind": kind,
        "concealment": "unlabelled",
        "level": max((level for _, level in effects), default=0.0),
        "effects": [
            {"name": name, "alone": level, "equivalent": [], "catalogued": name != "stranger"}
            for name, level in effects
        ],
        "regions": [],
        "effect_regions": [],
        "force_noise": {"colour": "white"},
        "motion_noise": {"kind": "exact"},
        "flags": [],
    } | more


def document(verdict: str, *findings: tuple[str, ...], places: Any = ()) -> dict[str, Any]:
    """A diagnosis: of each finding its name and its look-alikes."""
    return {
        "verdict": verdict,
        "rig": [],
        "mismatch": [{"where": where, "share": 0.8, "text": ""} for where in places],
        "findings": [
            {"effect": name, "equivalent": list(others), "where": None}
            for name, *others in findings
        ],
    }


def result(seed: int = 7, **given: Any) -> Result:
    """A single, named and explained unless given otherwise."""
    plain: dict[str, Any] = {
        "number": 1, "seed": seed, "key_sha256": "ab" * 32, "kind": "single",
        "concealment": "unlabelled", "colour": "white", "motion": "exact", "level": 3.0,
        "flags": (), "hidden": (HiddenEffect("rub", 3.0),), "verdict": "explained",
        "findings": (Found("rub"),), "named": True, "matched": 1, "spurious": 0, "redundant": 0,
        "located": True, "fresh": Errors(5.0, 1.4, 1.0, 100.0),
    }  # fmt: skip
    return Result(**(plain | given))

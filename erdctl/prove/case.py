"""One concealed case on disk: its log, fresh records, and the key that stays shut until the end."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import msgspec

from erdctl.core.errors import ComputationProblem, UsageProblem
from erdctl.effects import catalogue
from erdctl.io import documents
from erdctl.prove.catalogued import nameable, right_names

FOLDERS = ("logs", "fresh", "keys", "diagnoses")
LEFT_OUT = "left_out"  # a kind of case: what is hidden is taken out of the catalogue


@dataclass(frozen=True, kw_only=True)
class Wish:
    """What a user may ask of the cases; None leaves it to the seed. See `erdctl.plant.draw`."""

    effects: tuple[str, ...] | None = None
    level: float | None = None
    kind: str | None = None
    concealment: str | None = None
    motion: str | None = None
    colour: str | None = None


@dataclass(frozen=True)
class Sealed:
    """A case that waits for its diagnosis.

    sha256 : of the bytes of the key file;  without : effects that the catalogue is to lack for it
    """

    number: int
    seed: int
    sha256: str
    log: Path
    fresh: Path
    key: Path
    diagnosis: Path
    without: tuple[str, ...] = ()


def check(wish: Wish, seeds: Iterable[int]) -> None:
    """Raise UsageProblem if any of the cases cannot be what is wished.

    Everything that a wish may get wrong shows in the plan, which costs nothing; no process is
    started for it.
    """
    from erdctl.plant.plan import draw_plan

    if wish.level is not None and not (math.isfinite(wish.level) and wish.level > 0.0):
        raise UsageProblem(f"--level is {wish.level:g}, expected misfit over noise above 0, e.g. 3")
    if wish.kind == "null" and (wish.effects or wish.level is not None):
        raise UsageProblem("--kind null hides nothing: leave --effects and --level out")
    try:
        for seed in seeds:
            draw_plan(seed, **_options(wish, _without(wish, seed)))
    except ValueError as problem:
        raise UsageProblem(str(problem)) from None


def seal(wish: Wish, seed: int, number: int, folder: Path) -> Sealed:
    """Draw a case and write its log, its fresh records and its key.

    What is unknown is decided here, by the catalogue, and the key says so.
    The log's name and the order of its rows say nothing of what is hidden: names count up, and the
    columns are those of the contract.
    """
    import pyarrow.parquet as pq

    from erdctl import plant

    without = _without(wish, seed)
    case = plant.draw(seed, **_options(wish, without))
    places = [folder / name for name in FOLDERS]
    for place in places:
        place.mkdir(parents=True, exist_ok=True)
    name = f"case-{number:03d}"
    logs, others, keys, diagnoses = places
    key = documents.encode(plant.key(case))
    sealed = Sealed(
        number, seed, hashlib.sha256(key).hexdigest(), logs / f"{name}.parquet",
        others / f"{name}.parquet", keys / f"{name}.json", diagnoses / f"{name}.json", without[1:],
    )  # fmt: skip
    pq.write_table(plant.log(case), sealed.log)
    pq.write_table(plant.fresh(case), sealed.fresh)
    sealed.key.write_bytes(key)
    return sealed


def opened(sealed: Sealed) -> dict[str, Any]:
    """The key; refused if it is not the one whose hash was shown."""
    data = sealed.key.read_bytes()
    if hashlib.sha256(data).hexdigest() != sealed.sha256:
        raise ComputationProblem(f"{sealed.key}: the key has changed since its hash was printed")
    key: dict[str, Any] = msgspec.json.decode(data)
    return key


def _without(wish: Wish, seed: int) -> tuple[str, ...]:
    """What a seed of the kind LEFT_OUT hides, and the effects that could name it."""
    if wish.kind != LEFT_OUT:
        return ()
    from erdctl.plant.plan import draw_plan

    plan = draw_plan(seed, **{**_options(wish, ()), "kind": "single"})
    hidden = plan.effects[0].name
    names = {hidden, *right_names(hidden)}
    return hidden, *(e.name for e in catalogue() if e.name in names)


def _options(wish: Wish, without: tuple[str, ...]) -> dict[str, Any]:
    """What the plant is asked for; without : see `_without`."""
    asked = {"known": nameable(), **asdict(wish)}
    if not without:
        return asked
    return {**asked, "known": nameable() - {*without}, "kind": "unknown", "effects": [without[0]]}

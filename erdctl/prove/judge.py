"""One case after it was sealed: the diagnosis sees its log alone, then the key is opened."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.effects import candidates
from erdctl.io import documents
from erdctl.io.diagnosis import to_json
from erdctl.io.logs import read_logs
from erdctl.io.parameters import parse_parameters
from erdctl.model.composed import Model
from erdctl.prove.best import acts, best_fit, damper_values
from erdctl.prove.case import LEFT_OUT, Sealed, opened
from erdctl.prove.catalogued import right_names, structures
from erdctl.prove.score import (
    Errors,
    Found,
    HiddenEffect,
    Interval,
    LawPlace,
    Printed,
    located,
    naming,
)


@dataclass(frozen=True)
class Result:
    """One case, scored.

    colour, motion : of the noise, and "exact" or "measured"
    hidden : what the key says;  verdict, findings : what the diagnosis said without it
    named : whether the first finding is right, None where nothing of the catalogue is hidden; in a
        crowd, whether it is the strong one
    matched, spurious, redundant : see `score.Naming`
    located : None where the misfit is everywhere
    first_place : the first place of the mismatch is one of the misfit or of the effect's own force
    flags : what the plant says makes the case unfair or undecidable
    cannot_tell : whether the diagnosis says that these data cannot decide
    learned : what the diagnosis learned of a rest that it could not name, as slot(coordinate)
    lies : whether that has the slot and the coordinates of what is hidden, or says that a law would
        do as well that has them; None where the key says of no such
    printed : of a sparse case: what the diagnosis prints with an interval, where its model is the
        true one, so that the plant knows what it should be
    """

    number: int
    seed: int
    key_sha256: str
    kind: str
    concealment: str
    colour: str
    motion: str
    level: float
    flags: tuple[str, ...]
    hidden: tuple[HiddenEffect, ...]
    verdict: str
    findings: tuple[Found, ...]
    named: bool | None
    matched: int
    spurious: int
    redundant: int
    located: bool | None
    fresh: Errors
    first_place: bool | None = None
    cannot_tell: bool = False
    learned: tuple[str, ...] = ()
    lies: bool | None = None
    printed: tuple[Printed, ...] = ()


@dataclass(frozen=True)
class Failed:
    """A case that could not be scored; it counts as a miss, and its seed is printed."""

    number: int
    seed: int
    message: str


def judge(sealed: Sealed) -> Result:
    """Diagnose, write the diagnosis down, and only then open the key."""
    found = examine(sealed.log, sealed.without)
    document = to_json(found)
    sealed.diagnosis.write_bytes(documents.encode(document))
    key = opened(sealed)
    return scored(sealed, document, key, _errors(sealed, found, key))


def examine(log: Path, without: Sequence[str] = ()) -> Diagnosis:
    """What `erdctl diagnose LOG` does, given the file alone; of limits none, as none is scored.

    without : effects that are not to be tested, as with `--exclude`
    """
    run = partial(diagnose, candidates=candidates(exclude=without), limits=False)
    return with_a_fault_once(run, _read(log))


def scored(
    sealed: Sealed, document: Mapping[str, Any], key: Mapping[str, Any], fresh: Errors
) -> Result:
    """A diagnosis' document against the key."""
    names = [e["name"] for e in key["effects"]]
    hidden = tuple(
        HiddenEffect(
            e["name"], float(e["alone"]), right_names(e["name"], tuple(e["equivalent"]), names)
        )
        for e in key["effects"]
    )
    known = all(e["catalogued"] for e in key["effects"])
    once = [document["sets_in_once"]] if "sets_in_once" in document else []
    findings = tuple(
        Found(f["effect"], tuple(f["equivalent"])) for f in (*document["findings"], *once)
    )
    mended = tuple(_mended(document, hidden))
    match = naming((*mended, *findings), hidden)
    first = match.first
    if "strong" in key:
        # What a check of the rig says of the velocity has no place among the findings.
        strong = [h for h in hidden if h.effect == key["strong"]]
        first = any(naming(of[:1], strong).first for of in (findings, mended))
    return Result(
        number=sealed.number,
        seed=sealed.seed,
        key_sha256=sealed.sha256,
        kind=LEFT_OUT if sealed.without else key["kind"],
        concealment=key["concealment"],
        colour=key["force_noise"]["colour"],
        motion="exact" if key["motion_noise"]["kind"] == "exact" else "measured",
        level=float(key["level"]),
        flags=tuple(key["flags"]),
        hidden=hidden,
        verdict=document["verdict"],
        findings=findings,
        named=first if hidden and known else None,
        matched=match.matched,
        spurious=match.spurious,
        redundant=match.redundant,
        located=located(places(document), key["regions"]),
        fresh=fresh,
        first_place=located(
            places({"mismatch": document["mismatch"][:1], "findings": []}),
            [*key["regions"], *key["effect_regions"]],
        ),
        cannot_tell=bool(document.get("cannot_tell")),
        learned=tuple(
            f"{law['slot']}({', '.join(z['name'] for z in law['coordinates'])})"
            for law in document.get("learned", ())
        ),
        lies=_lies(document, key),
        printed=_printed(document, key),
    )


def _mended(document: Mapping[str, Any], hidden: Sequence[HiddenEffect]) -> Iterator[Found]:
    """What a check of the rig names, that a fit does without afterwards."""
    names = {h.effect for h in hidden}
    return (Found(check["code"], ()) for check in document["rig"] if check["code"] in names)


def _lies(document: Mapping[str, Any], key: Mapping[str, Any]) -> bool | None:
    """Whether some law acts where what is hidden outside the catalogue does, and is of the same."""
    outside = [e for e in key["effects"] if not e["catalogued"] and e.get("lies") is not None]
    if not outside:
        return None
    said = [
        LawPlace.of(slot, names)
        for law in document.get("learned", ())
        for slot, names in [
            (law["slot"], [z["name"] for z in law["coordinates"]]),
            *((a["slot"], a["coordinates"]) for a in law["equivalent"]),
        ]
    ]
    true = [
        LawPlace.of(slot, names)
        for e in outside
        for slot, names in [(e["lies"]["slot"], e["lies"]["coordinates"]), *e["lies"]["alike"]]
    ]
    return any(place in true for place in said)


def _printed(document: Mapping[str, Any], key: Mapping[str, Any]) -> tuple[Printed, ...]:
    """Parameters with an interval of a model that is the plant's own, effect for effect."""
    law = key.get("law")
    if law is None or {f["effect"] for f in document["findings"]} != {
        e["name"] for e in key["effects"]
    }:
        return ()
    own = {f"{e['name']}.{s}": v for e in key["effects"] for s, v in law.items() if "." not in s}
    truth = damper_values(key) | own | {s: v for s, v in law.items() if "." in s}
    params = parse_parameters(documents.encode(document["corrected"]["params"]), "corrected.params")
    intervals = {name: e.interval for name, e in params.estimates.items()}
    return tuple(
        Printed(name, *within, truth[name])
        for name, within in intervals.items()
        if within is not None and name in truth
    )


def places(document: Mapping[str, Any]) -> list[Interval]:
    """Everywhere that a diagnosis points at, once."""
    where = [entry["where"] for entry in (*document["mismatch"], *document["findings"])]
    found = [Interval(w["variable"], w["low"], w["high"]) for w in where if w is not None]
    return list(dict.fromkeys(found))


def _errors(sealed: Sealed, found: Diagnosis, key: Mapping[str, Any]) -> Errors:
    """Errors on records that are new to every model, and free of noise."""
    fresh = _read(sealed.fresh)
    true = fresh.force
    assert true is not None
    signals = Signals.of(fresh)

    def rms(model: Model, values: Mapping[str, float]) -> float:
        missed: Array = true - model.force(signals, values)
        return float(np.sqrt(np.mean(missed**2)))

    # What a user is given: the last step may have moved what the search ended with.
    base, corrected = found.selection.base, parameters(found)
    best = None
    if key["effects"] and all(e["catalogued"] for e in key["effects"]):
        of_each = product(*(structures(e["name"]) for e in key["effects"]))
        reached = [
            best_fit(found.problem, truth, damper_values(key), corrected.values)
            for truth in of_each if acts(truth, signals)
        ]  # fmt: skip
        if reached:
            least = min(reached, key=lambda r: r.cost)
            best = rms(least.model, least.values)
    return Errors(
        paper=rms(base.model, base.values),
        corrected=rms(corrected.model, corrected.values),
        best=best,
        span=float(np.ptp(true)),
    )


def _read(path: Path) -> Recording:
    """A log as the commands read it; remarks on it go nowhere, as nobody reads 200 of them."""
    return read_logs([str(path)], need_force=True, report=lambda line: None).recording

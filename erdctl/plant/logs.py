"""What a case hands out: the log as a laboratory has it, fresh records, and the key."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from erdctl.plant.campaign import Campaign
from erdctl.plant.case import Case
from erdctl.plant.own import velocity
from erdctl.plant.plan import stream
from erdctl.plant.plant import Side
from erdctl.plant.simulate import Ride, force, rides
from erdctl.plant.twin import Lies

Array = npt.NDArray[np.float64]

COLUMNS = ("t", "x", "xdot", "duty", "force", "record")
SCHEMA = "erdctl.plant-key/1"


def log(case: Case) -> pa.Table:
    """The log: the contract's columns and nothing else, no metadata either."""
    over = rides(case.campaign)
    lengths = [r.record.samples for r in over]
    noise = case.force_noise.at(stream(case.seed, "sound"), lengths, case.campaign.rate)
    edges = np.cumsum([0, *lengths])
    rig = stream(case.seed, "rig")
    columns: dict[str, list[Array]] = {name: [] for name in COLUMNS[:-1]}
    zeros = case.zeros or (0.0,) * len(over)
    bounds = zip(over, case.gains, zeros, edges[:-1], edges[1:], strict=True)
    for number, (r, gain, zero, a, b) in enumerate(bounds):
        t, x, v = r.sampled()
        x, v = case.motion_noise.at(rig, x, v, r.record.rate)
        v = velocity(case.plant.own, v, number)
        measured = gain * force(case.plant, r) + zero + noise[a:b]
        for name, values in zip(columns, (t, x, v, r.duty, measured), strict=True):
            columns[name].append(values)
    return _table(columns, over)


def fresh(case: Case) -> pa.Table:
    """Records of other motions and duties, as exact as they can be, with the true force."""
    over = rides(case.fresh)
    columns: dict[str, list[Array]] = {name: [] for name in COLUMNS[:-1]}
    for r in over:
        t, x, v = r.sampled()
        for name, values in zip(columns, (t, x, v, r.duty, force(case.plant, r)), strict=True):
            columns[name].append(values)
    return _table(columns, over)


def _table(columns: dict[str, list[Array]], over: Sequence[Ride]) -> pa.Table:
    arrays: dict[str, Any] = {name: np.concatenate(parts) for name, parts in columns.items()}
    arrays["record"] = np.repeat([r.record.name for r in over], [r.record.samples for r in over])
    return pa.table({name: pa.array(arrays[name]) for name in COLUMNS})


def key(case: Case) -> dict[str, Any]:
    """What is hidden and what is known about it, ready for JSON."""
    return {
        "schema": SCHEMA,
        "seed": case.seed,
        "kind": case.kind,
        "concealment": case.concealment,
        "effects": [
            {
                **{n: v for n, v in asdict(truth).items() if n != "law"},
                "parameters": {
                    name: {"value": value, "unit": unit}
                    for name, (value, unit) in truth.parameters.items()
                },
                "equivalent": list(truth.equivalent),
                "lies": None if truth.lies is None else _lies(truth.lies),
            }
            for truth in case.truth
        ],
        "level": case.level,
        "raw": case.raw,
        "near_reversals": case.near,
        "own_nrmse": case.own_nrmse,
        "fresh_nrmse": case.fresh_nrmse,
        "regions": [asdict(r) for r in case.regions],
        "effect_regions": [asdict(r) for r in case.effect_regions],
        "flags": list(case.flags),
        "damper": _sides(case.plant.compression, case.plant.release),
        "refitted": _sides(case.refitted.compression, case.refitted.release),
        "force_noise": asdict(case.force_noise),
        "motion_noise": asdict(case.motion_noise),
        "gains": list(case.gains),
        **_asked(case),
        "campaign": _campaign(case.campaign),
        "fresh": _campaign(case.fresh),
    }


def _lies(lies: Lies) -> dict[str, Any]:
    return {
        "slot": lies.slot,
        "coordinates": list(lies.coordinates),
        "curve": lies.curve,
        "alike": [[slot, list(coordinates)] for slot, coordinates in lies.alike],
    }


def _asked(case: Case) -> dict[str, Any]:
    """What only the key of a kind that must be asked for says."""
    if case.kind == "crowded":
        return {"strong": case.truth[0].name, "zeros": list(case.zeros)}
    if case.kind == "sparse":
        return {"law": case.truth[0].law if case.truth else {}}
    return {}


def _sides(compression: Side, release: Side) -> dict[str, Any]:
    return {"compression": compression._asdict(), "release": release._asdict()}


def _campaign(campaign: Campaign) -> dict[str, Any]:
    return {
        "rate": campaign.rate,
        "rating": asdict(campaign.rating),
        "records": [
            {
                "name": r.name,
                "samples": r.samples,
                "motion": {**asdict(r.motion), **{
                    k: list(getattr(r.motion, k)) for k in ("amplitudes", "frequencies", "phases")
                }},
                "duty": {"levels": list(r.duty.levels), "starts": list(r.duty.starts)},
            }
            for r in campaign.records
        ],
    }  # fmt: skip

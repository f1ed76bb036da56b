"""Null cases: the log of a plain damper under one kind of noise or rig error; nothing is hidden."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from erdctl.plant.base import draw_base
from erdctl.plant.campaign import draw_short
from erdctl.plant.noise import draw_force_noise
from erdctl.plant.plan import stream
from erdctl.plant.rig_errors import KINDS, Kind, RigLog
from erdctl.plant.simulate import forces, rides


@dataclass(frozen=True, eq=False)
class Null:
    """A log with the contract's columns, and the kind of noise or rig error in it.

    noise : rms of the force noise [N]
    """

    seed: int
    name: str
    kind: Kind
    table: pa.Table
    noise: float


def draw_null(seed: int, name: str | None = None) -> Null:
    """A null case; without a name the kinds follow one another with the seed."""
    name = name or tuple(KINDS)[seed % len(KINDS)]
    if name not in KINDS:
        raise ValueError(f"no such kind of noise: {name}; there are {', '.join(KINDS)}")
    campaign = draw_short(stream(seed, "campaign"), count=6)
    over = rides(campaign)
    plant = draw_base(stream(seed, "damper"), campaign)
    force = forces(plant, over)
    scale = float(np.ptp(force))
    rms = draw_force_noise(stream(seed, "force noise")).scaled(scale).rms
    t, x, v = (np.concatenate(parts) for parts in zip(*(r.sampled() for r in over), strict=True))
    edges = tuple(np.cumsum([0, *(r.record.samples for r in over)]).tolist())
    duty = np.concatenate([r.duty for r in over])
    clean = RigLog(t, x, v, duty, force, edges, campaign.rate, rms, scale)
    log = KINDS[name].apply(clean, stream(seed, "rig"))
    lengths = np.diff(log.edges)
    columns = {
        "t": log.t, "x": log.x, "xdot": log.xdot, "duty": log.duty, "force": log.force,
        "record": np.repeat([r.record.name for r in over], lengths),
    }  # fmt: skip
    if not log.logs_velocity:
        del columns["xdot"]
    return Null(seed, name, KINDS[name], pa.table(columns), rms)

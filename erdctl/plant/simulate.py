"""The force that a plant gives over a campaign, at the samples of its log."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.plant.campaign import Campaign, CampaignRecord
from erdctl.plant.channel import recorded
from erdctl.plant.march import march
from erdctl.plant.plant import Outside, Plant, canonical

Array = npt.NDArray[np.float64]

LEAST_SUBSTEPS = 10
LONGEST_STEP = 0.5e-3  # s
LEAD_IN = 1.0  # s, simulated before t = 0 for play, springs and seals
LEAD_OUT = 0.25  # s, so that an early force channel finds samples


@dataclass(frozen=True, eq=False)
class Ride:
    """A record on the fine grid: motion at the nodes, duty at the samples.

    It does not depend on the plant, so that many plants can be driven over the same one.
    """

    record: CampaignRecord
    substeps: int
    lead_in: int
    h: float
    x: Array
    v: Array
    a: Array
    duty: Array

    def sampled(self) -> tuple[Array, Array, Array]:
        """t, x and xdot of the log, exact."""
        n, k = self.record.samples, self.substeps
        at = slice(self.lead_in, self.lead_in + n * k, k)
        return np.arange(n) / self.record.rate, self.x[at], self.v[at]


def ride(record: CampaignRecord, *, refine: int = 1) -> Ride:
    """A record on its fine grid; `refine` divides the step further."""
    substeps = refine * max(LEAST_SUBSTEPS, math.ceil(1.0 / (record.rate * LONGEST_STEP)))
    h = 1.0 / (record.rate * substeps)
    lead_in, lead_out = round(LEAD_IN / h), round(LEAD_OUT / h)
    count = lead_in + (record.samples - 1) * substeps + 1 + lead_out
    x, v, a = record.motion.at(-lead_in * h, h, count)
    return Ride(record, substeps, lead_in, h, x, v, a, record.duty.at(record.samples))


def rides(campaign: Campaign, *, refine: int = 1) -> tuple[Ride, ...]:
    """All records of a campaign."""
    return tuple(ride(record, refine=refine) for record in campaign.records)


def force(plant: Plant, over: Ride) -> Array:
    """(n,) force at the samples of one record [N], free of noise."""
    plant = canonical(plant)
    if plant.physics.mount > 0.0 and plant.physics.fluid_spring > 0.0:
        raise ValueError("mount and fluid column both yield: at a rod they are one spring")
    if plant.physics.mount > 0.0 and plant.outside != Outside():
        raise ValueError("physics from outside the table is not modelled behind a soft mount")
    fine = march(
        over.x, over.v, over.a, over.duty, over.substeps, over.lead_in, over.h,
        plant.compression, plant.release, plant.physics, plant.outside,
    )  # fmt: skip
    n = over.record.samples
    return recorded(fine, over.h, over.lead_in, over.substeps, n, plant.channel)


def forces(plant: Plant, over: Sequence[Ride]) -> Array:
    """The same over several records, one after the other."""
    return np.concatenate([force(plant, r) for r in over])


def simulate(plant: Plant, record: CampaignRecord, *, refine: int = 1) -> Array:
    """(n,) force of a plant over one record [N].

    With xdot > 0 throughout and a duty step from 0 to v that is sigma v^beta (1 - exp(-t/T_d)) on
    top of gas and viscous force, which the plant's tests hold it to.
    """
    return force(plant, ride(record, refine=refine))

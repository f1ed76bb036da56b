"""A concealed case: what is hidden, in which damper, seen by which campaign, under which noise."""

from __future__ import annotations

from dataclasses import dataclass

from erdctl.plant.campaign import Campaign
from erdctl.plant.noise import ForceNoise, MotionNoise
from erdctl.plant.plant import Plant
from erdctl.plant.regions import MisfitRegion
from erdctl.plant.twin import Lies


@dataclass(frozen=True)
class Truth:
    """One hidden effect.

    parameters : symbol -> value and SI unit;  strength : dimensionless, as it was sought
    wanted : level asked for;  alone : level without the case's other effect;  raw : misfit over
    noise against the same damper without it, before the paper's model is refitted
    within : what it adds to the misfit of the whole case, over noise
    equivalent : names that no force channel at the rod tells from it
    law : what a fit of the law usually taken should find, by the field's symbols; None where the
    plant's is another
    lies : where its law acts and of what it is; None where it is none of motion and control
    """

    name: str
    catalogued: bool
    parameters: dict[str, tuple[float, str]]
    strength: float
    wanted: float
    alone: float
    raw: float
    within: float
    equivalent: tuple[str, ...]
    law: dict[str, float] | None = None
    lies: Lies | None = None


@dataclass(frozen=True)
class Case:
    """Everything that makes the log, and what is to be known about it.

    kind : "single", "pair", "null", "unknown", "crowded" (of the truth the first is the strong one)
        or "sparse"
    concealment : "unlabelled", "absorbed" (the refitted paper model looks good on the log, and
        fails on other records) or "not_logged" (a temperature, a fault's onset)
    level, raw : misfit over noise, after the refit and before
    near : share of the misfit within two samples of a reversal
    own_nrmse, fresh_nrmse : of the refitted paper model, noise included, on the log; and on the
        fresh records, which have none
    regions : where the misfit lives that the refit leaves, tightest first; () if everywhere
    effect_regions : where force with and without the effects differs
    flags : what makes the case unfair or undecidable
    zeros : zero of the force channel in each record [N]; () where it is 0 in all
    """

    seed: int
    kind: str
    concealment: str
    truth: tuple[Truth, ...]
    plant: Plant
    refitted: Plant
    campaign: Campaign
    fresh: Campaign
    force_noise: ForceNoise
    motion_noise: MotionNoise
    gains: tuple[float, ...]
    level: float
    raw: float
    near: float
    own_nrmse: float
    fresh_nrmse: float
    regions: tuple[MisfitRegion, ...]
    effect_regions: tuple[MisfitRegion, ...]
    flags: tuple[str, ...]
    zeros: tuple[float, ...] = ()

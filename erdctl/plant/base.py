"""Dampers as widely as they are built: from a model car's 30 N to 20 kN."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.plant.campaign import Campaign
from erdctl.plant.plant import Plant, Side

Random = np.random.Generator

UNLIKE = 0.4  # log of the largest ratio between the directions: 1.5


@dataclass(frozen=True)
class Weights:
    """How much the draw favours a part of the force; 1 is no favour."""

    gas: float = 1.0
    viscous: float = 1.0
    yielding: float = 1.0


PLAIN = Weights()


def draw_base(random: Random, campaign: Campaign, weights: Weights = PLAIN) -> Plant:
    """A plain damper whose gas, viscous and yield force share the campaign's reach."""
    total = float(np.exp(random.uniform(np.log(30.0), np.log(20e3))))
    gas = 0.0 if random.random() < 0.1 else float(random.uniform(0.02, 0.5))
    parts = np.array([
        weights.gas * gas,
        weights.viscous * random.uniform(0.08, 0.7),
        weights.yielding * random.uniform(0.2, 0.75),
    ])  # fmt: skip
    parts *= total / parts.sum()
    beta = float(np.exp(random.uniform(np.log(0.2), np.log(2.0))))
    T_d = float(np.exp(random.uniform(np.log(5e-3), np.log(0.150))))
    k = parts[0] / (campaign.reach_x * campaign.rating.stroke)
    c = parts[1] / (campaign.reach_v * campaign.rating.speed)
    sigma = parts[2] / campaign.top**beta
    ratio = np.exp(0.5 * random.uniform(-UNLIKE, UNLIKE, 5))
    if random.random() < 0.3:
        ratio[0] = 1.0  # a gas spring need not know directions
    if random.random() < 0.3:
        ratio[2] = 1.0  # nor need the supply
    unlike_beta = min(max(beta * ratio[4], 0.2), 2.0), min(max(beta / ratio[4], 0.2), 2.0)
    up = Side(k * ratio[0], c * ratio[1], T_d * ratio[2], sigma * ratio[3], unlike_beta[0])
    down = Side(k / ratio[0], c / ratio[1], T_d / ratio[2], sigma / ratio[3], unlike_beta[1])
    return Plant(Side(*map(float, up)), Side(*map(float, down)))

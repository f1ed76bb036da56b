"""A plant simulator that shares no code with the rest of erdctl, to prove the diagnosis with.

case = draw(seed, known=names)     a concealed case: effect, strength, damper, campaign, noise
log(case)             the log that a laboratory would have
fresh(case)           other records, noise-free, to judge a corrected model by
key(case)             the truth, for JSON
simulate(plant, record)
"""

from __future__ import annotations

from erdctl.plant.campaign import Campaign, CampaignRecord, DutyProgramme
from erdctl.plant.case import Case, Truth
from erdctl.plant.draw import draw
from erdctl.plant.hooks import FineGrid, Hooks
from erdctl.plant.logs import fresh, key, log
from erdctl.plant.plant import ForceChannel, Outside, Physics, Plant, Side
from erdctl.plant.simulate import simulate
from erdctl.plant.trajectory import Trajectory
from erdctl.plant.twin import Twin

__all__ = [
    "Campaign",
    "CampaignRecord",
    "Case",
    "DutyProgramme",
    "FineGrid",
    "ForceChannel",
    "Hooks",
    "Outside",
    "Physics",
    "Plant",
    "Side",
    "Trajectory",
    "Truth",
    "Twin",
    "draw",
    "fresh",
    "key",
    "log",
    "simulate",
]

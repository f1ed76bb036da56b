"""Nothing but the force may tell what is hidden: not the campaign's shape, names, lengths, rates,
and not the colour of the noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from plant_rig import EVERY, KNOWN

from erdctl.plant import draw, log
from erdctl.plant.plan import CasePlan, draw_plan

PLANS = 1500


@pytest.fixture(scope="module")
def plans() -> list[CasePlan]:
    return [draw_plan(seed, known=KNOWN) for seed in range(PLANS)]


def shape(plan: CasePlan) -> list[float]:
    """What a log shows without a look at the force."""
    records = plan.campaign.records
    n = np.array([r.samples for r in records], dtype=float)
    levels = [len(set(r.duty.levels)) for r in records]
    return [
        len(n), n.sum(), n.mean(), n.std(), n[0], n.max(), n.min(), plan.campaign.rate,
        n.sum() / plan.campaign.rate, float(np.mean(levels)), float(np.mean(np.array(levels) == 1)),
        plan.campaign.top, plan.campaign.rating.stroke, plan.campaign.rating.speed,
        plan.campaign.reach_x, float(np.mean([r.motion.ramp > 0 for r in records])),
        float(np.mean([len(r.motion.amplitudes) for r in records])),
        {"white": 0.0, "ar1": 1.0, "pink": 2.0}[plan.force_noise.colour],
        {"exact": 0.0, "savgol": 1.0, "difference": 2.0}[plan.motion_noise.kind],
    ]  # fmt: skip


def guessed(features: np.ndarray, labels: np.ndarray, neighbours: int = 15) -> float:
    """Share of labels that the nearest neighbours' vote gets right, on the half not learnt from."""
    ranks = np.argsort(np.argsort(features, axis=0), axis=0) / len(features)
    half = len(features) // 2
    names, codes = np.unique(labels, return_inverse=True)
    right = 0
    for u, code in zip(ranks[half:], codes[half:], strict=True):
        near = np.argpartition(((ranks[:half] - u) ** 2).sum(axis=1), neighbours)[:neighbours]
        right += int(np.argmax(np.bincount(codes[:half][near], minlength=len(names))) == code)
    return right / (len(features) - half)


@pytest.mark.long
def test_a_guess_from_the_shape_alone_is_a_guess(plans: list[CasePlan]) -> None:
    features = np.array([shape(p) for p in plans])
    for labels in (
        np.array([p.kind for p in plans]),
        np.array([p.effects[0].name if p.effects else "" for p in plans]),
        np.array([bool(p.effects) and p.effects[0].hidden for p in plans]),
    ):
        half = len(plans) // 2
        _, counts = np.unique(labels[half:], return_counts=True)
        chance = counts.max() / counts.sum()  # always saying the most frequent
        assert guessed(features, labels) < chance + 3 * np.sqrt(chance * (1 - chance) / half)


def test_the_guess_would_find_a_leak(plans: list[CasePlan]) -> None:
    features = np.array([shape(p) for p in plans])
    kinds = np.array([p.kind for p in plans])
    features[:, :4] += 1e6 * (kinds == "null")[:, None]
    assert guessed(features, kinds == "null") > 0.95


def test_the_colour_of_the_noise_tells_nothing(plans: list[CasePlan]) -> None:
    for colour in ("white", "ar1", "pink"):
        share = {
            kind: np.mean([p.force_noise.colour == colour for p in plans if p.kind == kind])
            for kind in ("null", "unknown", "single")
        }
        # three standard errors of the difference of two shares among some 190 plans
        assert abs(share["null"] - share["unknown"]) < 0.15
        assert abs(share["null"] - share["single"]) < 0.12


def test_campaign_and_noise_are_the_same_whatever_is_hidden() -> None:
    for seed in range(5):
        bare = draw_plan(seed, known=KNOWN, kind="null")
        for name in EVERY:
            plan = draw_plan(seed, known=KNOWN, effects=[name])
            hidden = replace(
                plan, kind=bare.kind, effects=bare.effects, known=bare.known, levels=bare.levels
            )
            assert hidden == bare


@pytest.mark.long
def test_the_log_keeps_the_plan() -> None:
    """Nothing that fails later changes the campaign or the colour: same rows but for the force."""
    bare = log(draw(90, known=KNOWN, kind="null"))
    for wish in ({"effects": ["backlash"], "level": 0.5}, {"kind": "unknown"}):
        other = log(draw(90, known=KNOWN, **wish))
        for column in ("t", "x", "xdot", "duty", "record"):
            assert other[column].equals(bare[column])
        assert not other["force"].equals(bare["force"])

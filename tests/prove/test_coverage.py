"""Intervals hold the truth of another simulator: few readings here, many by `measure_coverage`."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.core.blocks import whole
from erdctl.diagnose.record_effects import Varying
from erdctl.effects import get
from erdctl.estimate.finer import Finer
from erdctl.model.composed import Model
from erdctl.plant.noise import DISTURBANCES, disturbed
from erdctl.plant.twins import every
from erdctl.prove.coverage import Held, conceal, read

WITH_LAWS = [name for name, twin in every().items() if twin.law is not None]
# A simulation in samples' steps cannot place these: the sample next to a turn or a contact is of
# the one side or the other, and the fit leaves it out, or counts it as no more than noise.
BY_SAMPLES = {"time_skew", "clock_drift", "velocity_noise", "backlash", "damped_backlash"}


def share(held: list[Held], widened: float = 1.0) -> float:
    """Part of the intervals that would hold the truth if they were so many times as wide."""
    inside = []
    for h in held:
        if h.inside is not None:
            assert h.estimate.interval is not None
            assert h.estimate.value is not None
            far = [h.estimate.value + widened * (e - h.estimate.value) for e in h.estimate.interval]
            inside.append(far[0] <= h.truth <= far[1])
    return float(np.mean(inside))


def test_intervals_of_the_paper_s_parameters_hold_and_are_no_wider_than_they_need_be() -> None:
    held = [
        h for seed in range(7000, 7006) for kind in DISTURBANCES
        for h in read(conceal("", seed, samples=3_000), kind)
    ]  # fmt: skip
    assert len(held) == 240
    # 0.95 less three standard deviations of 240 that are half of them alike.
    assert share(held) >= 0.89
    # 67 % of a normal distribution lie within half of its 95 % interval, and 42 % within 0.28.
    assert share(held, 0.5) <= 0.80
    assert share(held, 0.28) <= 0.60


def test_errors_beside_record_effects_hold_too() -> None:
    held = [
        h for seed in range(7100, 7108)
        for h in read(conceal("", seed), "scatter", free=Varying(gain=True, offset=True))
    ]  # fmt: skip
    assert share(held) >= 0.85
    assert share(held, 0.28) <= 0.65


@pytest.mark.parametrize("name", [n for n in WITH_LAWS if n not in BY_SAMPLES])
def test_the_law_between_samples_is_that_of_the_plant(name: str) -> None:
    """At the truth the two simulators differ by less than a fifth of the least noise in rms."""
    for seed in (7200, 7201):
        damper = conceal(name, seed)
        block, model = whole(damper.recording), Model((get(name),))
        modelled = Finer.of(block.signals).force(model, damper.truth)
        off = (block.force - modelled)[block.weight > 0.0]
        assert np.sqrt(np.mean(off**2)) < 0.2 * 0.003 * np.ptp(block.force)


@pytest.mark.few(1)
@pytest.mark.parametrize("effect", ["mount_compliance", "input_delay", "time_skew", "cavitation"])
def test_a_bias_of_the_step_is_gone(effect: str) -> None:
    """These were off by several errors in the log's own steps."""
    own = [h for seed in range(3) for h in read(conceal(effect, 7300 + seed), "white")]
    off = [abs(h.off) for h in own if h.parameter.startswith(effect) and h.off is not None]
    assert len(off) >= 3
    assert np.median(off) < 2.0


@pytest.mark.long
def test_a_play_is_not_told_by_the_noise_of_samples_next_to_contact() -> None:
    """These had intervals that did not hold it, as narrow as 0.06 % of it."""
    dampers = {9305: ["white"], 9313: ["white", "growing"], 9344: ["white"], 9352: ["white"]}
    own = [
        h for seed, kinds in dampers.items() for kind in kinds for number in (0, 1)
        for h in read(conceal("backlash", seed), kind, number) if h.parameter == "backlash.g"
    ]  # fmt: skip
    assert len(own) == 10
    assert share(own) >= 0.8
    assert share(own, 0.1) <= 0.5


def test_laws_name_parameters_of_the_catalogue() -> None:
    from erdctl.plant.plant import Plant, Side
    from erdctl.plant.twin import Scales

    side = Side(1000.0, 500.0, 0.03, 100.0, 0.8)
    by = Scales(0.02, 0.2, 3.0, 0.03, 200.0, 0.5, 5.0, 10.0, 100.0, 5e-4)
    for name in WITH_LAWS:
        twin = every()[name]
        random = np.random.default_rng(1)
        assert twin.law is not None
        _, truth = twin.law(twin.build(Plant(side, side), twin.start, twin.drawn(random), by))
        assert {q.symbol for q in get(name).quantities} <= set(truth), name


def test_every_effect_has_a_law() -> None:
    from erdctl.effects import names

    assert set(names()) <= set(WITH_LAWS)


def test_records_scatter_as_said() -> None:
    force = np.tile([10.0, -10.0], 50_000)
    read_ = disturbed(np.random.default_rng(1), force, [1000] * 100, 0.5, "scatter")
    parts = read_.reshape(100, 1000)
    zero = parts.mean(axis=1)
    gain = (parts[:, ::2].mean(axis=1) - parts[:, 1::2].mean(axis=1)) / 20.0
    assert zero.std() == pytest.approx(0.5, rel=0.2)
    assert gain.std() == pytest.approx(0.01, rel=0.2)

"""The energy test: as strong in few places as in many, and quiet where there is only noise."""

from __future__ import annotations

import numpy as np
import pytest
from rig import campaign, noisy
from scipy.signal import lfilter

from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import Comparison
from erdctl.diagnose.energy import Clusters, EnergyTest, critical_value, energy_test
from erdctl.diagnose.problem import Problem, prepare


@pytest.fixture(scope="module")
def problem() -> Problem:
    return prepare(noisy(campaign(), seed=1))


def coloured(random: np.random.Generator, n: int, rho: float) -> np.ndarray:
    return np.asarray(lfilter([np.sqrt(1 - rho * rho)], [1.0, -rho], random.standard_normal(n)))


@pytest.mark.parametrize("rho", [0.0, 0.9])
def test_noise_alone_gives_a_standard_normal(problem: Problem, rho: float) -> None:
    """The difference of two predictions is a smooth curve that knows nothing of the noise."""
    random = np.random.default_rng(3)
    r, found = problem.recording, []
    for _ in range(150):
        e = coloured(random, len(r), rho)
        d = 0.1 * np.sin(2 * np.pi * random.uniform(0.3, 3.0) * r.t + random.uniform(0, 6))
        found.append(energy_test(problem, e, e - d).z)
    assert abs(np.mean(found)) < 3 / np.sqrt(150)
    assert 0.75 < np.std(found) < 1.2
    assert max(found) < thresholds.Z_ENERGY


def test_a_large_misfit_in_few_places_counts(problem: Problem) -> None:
    """In some peaks of one record of nine: log ratios over stretches stay below their bar."""
    random, r = np.random.default_rng(4), problem.recording
    e = random.standard_normal(len(r))
    where = np.zeros(len(r))
    s = slice(r.starts[3], r.starts[3] + 1400)
    where[s] = np.maximum(r.x[s] - 0.8 * r.x[s].max(), 0.0)
    where *= 4.0 / where.max()
    t_stretches, _ = problem.t_statistics(e + where, e)
    found = energy_test(problem, e + where, e)
    assert t_stretches < thresholds.T_STRETCHES
    assert found.significant
    assert found.slope == pytest.approx(1.0, abs=0.2)
    assert found.records.places == pytest.approx(1.0)


def test_what_one_record_has_of_its_own_is_not_steady(problem: Problem) -> None:
    """Gains that scatter from record to record make a slope of either sign in each."""
    random, r = np.random.default_rng(5), problem.recording
    gains = np.resize([0.02, -0.02], len(r.names))
    d = 0.02 * r.force
    e = 0.3 * random.standard_normal(len(r)) + np.repeat(gains, np.diff(r.starts)) * r.force
    found = energy_test(problem, e, e - d)
    assert not found.significant
    assert abs(found.records.t) < thresholds.T_PLACES


def test_no_difference_is_no_gain(problem: Problem) -> None:
    e = np.random.default_rng(6).standard_normal(len(problem.recording))
    assert not energy_test(problem, e, e).significant
    assert energy_test(problem, e, e).z == 0.0


def test_the_best_of_many_must_show_more() -> None:
    """Alike candidates count as one; independent ones as the maximum of as many normal values."""
    from scipy.stats import norm

    random = np.random.default_rng(7)
    one = random.standard_normal((1, 400))
    alone = critical_value(one)
    assert alone == pytest.approx(norm.isf(thresholds.FALSE_ALARMS), rel=0.1)
    assert critical_value(np.repeat(one, 300, axis=0)) == pytest.approx(alone, rel=1e-9)
    few, many = (critical_value(random.standard_normal((m, 400))) for m in (30, 300))
    assert few == pytest.approx(norm.isf(thresholds.FALSE_ALARMS / 30), rel=0.08)
    assert many == pytest.approx(norm.isf(thresholds.FALSE_ALARMS / 300), rel=0.08)


@pytest.mark.parametrize(("elsewhere", "significant"), [(-0.4, False), (2.5, True)])
def test_a_gain_in_some_places_must_not_cost_the_others(
    elsewhere: float, significant: bool
) -> None:
    """Large where it is, but most stretches get worse: it stands in for something else."""
    energy = EnergyTest(lambda: 13.6, 1.0, Clusters(6.0, 16.5), Clusters(3.4, 6.2))
    found = Comparison(0.16, elsewhere, 0.0, energy, 0.009, 297.5, 248.5, 0.84, 0.29, 0.2)
    assert found.significant is significant


@pytest.mark.parametrize(("settling", "significant"), [(0.9, True), (1.5, True), (2.5, False)])
def test_a_model_must_not_pay_where_no_fit_weighs(settling: float, significant: bool) -> None:
    """A fading viscosity of 1.7e6 N s/m gained 25 % and missed 1,800 N where records settled."""
    energy = EnergyTest(lambda: 13.6, 1.0, Clusters(6.0, 16.5), Clusters(3.4, 6.2))
    found = Comparison(0.25, 4.0, 4.3, energy, 0.009, 79.3, 48.7, settling, 0.29, 0.2)
    assert found.significant is significant


@pytest.mark.parametrize(("places", "alike"), [(1.1, True), (8.0, False)])
def test_what_happened_in_a_single_place_settles_no_name(places: float, alike: bool) -> None:
    """Which force a fault of 3 % takes was settled by one group of 24, of a gain of 0.8 %."""
    energy = EnergyTest(lambda: 14.5, 0.53, Clusters(4.4, places), Clusters(6.1, places))
    found = Comparison(0.008, -0.48, -0.48, energy, 0.002, 0.1497, 0.1485, 1.0, 0.29, 0.0064)
    assert found.tied is alike


@pytest.mark.parametrize(
    ("few", "z", "alike"), [(True, 3.0, True), (True, 9.0, False), (False, 3.0, False)]
)
def test_a_record_or_two_show_no_long_memory_of_noise(few: bool, z: float, alike: bool) -> None:
    """In one record of pink noise a drift of the channel had the name alone, z 3.01 before a gas
    that warms up, which it was."""
    energy = EnergyTest(lambda: z, 0.5, Clusters(2.0, 8.0), Clusters(0.0, 1.0))
    found = Comparison(0.09, 1.28, 1.28, energy, 0.004, 0.186, 0.169, 1.0, 0.29, 0.06, few)
    assert found.tied is alike

"""The table of forces against what `simulate` gives, and its errors against a trial."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from dampers import damper
from rig import TRUTH

from erdctl.bench.dyno import peak_force
from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Recording
from erdctl.effects import catalogue
from erdctl.export.damper_alone import damper_alone, of_the_bench, set_in
from erdctl.export.tables.grid import Asked, grid
from erdctl.export.tables.peak_map import PeakMap, peak_map, sines, standard_errors
from erdctl.io.documents import encode, plain
from erdctl.io.parameters import parse_parameters, to_document
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.simulate import simulate


def table(parameters: Parameters, **asked: Any) -> PeakMap:
    given = {"points": 5, **asked}
    return peak_map(parameters, grid(parameters, Asked(**given)))


def sine(speed: float, duty: float, amplitude: float, cycles: int, fs: int) -> Recording:
    """A sine made here, whose sampling has nothing to do with the table's."""
    w = speed / amplitude
    t = np.arange(round(cycles * 2 * math.pi / w * fs)) / fs
    return Recording(
        t=t, x=amplitude * np.sin(w * t), xdot=speed * np.cos(w * t),
        duty=np.full(len(t), duty), starts=np.array([0, len(t)]), names=("",),
    )  # fmt: skip


@pytest.mark.parametrize(
    "effects",
    [(), ("coulomb_friction", "preyield_viscosity"), ("mount_compliance",), ("signed_yield_lag",)],
    ids=str,
)
def test_the_map_is_what_simulate_gives_at_the_peaks_of_steady_sines(
    effects: tuple[str, ...],
) -> None:
    p = damper(*effects)
    found = table(p, duty=(0.0, 0.25))
    size = np.ptp(found.force)
    for i, v in enumerate(found.grid.speed.tolist()):
        for j, duty in enumerate((0.0, 0.25)):
            if abs(v) < 0.01:
                continue  # cycles of half a minute
            r = sine(abs(v), duty, found.grid.amplitude, 12, 4000)
            force = simulate(p, r)
            half = len(r) // 2
            peak = half + int(np.argmax(np.sign(v) * r.xdot[half:]))
            assert found.force[i, j] == pytest.approx(force[peak], abs=2e-3 * size)


def test_the_dyno_curve_of_a_recorded_sine_is_the_map_to_its_own_width() -> None:
    """`bench.dyno` takes the mean within 3 % of the peak, which is lower by 1 % on a sine."""
    p = damper()
    found = table(p, duty=(0.2,))
    r = sine(0.15, 0.2, found.grid.amplitude, 8, 2000)
    peaks = peak_force(r, simulate(p, r))
    for way in (-1.0, 1.0):
        dyno = peaks.force[np.sign(peaks.velocity) == way].mean()
        assert dyno == pytest.approx(found.at(np.array([way * 0.15]), np.zeros(1))[0], rel=0.015)


def test_without_lag_the_map_is_the_static_model() -> None:
    """Eq. 9 by hand: gas is 0 at mid-stroke, the rest is c_vis v + sigma u^beta sign(v)."""
    p = damper()
    still = {f"{d}.T_d": replace(p.estimates[f"{d}.T_d"], value=0.0)
             for d in ("compression", "release")}  # fmt: skip
    found = table(replace(p, estimates={**p.estimates, **still}))
    for i, v in enumerate(found.grid.speed.tolist()):
        d = "compression" if v > 0 else "release"
        c, sigma, beta = (TRUTH[f"{d}.{s}"] for s in ("c_vis", "sigma", "beta"))
        expected = c * v + math.copysign(1.0, v) * sigma * found.grid.duty**beta
        assert found.force[i] == pytest.approx(expected, abs=1e-9)


def test_speeds_and_duties_are_those_that_were_seen() -> None:
    g = grid(damper(), Asked())
    assert (g.speed[0], g.speed[-1]) == (-0.15, 0.2)
    assert len(g.speed) == 40
    assert 0.0 not in g.speed
    assert (np.diff(g.speed) > 0).all()
    assert (g.duty[0], g.duty[-1], len(g.duty)) == (0.0, 0.4, 11)
    assert (g.centre, g.amplitude) == (0.0, 0.01)
    assert g.remarks == ()
    far = grid(damper(), Asked(speed=0.5, duty=(0.9,), amplitude=0.05))
    assert ["identified on" in r for r in far.remarks] == [True] * 3
    unknown = grid(damper(ranges=None), Asked())
    assert ["do not say which" in r for r in unknown.remarks] == [True] * 3
    assert "sines of the table have 0.01 m; --amplitude gives another" in unknown.remarks[2]
    assert len(grid(damper(ranges=None), Asked(amplitude=0.005)).remarks) == 2
    # A rod that never was at x = 0.
    off = grid(damper(ranges={"x": [0.01, 0.03]}), Asked())
    assert (off.centre, off.amplitude) == pytest.approx((0.02, 0.005))
    # One duty, one direction, no stroke: what can be said is.
    assert grid(damper(ranges={"duty": [0.2, 0.2]}), Asked()).duty.tolist() == [0.2]
    assert grid(damper(ranges={"xdot": [0.0, 0.1]}), Asked()).speed[0] == -0.2
    still = grid(damper(ranges={"x": [0.0, 0.0]}), Asked())
    assert still.amplitude > 0
    assert "do not say which stroke" in still.remarks[-1]
    # What no damper can have had is no range.
    for wrong in ({"duty": [0.0, 40.0]}, {"duty": [0.4, 0.1]}, {"xdot": [-1e300, 1e300]}):
        odd = grid(damper(ranges=wrong), Asked())
        assert odd.duty[-1] == 0.45
        assert odd.speed[-1] == 0.2


def test_errors_are_those_of_a_thousand_dampers() -> None:
    p = damper("coulomb_friction", errors=0.02)
    found = table(p, points=3, duty=(0.0, 0.3))
    random = np.random.default_rng(7)
    trials = []
    for _ in range(300):
        drawn = {
            name: Estimate(value=e.value + random.normal() * (e.stderr or 0.0), unit=e.unit)
            for name, e in p.estimates.items() if e.value is not None
        }  # fmt: skip
        trials.append(table(replace(p, estimates=drawn), points=3, duty=(0.0, 0.3)).force)
    # 300 trials tell a standard deviation to 4 %.
    assert found.stderr == pytest.approx(np.std(trials, axis=0), rel=0.15)


def test_a_parameter_without_error_is_exact_and_said() -> None:
    p = damper(errors=0.01)
    e = p.estimates["compression.sigma"]
    bare = replace(p, estimates={**p.estimates, "compression.sigma": replace(e, stderr=None)})
    interval = replace(e, stderr=None, within=(e.used - 1.96 * 0.1, e.used + 1.96 * 0.1))
    assert table(bare, points=2, duty=(0.3,)).exact == ("compression.sigma",)
    skew = replace(p, estimates={**p.estimates, "compression.sigma": interval})
    assert standard_errors(skew)["compression.sigma"] == pytest.approx(0.1)
    none = table(damper(), points=2, duty=(0.3,))
    assert np.isnan(none.stderr).all()
    assert len(none.exact) == 10


def test_an_error_larger_than_the_way_to_a_bound_counts_whole() -> None:
    """k_nom cannot be below 0; sigma = 1 N with an error of 3 N has its slope, and no less."""
    p = damper()
    changed = {"compression.sigma": Estimate(value=1.0, unit="N", stderr=3.0)}
    found = table(replace(p, estimates={**p.estimates, **changed}), points=2, duty=(0.3,))
    expected = 3.0 * 0.3 ** TRUTH["compression.beta"]
    assert found.stderr[-1, 0] == pytest.approx(expected, rel=0.2)  # the lag shares it out
    assert found.stderr[2, 0] == pytest.approx(expected, rel=1e-3)  # slow: no lag


@pytest.mark.parametrize("effect", catalogue(), ids=lambda e: e.name)
def test_every_effect_has_a_table_or_is_left_out(effect: Any) -> None:
    name = effect.name
    damped, left_out = damper_alone(damper(name))
    assert [e.name for e in left_out] == ([name] if of_the_bench(effect) else [])
    found = table(set_in(damped), points=3, duty=(0.0, 0.3))
    assert np.isfinite(found.force).all()
    if left_out:
        assert (found.force == table(damper(), points=3, duty=(0.0, 0.3)).force).all()


def test_a_fault_has_set_in() -> None:
    """A table knows no time: the sines would be healthy or faulty by how long they last."""
    late = set_in(damper("oil_leakage", f=0.5, t_0=10.0))
    assert table(late).force == pytest.approx(0.5 * table(damper()).force, rel=1e-9)


def test_the_sines_are_sampled_finely_enough() -> None:
    p = damper("mount_compliance")
    g = grid(p, Asked(points=3, duty=(0.3,)))
    coarse = table(p, points=3, duty=(0.3,)).force[:, 0]
    for v, force in zip(g.speed.tolist()[-2:], coarse.tolist()[-2:], strict=True):
        fine = sine(v, 0.3, g.amplitude, 6, round(4000 * v / (2 * math.pi * g.amplitude)))
        peak = np.flatnonzero(np.isclose(fine.xdot, v, rtol=1e-7))[-1]
        assert force == pytest.approx(simulate(p, fine)[peak], rel=1e-3)


def test_a_long_lag_makes_a_long_sine_but_no_endless_one() -> None:
    g = grid(damper(), Asked(points=2, duty=(0.3,)))
    short, long, endless = (len(sines(0.1, g, lag)[0]) for lag in (0.1, 5.0, 1e6))
    assert short == 3 * 400 + 1
    assert long == pytest.approx(5.0 / (2 * math.pi * 0.01 / 0.1) * 400, rel=0.3)
    assert endless == 60 * 400 + 1


def test_a_law_of_temperature_wants_one() -> None:
    document = to_document(damper())
    law = {
        "slot": "viscous", "coordinates": [{"name": "temperature"}], "form": "line",
        "knots": [0.0, 50.0],
    }  # fmt: skip
    sizes = {"a": {"value": -0.5, "unit": "1"}}
    warm = {**plain(document), "effects": [{"effect": "learned", "law": law, "parameters": sizes}]}
    p = parse_parameters(encode(warm), "warm.json")
    with pytest.raises(UsageProblem, match="--temperature"):
        grid(p, Asked())
    cold, hot = (table(p, temperature=t, duty=(0.0,)).force[:, 0] for t in (0.0, 40.0))
    assert np.abs(hot) == pytest.approx(np.abs(cold) * hot[0] / cold[0], rel=1e-6)
    assert 0.0 < hot[0] / cold[0] < 1.0
    assert grid(damper(), Asked(temperature=20.0)).temperature is None

"""Limits and closed solutions that the physics must meet."""

from __future__ import annotations

import math

import numpy as np
import pytest
from plant_rig import DAMPER, RATE, constant, over, plain, record, rms, samples, sine

from erdctl.plant import DutyProgramme, Plant, Side, simulate
from erdctl.plant.simulate import forces, ride

F, A = 1.25, 0.01  # Hz, m
OMEGA = 2 * math.pi * F
DASHPOT = Plant(*[Side(k_nom=0.0, c_vis=200.0, T_d=0.02, sigma=0.0, beta=1.0)] * 2)
SPRING = Plant(*[Side(k_nom=1000.0, c_vis=0.0, T_d=0.02, sigma=0.0, beta=1.0)] * 2)
BINGHAM = Plant(*[Side(k_nom=0.0, c_vis=0.0, T_d=0.02, sigma=20.0, beta=1.0)] * 2)
TONE = record(sine(F, A), constant(0.0), seconds=6.0)


def phasor(force: np.ndarray) -> complex:
    """Amplitude and phase of the tone against the deflection, over its last four periods."""
    n = round(4 / F * RATE)
    t = np.arange(len(force))[-n:] / RATE
    return complex(2 * np.mean(force[-n:] * np.exp(-1j * (OMEGA * t + 0.3))) * 1j)


@pytest.mark.parametrize("field", ["mount", "fluid_spring"])
@pytest.mark.parametrize("s", [1e-6, 1e-4, 2e-3])
def test_dashpot_and_spring_in_series_are_maxwells_element(field: str, s: float) -> None:
    """F = i w c / (1 + i w c s) x."""
    got = phasor(simulate(DASHPOT.with_physics(**{field: s}), TONE))
    expected = A * 1j * OMEGA * 200.0 / (1 + 1j * OMEGA * 200.0 * s)
    assert got == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("c_m", [30.0, 1000.0])
@pytest.mark.parametrize("s", [1e-6, 1e-4, 2e-3])
def test_a_damped_mount_is_kelvins_and_voigts(s: float, c_m: float) -> None:
    """F = i w c K / (i w c + K) x, with K = 1 / s + i w c_m."""
    got = phasor(simulate(DASHPOT.with_physics(mount=s, film=c_m), TONE))
    dashpot, joint = 1j * OMEGA * 200.0, 1 / s + 1j * OMEGA * c_m
    assert got == pytest.approx(A * dashpot * joint / (dashpot + joint), rel=5e-3)


def test_what_fills_the_play_resists_while_it_is_crossed() -> None:
    """Of a piston that rests: c times the speed of the rod."""
    c, g = 100.0, 1e-3
    plant = BINGHAM.with_physics(mount=1e-6, gap=g, film=c)
    campaign = record(sine(F, A), constant(1.0))
    force = simulate(plant, campaign)
    _, x, v = ride(campaign).sampled()
    turn = int(np.argmax(x[: round(RATE / F)]))
    after = np.arange(turn, turn + round(0.3 * RATE / F))
    inside = after[(x[turn] - x[after] > 0.1 * g) & (x[turn] - x[after] < 0.9 * g)]
    assert len(inside) > 3
    np.testing.assert_allclose(force[inside], c * v[inside], rtol=1e-3, atol=1e-3)


def test_spring_and_mount_in_series_add_their_compliances() -> None:
    got = phasor(simulate(SPRING.with_physics(mount=1e-3), TONE))
    assert got == pytest.approx(A * 500.0, rel=5e-3)


def test_a_mount_behind_a_mass_resonates() -> None:
    """F = -w^2 m / (1 - w^2 m s) x, once a little damping has taken the start away."""
    m, c, s = 2.0, 20.0, 1e-3
    plant = Plant(*[Side(0.0, c, 0.02, 0.0, 1.0)] * 2).with_physics(mount=s, mass=m)
    got = phasor(simulate(plant, TONE))
    load = -(OMEGA**2) * m + 1j * OMEGA * c
    assert got == pytest.approx(A * load / (1 + load * s), rel=0.02)


def test_inertia_is_mass_times_acceleration() -> None:
    bare = Plant(*[Side(0.0, 0.0, 0.02, 0.0, 1.0)] * 2).with_physics(mass=3.0)
    assert phasor(simulate(bare, TONE)) == pytest.approx(-A * 3.0 * OMEGA**2, rel=1e-6)


def test_an_infinitely_stiff_mount_is_none() -> None:
    rigid = forces(DAMPER.with_physics(mount=1e-12), over())
    apart = np.abs(rigid - plain())
    # but for the sample in whose fine step the piston turns
    assert np.quantile(apart, 0.985) < 2e-3 * np.ptp(plain())


def test_mount_and_fluid_column_are_one_where_only_the_fluid_resists() -> None:
    fluid_only = Plant(*(s._replace(k_nom=0.0) for s in DAMPER[:2]))
    a = forces(fluid_only.with_physics(mount=2e-5), over())
    b = forces(fluid_only.with_physics(fluid_spring=2e-5), over())
    assert rms(a - b) < 1e-3 * rms(a)


def test_behind_a_mount_the_yield_force_holds_the_piston_at_reversals() -> None:
    """The force then follows the mount: dF/dx = 1/s until it reaches the other limit."""
    s = 1e-4
    force = simulate(BINGHAM.with_physics(mount=s), record(sine(F, A), constant(1.0)))
    _, x, _ = ride(record(sine(F, A), constant(1.0))).sampled()
    rising = (np.abs(force) < 19.0) & (np.arange(len(x)) > 5)
    slope = np.diff(force)[rising[1:] & rising[:-1]] / np.diff(x)[rising[1:] & rising[:-1]]
    np.testing.assert_allclose(slope, 1 / s, rtol=0.02)
    assert np.abs(force).max() == pytest.approx(20.0, rel=1e-6)


@pytest.mark.parametrize("s", [1e-6, 1e-4])
def test_the_play_of_a_mounts_joint_is_crossed_without_force(s: float) -> None:
    """After a turn the mount unloads over 20 s, then g without force, then it loads over 20 s."""
    g = 3e-3
    force = simulate(BINGHAM.with_physics(mount=s, gap=g), record(sine(F, A), constant(1.0)))
    _, x, _ = ride(record(sine(F, A), constant(1.0))).sampled()
    free = np.abs(force) < 1e-6
    begins, ends = (np.flatnonzero(np.diff(free.astype(int)) == way)[1:-1] for way in (1, -1))
    ends = ends[ends > begins[0]]
    assert len(ends) > 6
    crossed = np.abs(x[ends] - x[begins[: len(ends)]])
    per_sample = OMEGA * A / RATE
    np.testing.assert_allclose(crossed, g, atol=1.5 * per_sample)
    assert np.abs(force).max() == pytest.approx(20.0, rel=1e-6)


def test_play_is_lost_motion() -> None:
    """A spring behind a gap follows x - g/2 upward and x + g/2 downward."""
    g = 0.004
    r = record(sine(F, A), constant(0.0))
    _, x, v = ride(r).sampled()
    force = simulate(SPRING.with_physics(gap=g), r)
    assert force.max() == pytest.approx(1000 * (A - g / 2), rel=1e-3)
    assert force.min() == pytest.approx(-1000 * (A - g / 2), rel=1e-3)
    late = np.arange(len(x)) > RATE / F
    follows = late & (np.abs(x) < A - g) & (v > 0) & (x > 0)
    np.testing.assert_allclose(force[follows], 1000 * (x[follows] - g / 2), rtol=1e-6)


def test_stops_push_only_beyond_their_limits() -> None:
    plant = DAMPER.with_physics(stop_high=0.008, stop_low=-0.01, stop_rate=1e4)
    x = samples().x
    extra = forces(plant, over()) - plain()
    expected = 1e4 * (np.maximum(x - 0.008, 0.0) + np.minimum(x + 0.01, 0.0))
    np.testing.assert_allclose(extra, expected, atol=1e-9)


def test_a_late_channel_is_the_force_of_before() -> None:
    k = 7
    late = simulate(DAMPER.with_channel(skew=k / RATE), TONE)
    np.testing.assert_allclose(late[k:], simulate(DAMPER, TONE)[:-k], atol=1e-9)
    early = simulate(DAMPER.with_channel(skew=-k / RATE), TONE)
    np.testing.assert_allclose(early[:-k], simulate(DAMPER, TONE)[k:], atol=1e-9)


def test_dead_time_shifts_the_field_and_not_the_flow() -> None:
    k = 20
    up_only = sine(0.1, 0.02, -0.8)
    steps = DutyProgramme((0.1, 0.5, 0.2), (0, 100, 300))
    late = DutyProgramme((0.1, 0.5, 0.2), (0, 100 + k, 300 + k))
    r = record(up_only, steps, seconds=2.0)
    a = simulate(DAMPER.with_physics(dead_time=k / RATE), r)
    np.testing.assert_allclose(a, simulate(DAMPER, record(up_only, late, seconds=2.0)), atol=1e-9)


def test_a_slow_supply_ramps_the_field() -> None:
    """Without lag the yield force of beta = 1 follows the ramp of the voltage."""
    fast = Plant(*[Side(0.0, 0.0, 1e-9, 20.0, 1.0)] * 2).with_physics(slew=1.0)
    r = record(sine(0.1, 0.02, -0.8), DutyProgramme((0.0, 0.5), (0, 100)), seconds=2.0)
    force = simulate(fast, r)
    t = np.arange(len(force)) / RATE
    np.testing.assert_allclose(force, 20 * np.clip(t - 100 / RATE, 0.0, 0.5), atol=0.01)


def test_rising_and_falling_field() -> None:
    plant = BINGHAM.with_physics(rise=3.0, decay=0.5)
    r = record(sine(0.1, 0.02, -0.8), DutyProgramme((0.0, 1.0, 0.0), (0, 50, 250)), seconds=2.0)
    force = simulate(plant, r)
    assert force[50 + 15] == pytest.approx(20 * (1 - math.exp(-0.06 / 0.06)), rel=1e-6)
    assert force[250 + 5] == pytest.approx(force[250] * math.exp(-0.02 / 0.01), rel=1e-6)


def test_threshold_and_saturation() -> None:
    still = sine(0.1, 0.02, -0.8)

    def level(plant: Plant, duty: float) -> float:
        return float(simulate(plant, record(still, constant(duty), seconds=1.0))[100])

    cut = BINGHAM.with_physics(threshold=0.2)
    assert level(cut, 0.15) == 0.0
    assert level(cut, 0.5) == pytest.approx(20 * 0.3)
    full = BINGHAM.with_physics(screening=2.0)
    assert level(full, 1.0) == pytest.approx(10 * math.tanh(2.0))
    assert level(full, 0.01) == pytest.approx(0.2, rel=1e-3)


def test_signed_lag_rebuilds_after_a_reversal() -> None:
    r = record(sine(F, A, math.pi / 2 + 1e-9), constant(1.0))
    force = simulate(BINGHAM.with_physics(signed=1.0), r)
    # The rod turned at t = 0; by then the force stands at its steady value of release.
    t = np.arange(20) / RATE
    np.testing.assert_allclose(force[1:20], -20.0, rtol=1e-6)
    half = round(RATE / (2 * F))  # between two samples the rod turns again
    turned = half / RATE - 1 / (2 * F)
    expected = 20 - 40 * np.exp(-(t[1:] + turned) / 0.02)
    np.testing.assert_allclose(force[half + 1 : half + 20], expected, atol=0.02)


def test_smooth_sign_laws() -> None:
    r = record(sine(F, A), constant(1.0))
    _, x, v = ride(r).sampled()
    smooth = simulate(BINGHAM.with_physics(v_y=0.02), r)
    np.testing.assert_allclose(smooth, 20 * np.tanh(v / 0.02), atol=1e-9)
    loop = simulate(BINGHAM.with_physics(v_y=0.02, lead=8.0), r)
    np.testing.assert_allclose(loop, 20 * np.tanh((v + 8.0 * x) / 0.02), atol=1e-9)
    hard = simulate(BINGHAM.with_physics(v_y=1e-9), r)
    np.testing.assert_allclose(hard, simulate(BINGHAM, r), atol=1e-9)


def test_viscous_laws() -> None:
    _, x, v = ride(TONE).sampled()
    thin = simulate(DASHPOT.with_physics(flow_index=0.5, v_ref=0.1), TONE)
    np.testing.assert_allclose(thin, 20 * np.sqrt(np.abs(v) / 0.1) * np.sign(v), atol=1e-9)
    rough = simulate(DASHPOT.with_physics(turbulent=300.0), TONE)
    np.testing.assert_allclose(rough, 200 * v + 300 * v * np.abs(v), atol=1e-9)
    tapered = simulate(DASHPOT.with_physics(taper=30.0, groove=1e3), TONE)
    np.testing.assert_allclose(tapered, 200 * v * (1 + 30 * x + 1e3 * x * x), atol=1e-9)


def test_dahl_goes_over_into_coulomb() -> None:
    coulomb = forces(DAMPER.with_physics(F_c=5.0), over())
    dahl = forces(DAMPER.with_physics(F_p=5.0, x_p=1e-9), over())
    assert np.quantile(np.abs(coulomb - dahl), 0.985) < 1e-6  # all but reversals
    wide = forces(DAMPER.with_physics(F_p=5.0, x_p=0.004), over())
    assert rms(wide - coulomb) > 0.2 * rms(coulomb - plain())


def test_stribeck_goes_over_into_coulomb() -> None:
    coulomb = forces(DAMPER.with_physics(F_c=5.0), over())
    flat = forces(DAMPER.with_physics(F_s=5.0, F_k=5.0, v_s=0.05), over())
    np.testing.assert_allclose(flat, coulomb, atol=1e-9)
    falling = forces(DAMPER.with_physics(F_s=5.0, F_k=2.0, v_s=0.01), over())
    fast = np.abs(samples().v) > 0.05
    np.testing.assert_allclose(
        (falling - plain())[fast], 2.0 * np.sign(samples().v[fast]), atol=1e-6
    )


def test_gas_laws() -> None:
    _, x, _ = ride(TONE).sampled()
    eq_3 = simulate(SPRING.with_physics(closing=1 / 0.03, polytropic=1.3), TONE)
    expected = 1000 * 0.03 / 1.3 * ((1 - x / 0.03) ** -1.3 - 1)
    np.testing.assert_allclose(eq_3, expected, rtol=1e-9, atol=1e-9)
    soft = simulate(SPRING.with_physics(closing=1e-6), TONE)
    np.testing.assert_allclose(soft, 1000 * x, atol=1e-4)
    assert simulate(SPRING.with_physics(preload=40.0), TONE)[3] == pytest.approx(1000 * x[3] + 40)


def test_heat_is_the_work_done() -> None:
    """Without cooling c = c_0 exp(-g W / C), W the work; so that W g / C = ln(1 + g W_0 / C)."""
    heating, thin = 0.5, 0.02
    plant = DASHPOT.with_physics(heating=heating, thin=thin)
    force = simulate(plant, TONE)
    _, _, v = ride(TONE).sampled()
    cold = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] ** 2 + v[:-1] ** 2)) / RATE]) * 200
    fast = np.abs(v) > 0.02
    expected = 200 * v / (1 + thin * heating * cold)
    np.testing.assert_allclose(force[fast], expected[fast], rtol=2e-3)
    assert expected[fast][-1] / (200 * v[fast][-1]) < 0.98


def test_cavitation_takes_release_force_until_the_void_is_closed() -> None:
    """A void of 4 mm, of which a stroke of 2 A in compression leaves 4 mm (1 - exp(-2 A / 4 mm)),
    and gas in it at p V = const: half of the force is back where 0.4 mm are left."""
    plant = BINGHAM.with_physics(void=0.004, bubbles=0.1)
    r = record(sine(F, A), constant(1.0))
    _, x, v = ride(r).sampled()
    force = simulate(plant, r)
    assert (force[v > 0.005] == 20.0).all()
    late = (np.arange(len(x)) > RATE / F) & (v < -0.001)
    formed = 0.004 * (1 - np.exp(-2 * A / 0.004))
    left = np.maximum(formed - (x.max() - x), 0.0)
    np.testing.assert_allclose(force[late], -20 * 4e-4 / (4e-4 + left[late]), rtol=0.05)


def test_faults_are_the_papers_factors() -> None:
    """Eqs. 20, 22, 23: from the onset on, in every record's own time."""
    parts = {}
    for name, sides in (
        ("gas", [s._replace(c_vis=0.0, sigma=0.0) for s in DAMPER[:2]]),
        ("viscous", [s._replace(k_nom=0.0, sigma=0.0) for s in DAMPER[:2]]),
        ("yielding", [s._replace(k_nom=0.0, c_vis=0.0) for s in DAMPER[:2]]),
    ):
        parts[name] = forces(Plant(*sides), over())
    n = over()[0].record.samples
    after = np.tile(np.arange(n) / RATE >= 1.5, len(over()))
    for fault, hit in (
        ("oil", ("gas", "viscous", "yielding")),
        ("electrical", ("yielding",)),
        ("deformation", ("viscous", "yielding")),
    ):
        force = forces(DAMPER.with_physics(onset=1.5, **{fault: 0.6}), over())
        expected = sum(p * np.where(after & (name in hit), 0.6, 1.0) for name, p in parts.items())
        np.testing.assert_allclose(force, expected, atol=1e-9)
        come = np.clip((np.tile(np.arange(n) / RATE, len(over())) - 1.5) / 0.8, 0.0, 1.0)
        force = forces(DAMPER.with_physics(onset=1.5, ramp=0.8, **{fault: 0.6}), over())
        expected = sum(p * (1.0 - 0.4 * come * (name in hit)) for name, p in parts.items())
        np.testing.assert_allclose(force, expected, atol=1e-9)


def test_drift_clipping_and_steps_of_the_channel() -> None:
    drifting = simulate(DAMPER.with_channel(drift=0.3), TONE)
    t = np.arange(len(drifting)) / RATE
    np.testing.assert_allclose(drifting - simulate(DAMPER, TONE), 0.3 * t, atol=1e-9)
    clipped = simulate(DAMPER.with_channel(clip_high=4.0, clip_low=-3.0, step=0.5), TONE)
    assert clipped.max() <= 4.0
    assert clipped.min() >= -3.0
    np.testing.assert_allclose(clipped / 0.5, np.round(clipped / 0.5), atol=1e-9)


def test_a_stiff_load_cell_does_not_ring() -> None:
    force = simulate(SPRING.with_channel(ring_rate=400.0, ring_damping=0.7), TONE)
    assert rms(force - simulate(SPRING, TONE)) < 0.01 * rms(force)


def test_two_springs_in_series_are_refused() -> None:
    with pytest.raises(ValueError, match="one spring"):
        simulate(DAMPER.with_physics(mount=1e-5, fluid_spring=1e-5), TONE)
    with pytest.raises(ValueError, match="soft mount"):
        simulate(DAMPER.with_physics(mount=1e-5).with_outside(memory=1.0), TONE)

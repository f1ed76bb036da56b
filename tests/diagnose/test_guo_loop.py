"""The lab's own later finding: what its 2019 model of the same dampers has and that of 2016 lacks.

    F = k_0 x + c_0 xdot + F_er,   tau dF_er/dt + F_er = f_c duty tanh(k_1 x + c_1 xdot)

Source: T.-P. Pham, O. Sename, L. Dugard, Comparative study of three semi-active dampers (2019).
The data come from the few lines below and share no code with erdctl's model.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from rig import noisy
from scipy.signal import lfilter

from erdctl.core.recording import Array, Recording, concatenate
from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.findings import Finding
from erdctl.effects import catalogue
from erdctl.score.nrmse import nrmse

K_0, C_0 = 170.4, 68.83  # N/m, N s/m
K_1, C_1 = 218.0, 21.0  # 1/m, s/m
F_C, TAU = 28.0, 0.043  # N at full duty, s
FINE, EVERY = 20_000, 40  # Hz of the integration; one sample in so many is logged
LEAD_IN, DURATION = 1.0, 8.0  # s; a record begins with the damper in motion
NOISE = 0.3  # N


@dataclass(frozen=True)
class Ride:
    """Sines (frequency [Hz], amplitude [m]) under duty levels that follow each other."""

    name: str
    tones: tuple[tuple[float, float], ...]
    duty: tuple[float, ...]


MIXED = ((0.6, 0.009), (1.7, 0.005), (3.9, 0.002))
CAMPAIGN = (
    Ride("null", ((1.0, 0.015),), (0.0,)),
    Ride("slow", ((0.5, 0.020),), (0.2,)),
    Ride("slow-strong", ((0.7, 0.018),), (0.5,)),
    Ride("middle", ((1.5, 0.015),), (0.1,)),
    Ride("middle-strong", ((2.0, 0.012),), (0.4,)),
    Ride("fast", ((4.0, 0.010),), (0.3,)),
    Ride("fastest", ((6.0, 0.010),), (0.2,)),
    Ride("steps", ((1.2, 0.015),), (0.0, 0.3, 0.1, 0.5, 0.2, 0.4, 0.0, 0.5)),
    Ride("mixed", MIXED, (0.3,)),
    Ride("mixed-steps", MIXED, (0.1, 0.4, 0.0, 0.2, 0.5, 0.1, 0.3)),
)
FRESH = (
    Ride("fresh-sine", ((2.7, 0.012),), (0.15, 0.45, 0.3)),
    Ride("fresh-mixed", ((0.9, 0.008), (2.2, 0.004), (5.1, 0.001)), (0.35, 0.05, 0.25, 0.5)),
)


def recording(ride: Ride) -> Recording:
    """One record without noise, by the trapezoidal rule at the fine step."""
    n = round((LEAD_IN + DURATION) * FINE)
    t = np.arange(n) / FINE - LEAD_IN
    x, xdot = np.zeros((2, n))
    for i, (frequency, amplitude) in enumerate(ride.tones):
        w = 2 * np.pi * frequency
        x += amplitude * np.sin(w * t + 0.9 * i)
        xdot += amplitude * w * np.cos(w * t + 0.9 * i)
    part = np.clip(t / DURATION, 0.0, 1.0 - 1e-9)
    duty = np.array(ride.duty)[(part * len(ride.duty)).astype(int)]
    # A duty holds from its sample to the next, so it takes the logged sample's value.
    duty = np.repeat(duty[::EVERY], EVERY)
    return _logged(ride.name, t, x, xdot, duty, K_0 * x + C_0 * xdot + _yield(x, xdot, duty))


def _yield(x: Array, xdot: Array, duty: Array) -> Array:
    """(n,) F_er [N]; the duty is held over a step, the loop is a straight line."""
    loop = np.tanh(K_1 * x + C_1 * xdot)
    source = 0.5 * F_C * duty[:-1] * (loop[:-1] + loop[1:])
    a = 1.0 / (FINE * TAU)
    force, _ = lfilter([a / (1 + a / 2)], [1.0, -(1 - a / 2) / (1 + a / 2)], source, zi=[0.0])
    return np.concatenate([[0.0], force])


def _logged(name: str, t: Array, *channels: Array) -> Recording:
    first = round(LEAD_IN * FINE)
    t, x, xdot, duty, force = (c[first::EVERY].copy() for c in (t, *channels))
    starts = np.array([0, len(t)], dtype=np.intp)
    return Recording(t=t, x=x, xdot=xdot, duty=duty, force=force, starts=starts, names=(name,))


@cache
def clean(rides: tuple[Ride, ...]) -> Recording:
    return concatenate([recording(ride) for ride in rides])


def names(finding: Finding) -> set[str]:
    return {finding.effect.name, *finding.equivalent}


@pytest.mark.long
@pytest.mark.parametrize("correlation", [0.9], ids=["coloured"])
def test_what_the_earlier_paper_left_out(correlation: float) -> None:
    """One test, as under xdist every process with one of several would repeat the diagnosis."""
    log = noisy(clean(CAMPAIGN), seed=19, rms=NOISE, correlation=correlation)
    found = diagnose(log, catalogue(), limits=False)
    both_are_found_and_nothing_else(found)
    their_parameters_are_the_labs(found)
    the_corrected_model_predicts_fresh_records(found)


def both_are_found_and_nothing_else(found: Diagnosis) -> None:
    for f in found.findings:
        print(f.effect.name, f.equivalent, f.gain, f.before, f.after)
    assert found.verdict is Verdict.EXPLAINED
    assert len(found.findings) == 2
    for wanted in ("yield_hysteresis", "signed_yield_lag"):
        assert any(wanted in names(f) for f in found.findings), wanted


def their_parameters_are_the_labs(found: Diagnosis) -> None:
    values = found.fit.values
    print({n: (v, found.fit.stderr.get(n)) for n, v in values.items()})
    assert values["signed_yield_lag.T_s"] == pytest.approx(TAU, rel=0.05)
    assert values["yield_hysteresis.v_y"] == pytest.approx(1 / C_1, rel=0.05)
    assert values["yield_hysteresis.kappa"] == pytest.approx(K_1 / C_1, rel=0.05)
    for direction in ("compression", "release"):
        assert values[f"{direction}.k_nom"] == pytest.approx(K_0, rel=0.05)
        assert values[f"{direction}.c_vis"] == pytest.approx(C_0, rel=0.05)
        assert values[f"{direction}.sigma"] == pytest.approx(F_C, rel=0.05)
        assert values[f"{direction}.beta"] == pytest.approx(1.0, rel=0.05)


def the_corrected_model_predicts_fresh_records(found: Diagnosis) -> None:
    fresh = clean(FRESH)
    assert fresh.force is not None
    signals, settled = Signals.of(fresh), fresh.t > 0.3
    missed = []
    for hypothesis in (found.selection.base, found.selection.best):
        predicted = hypothesis.model.force(signals, hypothesis.values)
        missed.append(nrmse(fresh.force[settled], predicted[settled]).nrmse)
    paper, corrected = missed
    print(f"NRMSE on fresh records: paper's model {paper:.4f}, corrected {corrected:.4f}")
    assert corrected < 0.005
    assert corrected < 0.1 * paper

"""A force channel that stops before its noise is told, and nothing is learned of what is there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.effects import get

TRIED = ("coulomb_friction", "shear_thinning", "field_saturation", "power_law_yield")


def stopped(above: float, below: float = 0.0, beside: float = 0.0) -> list[Recording]:
    """A log, and one whose channel stops before its noise for parts of the samples."""
    clean = campaign()
    assert clean.force is not None
    force = clean.force + beside * np.sign(clean.xdot)
    low, high = np.quantile(force, [below, 1.0 - above])
    forces = force, np.clip(force, low, high)
    return [noisy(replace(clean, force=f), seed=3, rms=0.4) for f in forces]


def found(r: Recording, accepted: tuple[str, ...] = ()) -> Diagnosis:
    tried = [get(n) for n in TRIED]
    return diagnose(r, tried, limits=False, learning=False, accepted=accepted)


def level(text: str) -> float:
    """Where the words say that the force stops [N]."""
    return float(text.split("stops at ")[1].split(" N")[0])


@pytest.mark.parametrize("above", [0.03, 0.07, pytest.param(0.15, marks=pytest.mark.long)])
def test_a_range_that_ends_is_no_physics(above: float) -> None:
    """It was `adequate` with 3 % of the samples at the end, and `unexplained` with 7."""
    whole, cut = stopped(above)
    d = found(cut)
    (fault,) = d.rig.faults
    assert fault.code == "force_clipped"
    at = float(np.quantile(campaign().force, 1.0 - above))
    assert level(fault.text) == pytest.approx(at, rel=0.01)
    assert (d.verdict, d.cannot_tell) == (Verdict.UNEXPLAINED, "a channel that stops at a limit")
    assert not d.findings
    clean = found(whole).fit.values
    for name in ("compression.c_vis", "compression.sigma", "compression.beta"):
        assert d.fit.values[name] == pytest.approx(clean[name], rel=0.02)


def test_both_ends() -> None:
    cut = stopped(0.05, 0.03)[1]
    d = found(cut)
    ends = np.quantile(campaign().force, [0.95, 0.03])
    assert [level(f.text) for f in d.rig.faults] == pytest.approx(ends.tolist(), rel=0.01)
    left = d.problem.recording.excluded
    assert left is not None
    assert 0.08 < np.mean(left) < 0.4


def test_what_else_the_damper_has_is_named_beside_it() -> None:
    d = found(stopped(0.1, beside=3.0)[1])
    assert [f.code for f in d.rig.faults] == ["force_clipped"]
    assert [f.effect.name for f in d.findings] == ["coulomb_friction"]
    assert d.fit.values["coulomb_friction.F_c"] == pytest.approx(3.0, rel=0.05)


def test_a_user_may_know_better() -> None:
    """A relief valve, say."""
    d = found(stopped(0.07)[1], accepted=("force_clipped",))
    assert not d.rig.faults
    assert d.verdict is Verdict.UNEXPLAINED


@pytest.mark.parametrize("law", ["none", "thin", "saturated", "one duty"])
def test_a_force_that_flattens_is_none(law: str) -> None:
    """Of what is viscous a part is left where the yield force saturates, and the other way round;
    of a single level nothing tells an end from a yield force that no speed adds to."""
    clean = campaign()
    force = np.asarray(clean.force).copy()
    c = np.where(clean.xdot > 0, TRUTH["compression.c_vis"], TRUTH["release.c_vis"])
    if law == "thin":
        force -= c * clean.xdot * (1.0 - 1.0 / (1.0 + np.abs(clean.xdot) / 0.01))
    if law == "saturated":
        rest = force - c * clean.xdot
        force = c * clean.xdot + np.clip(rest, -6.0, 6.0)
    r = noisy(replace(clean, force=force), seed=4, rms=0.4)
    if law == "one duty":
        r = replace(r, duty=np.full(len(r), 0.2), force=10.0 * np.sign(r.xdot))
        r = noisy(r, seed=4, rms=0.4)
    assert not [f for f in found(r).rig.faults if f.code == "force_clipped"]

"""Errors of a model whose piston sticks and slips behind a spring, and of one that does not."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rig import campaign, noisy

from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.record_effects import NONE_VARY
from erdctl.effects import get
from erdctl.estimate.covariance import Fit, estimates
from erdctl.estimate.finer import Finer
from erdctl.model.composed import Model


def fitted(v_s: float, c_vis: float) -> tuple[Fit, dict[str, float]]:
    """A fit of friction that falls with speed behind a mount, and what was simulated."""
    model = Model((get("mount_compliance"), get("stribeck_friction")))
    clean = campaign(200.0, 6.0)
    start = {name: q.start for name, q in model.quantities.items()}
    own = {"mount_compliance.s_m": 1e-5, "stribeck_friction.v_s": v_s}
    own |= {"stribeck_friction.F_k": 20.0, "stribeck_friction.F_sk": 30.0}
    true = {**start, **own, "compression.c_vis": c_vis, "release.c_vis": c_vis}
    true |= {f"{way}.sigma": 20.0 for way in ("compression", "release")}
    force = Finer.of(prepare(clean, NONE_VARY).block.signals).force(model, true)
    problem = prepare(noisy(replace(clean, force=force), 5, 0.3), NONE_VARY)
    return fit_errors(problem, fit_hypothesis(problem, model.effects, [true], 20))[0], true


def test_where_the_piston_slips_nothing_is_told() -> None:
    """Kinetic friction of a friction damper was told as 7150 +- 1.3 N."""
    found, _ = fitted(v_s=0.1, c_vis=10.0)
    assert found.jumps is not None
    told = estimates(found, {})
    for name in found.free:
        assert told[name].value is None
        assert told[name].assumed == found.values[name]
        assert "slips" in (told[name].reason or "")


@pytest.mark.long
def test_where_it_does_not_it_is() -> None:
    found, true = fitted(v_s=0.1, c_vis=600.0)
    assert found.jumps is None
    told = estimates(found, {})
    for name in ("mount_compliance.s_m", "stribeck_friction.F_k", "stribeck_friction.F_sk"):
        e = told[name]
        assert e.value is not None
        assert e.stderr is not None
        assert e.value == pytest.approx(true[name], abs=3.0 * e.stderr)

"""Effects that come together, beside those that were found: neither gains alone there."""

from __future__ import annotations

from pathlib import Path

import literature_dampers
import pytest
from rig import campaign, noisy

from erdctl.diagnose.companion_effects import companion_sets, joint_tasks
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.executor import executor
from erdctl.diagnose.forward_step import Exploration, Explored
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate.starts import fresh_start
from erdctl.io.logs import read_logs

CANDIDATES = (
    "force_smoothing", "preyield_viscosity", "preyield_elasticity", "power_law_yield",
    "shear_thinning", "backlash", "mount_compliance", "coulomb_friction",
    "preyield_field_dependence",
)  # fmt: skip
TOGETHER = {"power_law_yield", "shear_thinning"}


def test_one_fluid_has_both_laws() -> None:
    sets = [{e.name for e in found} for found in companion_sets([get(n) for n in CANDIDATES])]
    assert TOGETHER in sets


def test_no_more_together_than_a_model_may_have() -> None:
    """Nor what is there already."""
    problem = prepare(noisy(campaign(100.0, 4.0), seed=5))
    base, thinning = (
        fit_hypothesis(problem, [get(n) for n in names], [fresh_start(0.05, 0.4)])
        for names in ((), ("shear_thinning",))
    )
    with executor((problem,), 1, lambda stage, what: None) as here:
        x = Exploration(problem, base, Explored([base, thinning]), here)
    tried = [get(n) for n in CANDIDATES]
    for most in (1, 2, 3):
        tasks = joint_tasks(x, [base, thinning], tried, most)
        assert max((len(t.effects) for t in tasks), default=0) == (most if most > 1 else 0)
    names = [{e.name for e in t.effects} for t in tasks]
    assert names.count(TOGETHER) == 1
    assert {"shear_thinning", "preyield_viscosity", "mount_compliance"} in names


@pytest.mark.long
def test_what_has_a_part_without_the_field_is_found_together(tmp_path: Path) -> None:
    """Of Dahl's damper under sines, each with one duty, a friction without the field leaves 99 % of
    the mean square and a viscosity that grows with it 94 %; both leave half, the noise. The log was
    `explained` by `preyield_elasticity` alone, with a friction and a viscosity that were wrong."""
    file = tmp_path / "dahl.parquet"
    literature_dampers.log("dahl", 51, random=False, measured=True).to_parquet(file)
    log = read_logs([str(file)], need_force=True, report=lambda line: None).recording
    names = (
        "preyield_elasticity", "presliding_friction", "field_viscosity", "coulomb_friction",
        "preyield_viscosity",
    )  # fmt: skip
    found = diagnose(log, [get(n) for n in names], limits=False, learning=False)
    assert {f.effect.name for f in found.findings} == {*names[:3]}
    values = found.fit.values  # k_w without control, and what grows in proportion to it
    assert values["presliding_friction.F_c"] == pytest.approx(59.28, rel=0.05)
    assert values["compression.beta"] == pytest.approx(1.0, abs=0.03)

"""Trials in worker processes: the same answers as in one."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from rig import campaign, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose import carry_over, thresholds
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.executor import Executor, Task, executor
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.record_effects import Varying
from erdctl.effects import get
from erdctl.io import documents
from erdctl.io.diagnosis import to_json

# One that feeds the force back, one that makes samples doubtful, and look-alikes.
FEW = ("coulomb_friction", "preyield_viscosity", "time_skew", "mount_compliance")


def rubbing() -> Recording:
    """Without control steps, so that there are parameters that cannot be identified."""
    r = campaign(50.0, 6.0)
    r = noisy(r.select([i for i, n in enumerate(r.names) if "Hz" in n]), seed=4)
    assert r.force is not None
    return replace(r, force=r.force + 2.0 * np.sign(r.xdot))


def test_the_document_is_the_same_for_any_number_of_jobs() -> None:
    seen: list[tuple[str, str]] = []
    candidates = [get(name) for name in ("coulomb_friction", "time_skew")]

    def document(jobs: int) -> bytes:
        found = diagnose(
            rubbing(), candidates, limits=False, jobs=jobs, progress=lambda *told: seen.append(told)
        )
        return documents.encode(to_json(found))

    one, two = document(1), document(2)
    assert one == two
    assert b"coulomb_friction" in one
    assert any(s == "each effect" and w.startswith("time_skew, ") for s, w in seen)


def test_effects_that_cannot_act_together_are_no_trial() -> None:
    both = tuple(get(name) for name in ("preyield_viscosity", "yield_hysteresis"))
    problem = prepare(rubbing())
    assert Executor([problem]).fit(problem, [Task("pairs", both, ({},))]) == [None]


def test_what_is_asked_of_hypotheses_is_the_same_in_other_processes() -> None:
    """Of ones that hold parameters back, that doubt samples, and with a gain of every record."""
    problem = prepare(rubbing(), Varying(gain=True))
    few = carry_over.thinned(problem, thresholds.CARRY_SAMPLES)
    kinds = np.arange(len(few.block.force)) % 3
    seen = []
    for jobs in (1, 2):
        with executor([problem], jobs, lambda stage, what: None) as tried:
            found = [
                h for h in tried.fit(problem, [Task("each", (get(n),), ({},)) for n in FEW]) if h
            ]
            assert len(found) == len(FEW)
            seen.append(tried.each(problem, partial(carry_over._error_without, kinds=kinds), found))
    assert seen[0] == seen[1]
    assert len(set(seen[0])) == len(FEW)

"""The last step of a fit, in finer steps than those of the log, goes down however far it is."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rig import campaign, noisy

from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate import last_step
from erdctl.model.composed import Model


def test_a_step_that_goes_too_far_is_made_shorter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Dropped as a whole, all values stay where the log's own steps had them, with errors from
    there: of a soft mount under one sine k_nom was 3725 to 5549 N/m for 13304."""
    model, clean = Model((get("quadratic_damping"),)), campaign(200.0, 6.0)
    true = {name: q.start for name, q in model.quantities.items()}
    force = model.force(prepare(clean).block.signals, true)
    block = prepare(noisy(replace(clean, force=force), 1, 0.3)).block
    start = true | {"quadratic_damping.c_2": 0.0, "compression.k_nom": 400.0}
    moved = last_step._moved
    monkeypatch.setattr(last_step, "_moved", lambda m, v, f, step: moved(m, v, f, 3.0 * step))
    assert last_step.assess(model, [block], start).rms == pytest.approx(0.3, rel=0.03)
    monkeypatch.setattr(last_step, "SHORTER", last_step.SHORTER[:1])
    assert last_step.assess(model, [block], start).rms > 0.5

"""An onset is moved only where the fit gets better by it."""

from __future__ import annotations

from typing import Any

import pytest
from rig import campaign, noisy

from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate import least_squares
from erdctl.estimate.least_squares import fit
from erdctl.model.composed import Model


def test_a_place_that_does_harm_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """To first order it looked best; the search from there ended at a hundred times the cost."""
    block = prepare(noisy(campaign(100.0, 6.0), seed=4)).block
    model = Model((get("electrical_fault"),))
    start = {n: q.start for n, q in model.quantities.items()}
    start |= {"electrical_fault.f": 1.0, "electrical_fault.t_0": 5.9, "electrical_fault.t_r": 0.0}
    asked: list[float] = []

    def harmful(model: Model, block: Any, values: dict[str, float], held: set[str]) -> Any:
        asked.append(values["electrical_fault.t_0"])
        return {**values, "electrical_fault.f": 0.0, "electrical_fault.t_0": 0.0}

    monkeypatch.setattr(least_squares, "place", lambda model, block, values, held: dict(values))
    plain = fit(model, block, start=start, fixed={"electrical_fault.f"})
    monkeypatch.setattr(least_squares, "place", harmful)
    found = fit(model, block, start=start, fixed={"electrical_fault.f"})
    assert asked
    assert found.cost == pytest.approx(plain.cost)
    assert found.values["electrical_fault.t_0"] == 5.9

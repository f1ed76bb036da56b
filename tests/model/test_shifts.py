"""A force with one parameter moved is that of the model at the moved value, whatever it reaches."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from rig import campaign

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.signals import Signals
from erdctl.effects import candidates
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.shifts import Shifts

CATALOGUE = candidates()
SINGLES = [(e,) for e in CATALOGUE]
PAIRS = list(combinations(CATALOGUE, 2))[::7]


def values_of(model: Model) -> dict[str, float]:
    """Values at which every part of the model acts, and no two directions are alike."""
    out = {n: q.start for n, q in model.quantities.items()}
    for way, factor in (("compression", 1.0), ("release", 0.9)):
        for symbol, value in (("k_nom", 400.0), ("c_vis", 80.0), ("sigma", 14.0), ("beta", 0.5)):
            out[f"{way}.{symbol}"] = factor * value
    for effect in model.effects:
        out |= {effect.key(q.symbol): min(max(0.5, q.low), q.high) for q in effect.amplitudes}
    return out


@pytest.mark.parametrize("effects", [*SINGLES, *PAIRS], ids=lambda es: "+".join(e.name for e in es))
def test_every_parameter_of_every_model(effects: tuple[Effect, ...]) -> None:
    r = campaign(200.0, 2.0)
    s, model = Signals.of(r.select([0, len(r.names) - 1])), Model(effects)
    values = values_of(model)
    try:
        near = Shifts(model, s, values)
    except IncompatibleEffects:
        pytest.skip("cannot act together")
    assert np.array_equal(near.force, model.force(s, values))
    for name, value in values.items():
        moved = 1.01 * value if value else 0.01
        expected = model.force(s, {**values, name: moved})
        error = np.abs(near.at(name, moved) - expected).max()
        assert error < 1e-9 * np.abs(expected).max(), name


def test_a_spring_that_is_switched_off_is_gone_with_its_joint() -> None:
    r = campaign(200.0, 2.0)
    s = Signals.of(r.select([0]))
    model = Model(tuple(e for e in CATALOGUE if e.name in ("backlash", "mount_compliance")))
    values = values_of(model)
    near = Shifts(model, s, values)
    for name, moved in (("mount_compliance.s_m", 0.0), ("backlash.g", 0.0)):
        expected = model.force(s, {**values, name: moved})
        assert not np.array_equal(expected, near.force)
        assert np.array_equal(near.at(name, moved), expected), name

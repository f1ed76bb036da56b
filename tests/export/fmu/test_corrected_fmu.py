"""FMUs of corrected models: catalogued effects and learned laws, with what these must be told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fmpy.validation import validate_fmu
from fmu_built import NUMBERS, Instance, built, driven, table_2

from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.export.c.source import write_c
from erdctl.export.fmu.damper import damper_block
from erdctl.model.composed import Model
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law
from erdctl.model.learned.law_slot import LawSlot
from erdctl.model.parameters import Estimate, Parameters

PAPER = table_2().values
WARM = 31.0


def motion(step: float = 1e-3, n: int = 4000) -> Signals:
    t = 3.0 + step * np.arange(n)
    x, xdot = np.zeros((2, n))
    for w, a in ((5.0, 0.008), (17.0, 0.002), (31.0, 0.0005)):
        x, xdot = x + a * np.sin(w * t), xdot + a * w * np.cos(w * t)
    duty = np.where(np.floor(2.0 * t) % 2 == 0, 0.1, 0.4)
    return Signals(
        t, x, xdot, duty, np.append(np.diff(t), 0.0), np.array([0, n]),
        temperature=np.full(n, WARM),
    )  # fmt: skip


def parameters_of(model: Model, extra: dict[str, float]) -> Parameters:
    values = PAPER | extra
    return Parameters(
        model=model,
        estimates={k: Estimate(value=values[k], unit=q.unit) for k, q in model.quantities.items()},
    )


def begun(s: Signals) -> dict[str, float]:
    return {"first_compressing": bool(s.compressing[0]), "at_rest": int(s.rests[0])}


@pytest.mark.parametrize("number", NUMBERS)
def test_effects_with_parameters_of_their_own(number: str) -> None:
    """Its start time is the time in which an onset counts."""
    effects = tuple(get(name) for name in ("coulomb_friction", "oil_leakage", "thermal_fade"))
    model = Model(effects)
    own = {e.key(q.symbol): q.start for e in effects for q in e.quantities}
    own |= {"coulomb_friction.F_c": 3.0, "oil_leakage.t_0": 5.0}
    p, s = parameters_of(model, own), motion()
    path = built(damper_block(write_c(p, prefix="corrected"), p), number)
    assert validate_fmu(str(path)) == []
    instance = Instance(path)
    assert {*own} <= {*instance.at}
    force = driven(instance, {"x": s.x, "xdot": s.xdot, "duty": s.duty}, s.t, **begun(s))
    instance.close()
    expected = model.force(s, p.values)
    assert np.max(np.abs(force - expected)) <= 1e-9 * np.ptp(expected)


@pytest.mark.parametrize("number", NUMBERS)
def test_a_law_of_the_temperature_has_it_as_an_input(number: str) -> None:
    law = Law(LawSlot.YIELD, Curve("temperature", (20.0, 30.0, 40.0), zero_first=True)).effect
    model = Model((law,))
    own = {law.key(q.symbol): 0.1 * (i + 1) for i, q in enumerate(law.quantities)}
    p, s = parameters_of(model, own), motion()
    path = built(damper_block(write_c(p, prefix="warm"), p), number)
    assert validate_fmu(str(path)) == []
    for warm, given in ((WARM, {"temperature": np.full(len(s), WARM)}), (30.0, {})):
        instance = Instance(path)
        signals = {"x": s.x, "xdot": s.xdot, "duty": s.duty, **given}
        force = driven(instance, signals, s.t, **begun(s))
        instance.close()
        expected = model.force(replace(s, temperature=np.full(len(s), warm)), p.values)
        assert np.max(np.abs(force - expected)) <= 1e-9 * np.ptp(expected)


def test_a_law_of_passes_may_be_told_the_stroke() -> None:
    """Told or not it runs; a stroke that is none is as good as none."""
    law = Law(LawSlot.FORCE, Curve("passes", (0.0, 5.0, 50.0), zero_first=True)).effect
    own = {law.key(q.symbol): 2.0 for q in law.quantities}
    p, s = parameters_of(Model((law,)), own), motion(n=1500)
    path = built(damper_block(write_c(p, prefix="worn"), p), "2")
    assert validate_fmu(str(path)) == []
    forces = []
    for low, high in ((0.0, 0.0), (0.5, -0.5), (float(s.x.min()), float(s.x.max()))):
        instance = Instance(path)
        initial = begun(s) | {"stroke_low": low, "stroke_high": high}
        signals = {"x": s.x, "xdot": s.xdot, "duty": s.duty}
        forces.append(driven(instance, signals, s.t, **initial))
        instance.close()
    assert np.array_equal(forces[0], forces[1])
    assert not np.array_equal(forces[0], forces[2])
    assert np.isfinite(forces).all()

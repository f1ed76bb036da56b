"""What a fit ends with at a bound is written, read again and simulated, whatever the effect."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from by_hand import recording
from hypothesis import given, settings
from hypothesis import strategies as st
from rig import TRUTH

from erdctl.core.blocks import whole
from erdctl.core.errors import ComputationProblem, InputProblem
from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import catalogue
from erdctl.estimate.least_squares import _Axis, fit
from erdctl.estimate.normal_equations import Normal
from erdctl.io import documents
from erdctl.io.parameters import parse_parameters, to_document
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.paper import QUANTITIES
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.simulate import simulate

CATALOGUE = catalogue()
every = pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)
t = np.arange(400) / 100.0
SHORT = recording(
    0.1 * np.cos(3 * t), x=0.1 / 3 * np.sin(3 * t), t=t, duty=np.where(t > 2, 0.3, 0.1)
)


def given_as(model: Model, values: dict[str, float]) -> Parameters:
    return Parameters(
        model=model,
        estimates={n: Estimate(value=values[n], unit=q.unit) for n, q in model.quantities.items()},
    )


def round_trip(model: Model, values: dict[str, float]) -> Array:
    """The force by a file of these values, after it was written and read."""
    read = parse_parameters(documents.encode(to_document(given_as(model, values))), "test")
    return simulate(read, SHORT)


def sides(q: Quantity, bound: float) -> list[float]:
    """A bound as logarithms and units leave it: itself, its neighbours, and 1e-12 beyond."""
    away = np.inf if bound == q.high else -np.inf
    through = [float(np.exp(np.log(bound)))] if q.scale is Scale.LOG else []
    beyond = bound + float(np.sign(away)) * 1e-12 * abs(bound)
    return [bound, float(np.nextafter(bound, away)), float(np.nextafter(bound, -away)), beyond,
            *through, bound * 1e3 * 1e-3]  # fmt: skip


@every
def test_at_and_next_to_each_bound(effect: Effect) -> None:
    model = Model((effect,))
    start = TRUTH | {effect.key(q.symbol): q.start for q in effect.quantities}
    for q in effect.quantities:
        for bound in (q.low, q.high):
            if bound == 0.0:
                values = [0.0]  # nothing is relative to 0: a fit must not go beyond it
            elif q.linear and abs(bound) >= 1e6:
                continue  # no damper has it, and no fit comes there
            else:
                values = sides(q, bound)
            for value in values:
                try:
                    force = round_trip(model, start | {effect.key(q.symbol): value})
                except ComputationProblem:
                    # Read, but forces that no damper makes: a fit does not end there.
                    assert abs(value) >= 1e4 * abs(q.start), (q.symbol, value)
                else:
                    assert np.isfinite(force).all(), (q.symbol, value)


@every
def test_beyond_a_bound_is_refused(effect: Effect) -> None:
    model = Model((effect,))
    start = TRUTH | {effect.key(q.symbol): q.start for q in effect.quantities}
    for q in effect.quantities:
        low = q.low if q.read_low is None else q.read_low
        for value in (q.high + 0.01 * abs(q.high), low - max(0.01 * abs(low), 1e-3)):
            if not q.admits(value):
                with pytest.raises(InputProblem, match="is outside"):
                    round_trip(model, start | {effect.key(q.symbol): value})


@settings(deadline=None, max_examples=200)
@given(
    q=st.sampled_from([*QUANTITIES.values(), *(q for e in CATALOGUE for q in e.quantities)]),
    part=st.sampled_from([-1e-3, 0.0, 1.0, 1.001]) | st.floats(0.0, 1.0),
)
def test_no_search_leaves_the_bounds(q: Quantity, part: float) -> None:
    axis = _Axis.of(q, q.start)
    assert q.low <= axis.back(axis.low + part * (axis.high - axis.low)) <= q.high
    assert q.admits(axis.back(axis.high))


@settings(deadline=None, max_examples=50)
@given(seed=st.integers(0, 10_000))
def test_no_amplitude_leaves_its_bounds(seed: int) -> None:
    random = np.random.default_rng(seed)
    J = random.standard_normal((6, 60)) * 10.0 ** random.integers(-6, 6, (6, 1))
    low, high = np.zeros(6), np.full(6, float(random.uniform(0.1, 3)))
    found = Normal.of(J @ J.T).bounded(J @ random.standard_normal(60), low, high)
    assert (found >= low).all()
    assert (found <= high).all()


def test_a_fit_pressed_against_its_bound_is_read_again() -> None:
    """The void of the issue: by its logarithm the search ended an ulp above 100."""
    effect = next(e for e in CATALOGUE if e.name == "cavitation")
    model = Model((effect,))
    own = {"x_v": 2e-3, "lambda": 1.0, "g": 100.0, "e": 0.5}
    truth = TRUTH | {effect.key(s): v for s, v in own.items()}
    # A void that any compression fills wants g as large as it may be.
    force = model.force(Signals.of(SHORT), truth)
    block = whole(replace(SHORT, force=force))
    start = truth | {effect.key("g"): 30.0}
    found = fit(model, block, start=start, fixed=[n for n in model.quantities if n in TRUTH])
    force = round_trip(model, found.values)
    assert np.isfinite(force).all()

"""What a part of the samples tells of a learned law.

A parameter of an effect of which the rest says nothing stays where all data had it, see
`carry_over`. Of a curve that would label the samples that are left out: the value at a knot near
which no others lie would predict them, whatever it stands for. So a curve goes through the knots of
which the rest tells, and beyond them stays at its end value, as it does for people; and a closed
form begins as good as absent.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.learned.coordinates import Memory, along
from erdctl.model.learned.law import LearnedEffect
from erdctl.model.learned.surface import Surface


def as_begun(model: Model, values: Mapping[str, float]) -> dict[str, float]:
    """Values with which a fit to a part of the samples begins."""
    sizes = [e.key("a") for e in _learned(model, closed=True)]
    return {**values, **{size: thresholds.BEGUN * values[size] for size in sizes}}


def as_told(
    model: Model, values: Mapping[str, float], s: Signals, rest: Array, whole: Array
) -> tuple[Model, dict[str, float]]:
    """A model and its values with learned curves that some samples tell.

    rest, whole : (n,) weights of those samples, and of all
    """
    seen = {e.name: _told(e, values, s, rest, whole) for e in _learned(model, closed=False)}
    if all(found is None for found in seen.values()):
        return model, dict(values)
    new, effects = dict(values), list[Effect]()
    for effect in model.effects:
        found = seen.get(effect.name)
        effects.append(effect if found is None else found[0])
        new.update({} if found is None else found[1])
    return Model(tuple(effects)), new


def _told(
    effect: LearnedEffect, values: Mapping[str, float], s: Signals, rest: Array, whole: Array
) -> tuple[LearnedEffect, dict[str, float]] | None:
    """One curve through the knots that are told, with their values; None where all are."""
    law, p = effect.law, effect.local(values)
    if isinstance(law.curve, Surface):
        return _surface_told(effect, law.curve, p, s, rest, whole)
    curve, knots = law.curve, np.array(law.curve.knots)
    z = along(curve.coordinate, s, Memory.of(p))
    told = np.flatnonzero(_near(z, knots, rest, whole))
    if len(told) == len(knots):
        return None
    at = [p[q.symbol] for q in curve.amplitudes(law.unit)]
    at = [0.0, *at] if curve.zero_first else at
    places, sizes = knots[told].tolist(), [at[k] for k in told]
    if len(places) < 2:  # a constant, that of nothing where nothing is told
        places, sizes = [knots[0].item(), knots[-1].item()], 2 * (sizes or [0.0])
    through = replace(curve, knots=tuple(places), zero_first=False)
    new = replace(law, curve=through)
    own = dict(zip((q.symbol for q in through.amplitudes(law.unit)), sizes, strict=True))
    # Of the old name: two curves with as many knots left would else be one.
    return (
        replace(new.effect, name=effect.name),
        {effect.key(symbol): value for symbol, value in own.items()},
    )


def _surface_told(
    effect: LearnedEffect, surface: Surface, p: Mapping[str, float], s: Signals, rest: Array,
    whole: Array,
) -> tuple[LearnedEffect, dict[str, float]] | None:  # fmt: skip
    """One surface with, at knots that are not told, the value of the nearest that are.

    A fit leaves these as they are, as the samples that it has say nothing of them.
    """
    grid = [np.array(axis.knots) for axis in surface.axes]
    z = [along(axis.coordinate, s, Memory.of(p)) for axis in surface.axes]
    known = np.isfinite(z[0]) & np.isfinite(z[1])
    i, j = (np.searchsorted(0.5 * (k[:-1] + k[1:]), v[known]) for k, v in zip(grid, z, strict=True))
    cells = len(grid[0]) * len(grid[1])
    of = [np.bincount(i * len(grid[1]) + j, w[known], cells) for w in (rest, whole)]
    told = of[0] > thresholds.TOLD * of[1]
    if told[of[1] > 0.0].all():
        return None
    symbols = [q.symbol for q in surface.amplitudes(effect.law.unit)]
    values = np.concatenate([np.zeros(cells - len(symbols)), [p[symbol] for symbol in symbols]])
    if told.any():
        at = np.array(np.unravel_index(np.arange(cells), [len(k) for k in grid])).T
        apart = np.abs(at[:, None] - at[None, told]).sum(axis=2)
        values = values[told][apart.argmin(axis=1)]
    else:
        values = np.zeros(cells)
    whole_grid = replace(surface, zero_first=False)
    new = replace(effect.law, curve=whole_grid)
    own = zip((q.symbol for q in whole_grid.amplitudes(new.unit)), values.tolist(), strict=True)
    return (
        replace(new.effect, name=effect.name),
        {effect.key(symbol): value for symbol, value in own},
    )


def _near(z: Array, knots: Array, rest: Array, whole: Array) -> Array:
    """(k,) whether samples near a knot are in the rest; where there are none, by its neighbours.

    Check: the last of three knots is not told; none lies near the second.
    >>> z, all_ = np.array([0.0, 0.1, 2.0]), np.ones(3)
    >>> _near(z, np.array([0.0, 1.0, 2.0]), np.array([1.0, 1.0, 0.0]), all_).tolist()
    [True, False, False]
    """
    known = np.isfinite(z)
    cell: Index = np.searchsorted(0.5 * (knots[:-1] + knots[1:]), z[known])
    of = [np.bincount(cell, w[known], len(knots)) for w in (rest, whole)]
    filled = of[1] > 0.0
    if not filled.any():
        return np.zeros(len(knots), dtype=bool)
    share = of[0][filled] / of[1][filled]
    near = np.interp(knots, knots[filled], (share > thresholds.TOLD).astype(float))
    return np.asarray(near >= 1.0)


def _learned(model: Model, *, closed: bool) -> list[LearnedEffect]:
    """The learned laws in closed forms, or the others."""
    laws = (e for e in model.effects if isinstance(e, LearnedEffect))
    return [e for e in laws if (e.law.curve.form is not None) is closed]

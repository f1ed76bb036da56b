"""Inputs made by hand: for tests of single effects, and for the checks in docstrings.

`HELPERS` are the names that a docstring's check may use besides those of its own module. What a
check does not give is of no weight in it: 0, or 1 where 0 would not do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array, Recording
from erdctl.core.signals import Signals
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.geometry import Geometry


def recording(
    xdot: Sequence[float] | Array,
    *,
    x: Sequence[float] | Array | None = None,
    duty: Sequence[float] | Array | float = 0.0,
    force: Sequence[float] | Array | None = None,
    step: float = 0.01,
    t: Sequence[float] | Array | None = None,
    starts: Sequence[int] | None = None,
) -> Recording:
    """A log from a velocity [m/s]; unless given, x is 0 [m] and a sample taken every `step` [s].

    force : (n,) [N];  t : (n,) [s];  starts : offsets of the records, one record unless given
    """
    v = np.asarray(xdot, dtype=float)
    n = len(v)
    bounds = [0, n] if starts is None else list(starts)
    return Recording(
        t=np.arange(n) * step if t is None else np.asarray(t, dtype=float),
        x=np.zeros(n) if x is None else np.asarray(x, dtype=float),
        xdot=v,
        duty=np.broadcast_to(np.asarray(duty, dtype=float), v.shape).copy(),
        force=None if force is None else np.asarray(force, dtype=float),
        starts=np.array(bounds, dtype=np.intp),
        names=tuple(str(i) for i in range(len(bounds) - 1)),
    )


def signals(xdot: Sequence[float] | Array, **given: Any) -> Signals:
    """What a model sees of such a log; the same arguments as `recording`."""
    return Signals.of(recording(xdot, **given))


def geometry(**given: float) -> Geometry:
    """A damper's dimensions, in SI units; 1 unless given."""
    return Geometry(**{f.name: 1.0 for f in fields(Geometry)} | given)


def force_with(effect: Effect, s: Signals, p: Mapping[str, float], **paper: float) -> Array:
    """(n,) force of a damper with one effect [N], the same in both directions.

    p : the effect's values;  paper : k_nom, c_vis, T_d, sigma, 0 unless given, and beta, 1
    """
    plain = {"k_nom": 0.0, "c_vis": 0.0, "T_d": 0.0, "sigma": 0.0, "beta": 1.0} | paper
    values = {f"{way}.{symbol}": value for way in DIRECTIONS for symbol, value in plain.items()}
    own = {effect.key(symbol): value for symbol, value in p.items()}
    return Model((effect,)).force(s, values | own)


HELPERS: dict[str, Any] = {
    "np": np,
    "recording": recording,
    "signals": signals,
    "geometry": geometry,
    "force_with": force_with,
}

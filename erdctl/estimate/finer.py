"""Signals between samples, so that a fit's last step is not that of a coarse simulation.

A simulation in the log's own steps is off by a part of a step where force jumps, by the square of
it elsewhere. A fit takes that up in its parameters: a compliance comes out 1 % small, a delay by a
tenth of a step. Simulated in steps of half a millisecond, the same parameters are those of the
damper.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.model.composed import Model
from erdctl.model.slots import Values

FINE = 0.5e-3  # s
MOST_PARTS = 10  # of a step
MOST_SAMPLES = 300_000  # of the finer signals, beyond which memory and time speak against it


class Finer(NamedTuple):
    """Finer signals of a log, and the places of its samples in them; None for all of them."""

    log: Signals
    signals: Signals
    rows: Index | None

    @classmethod
    def none(cls, signals: Signals) -> Finer:
        """The log's own steps."""
        return cls(signals, signals, None)

    @classmethod
    def of(cls, signals: Signals) -> Finer:
        """Signals with each step in equal parts of about half a millisecond.

        Velocity between samples is the monotone cubic through them (F. N. Fritsch, R. E. Carlson,
        SIAM J. Numer. Anal. 17 (1980) 238-246), which keeps the sign that they agree on; deflection
        follows it from sample to sample; the duty holds; a temperature is a straight line.
        """
        s = signals
        parts = int(np.ceil(s.typical_step / FINE)) if s.typical_step > 0.0 else 1
        parts = min(parts, MOST_PARTS, MOST_SAMPLES // max(len(s), 1))
        if parts < 2:
            return cls.none(s)
        channels: list[tuple[Array, ...]] = []
        for a, b in pairwise(s.starts.tolist()):
            channels.append(_record(s, a, b, parts))
        t, x, xdot, duty, step, place = (np.concatenate(c) for c in zip(*channels, strict=True))
        lengths = np.diff(s.starts)
        finer = (lengths - 1) * parts + 1
        starts = np.concatenate([[0], np.cumsum(finer)]).astype(np.intp)
        within = np.arange(len(s)) - np.repeat(s.starts[:-1], lengths)
        rows = np.repeat(starts[:-1], lengths) + within * parts
        warmth = s.temperature
        if warmth is not None:
            warmth = np.interp(place, np.arange(len(s)), warmth)
        fine = Signals(
            t, x, xdot, duty, step, starts, temperature=warmth, logged_step=s.typical_step
        )
        return cls(s, fine, rows)

    @property
    def sharp(self) -> Finer:
        """The same, with contacts that set in at once."""
        return self._replace(signals=replace(self.signals, sharp=True))

    def force(self, model: Model, values: Values) -> Array:
        """(n,) force at the log's samples [N]."""
        return self.picked(model.force(self.signals, values))

    def picked(self, values: Array) -> Array:
        """(..., n) of (..., m) values on the finer signals."""
        return values if self.rows is None else values[..., self.rows]


def _record(s: Signals, a: int, b: int, parts: int) -> tuple[Array, ...]:
    if b - a < 3:
        raise ValueError("a record of fewer than three samples has no motion between them")
    from scipy.interpolate import PchipInterpolator

    t, x, v = s.t[a:b] - s.t[a], s.x[a:b], s.xdot[a:b]
    last = parts * (b - a - 1)
    place = np.arange(last + 1) / parts
    fine = np.interp(place, np.arange(b - a), t)
    speed = PchipInterpolator(t, v)
    travel = speed.antiderivative()(fine)
    # The integral runs off by what the noise of x is; from sample to sample it is tied to x.
    off = np.interp(fine, t, x - travel[::parts])
    xdot = speed(fine)
    xdot[::parts] = v
    duty = np.repeat(s.duty[a:b], parts)[: last + 1]
    step = np.append(np.repeat(s.step[a : b - 1] / parts, parts), 0.0)
    return fine + s.t[a], travel + off, xdot, duty, step, place + a

"""The duty sequence for a corrected model, whose effects no formula inverts.

Delays, slew limits, lags of the signed force, springs and heat stand between duty and force, one
behind the other. The model itself is asked instead: how does its force answer a small change of
the steady yield force u at each moment, and which changes bring it nearest to the ideal force?

    min over u of |F_ideal - F(v(u))|^2,   0 <= u <= u(v_max)                   Gauss-Newton

in steps damped after Levenberg and Marquardt. An answer fades within some lags, so that many
moments are asked in one simulation, far enough apart that each sample shows the answer to one
(Curtis, Powell and Reid). Knots of the change lie as densely as a few dozen simulations for one
derivative allow.

Source: J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed. (2006), Ch. 10; A. R. Curtis,
M. J. D. Powell, J. K. Reid, J. Inst. Maths Applics 13 (1974) 117-119.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded
from scipy.sparse import csr_matrix

from erdctl.core.recording import Array, Index
from erdctl.core.signals import Signals
from erdctl.mimic.hold import CausalHold
from erdctl.mimic.inverse import Laws
from erdctl.mimic.outcome import Flags
from erdctl.model.composed import Model

COLOURS = 48  # simulations for one derivative, at most
CELLS = 12_000_000  # numbers in one derivative, at most: 100 MB
PROBES = 24  # places at which the length of the answer is measured, at most
WINDOW = 1.5  # s, at least, from one of them to the next
GOLDEN = 0.618034
FADED = 0.03  # of its peak: an answer below that has faded
FLOOR = 1e-4  # of the typical diagonal: what no sample shows stays as it is
PASSES = 8
STEPS = 24
TRIES = 5
ENOUGH = 2e-3  # a step that improves by a smaller part is the last


@dataclass(frozen=True, eq=False)
class Target:
    """What is to be reached, by which damper, through which amplifier.

    ideal : (n,) force [N];  laws : steady yield laws of either direction
    """

    model: Model
    values: Mapping[str, float]
    signals: Signals
    ideal: Array
    laws: Laws
    hold: CausalHold

    def force(self, duty: Array) -> Array:
        """(n,) force of the damper under a duty."""
        return self.model.force(self.signals.with_duty(duty), self.values)

    def error(self, duty: Array) -> Array:
        """(n,) force that is missing under a duty [N]."""
        return self.ideal - self.force(duty)

    def miss(self, duty: Array) -> float:
        """Sum of squared errors under a duty [N^2]."""
        error = self.error(duty)
        return float(error @ error)

    def improved(self, duty: Array) -> tuple[Array, int]:
        """See `improve`."""
        return improve(self, duty)

    def duty(self, u: Array) -> Array:
        """(n,) duty for steady yield forces (n,) [N] that the amplifier can carry out."""
        up = self.signals.compressing
        wanted = np.where(up, self.laws[0].duty(u), self.laws[1].duty(u))
        return self.hold.follow(wanted)

    def steady(self, duty: Array) -> Array:
        """(n,) steady yield force of a duty (n,) [N]."""
        up = self.signals.compressing
        return np.where(up, self.laws[0].forces(duty), self.laws[1].forces(duty))


@dataclass(frozen=True, eq=False)
class Mesh:
    """Knots of the change of u, and how long an answer lasts.

    colours : knots so far apart do not share a sample;  lasts : samples that an answer lasts
    hats : (n, k) straight lines between knots, sparse;  at : (k,) sample of each knot
    number : (k,) number of each knot in its record
    latest : (n,) number of the last knot that can have acted on a sample;  base : (n,) first knot
    of the sample's record, in the numbering of all
    """

    colours: int
    lasts: int
    hats: Any
    at: Index
    number: Index
    latest: Index
    base: Index


def improve(task: Target, duty: Array) -> tuple[Array, int]:
    """A better duty sequence (n,) than the given one, and the number of steps it took.

    The given one comes back if none is better.
    """
    ceiling = task.steady(np.full(len(duty), task.hold.levels.top))
    u = np.clip(task.steady(duty), 0.0, ceiling)
    nudge = 1e-3 * float(ceiling.max())
    if nudge == 0.0 or not task.hold.moments.any():
        return duty, 0
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, "blas"):  # thousands of narrow rows: threads only wait for each other
        return _descend(task, duty, u, ceiling, nudge)


def _descend(
    task: Target, duty: Array, u: Array, ceiling: Array, nudge: float
) -> tuple[Array, int]:
    best, cost = duty, task.miss(duty)
    mesh = _mesh(State.of(task, u, ceiling), nudge)
    damping, taken = 1e-3, 0
    error = task.error(task.duty(u))
    settled = _settled(task.hold, mesh.lasts)
    for _ in range(STEPS):
        before, lowest = error, float(error @ error)
        state = State.of(task, u, ceiling)
        J = _derivative(state, mesh, nudge)
        g = J.T @ (task.ideal - state.force)
        A = (J.T @ J).tocsr()
        low, high = -u[mesh.at], (ceiling - u)[mesh.at]
        for _ in range(TRIES):
            step = _solve(A, g, damping, mesh.colours, low, high)
            trial = np.clip(u + mesh.hats @ step, 0.0, ceiling)
            made = task.duty(trial)
            left = task.error(made)
            found = float(left @ left)
            if found < lowest:
                u, error, damping, taken = trial, left, damping / 5.0, taken + 1
                if found < cost:
                    best, cost = made, found
                break
            damping *= 6.0
        if all(_hardly_less(error[at], before[at]) for at in (slice(None), settled)):
            break
    return best, taken


def _hardly_less(error: Array, before: Array) -> bool:
    return float(error @ error) >= (1.0 - ENOUGH) * float(before @ before)


def _settled(hold: CausalHold, lasts: int) -> Flags:
    """(n,) samples at which a fault has acted for longer than answers last, or from the start on.

    Nothing may anticipate an onset. What it leaves for a while is no part of what a step can gain,
    and may be so much that the gain elsewhere seems small.
    """
    acting, starts = hold.acting, hold.clock.starts
    begins = np.zeros(len(acting), dtype=bool)
    begins[starts[:-1]] = True
    onset = acting & ~np.concatenate([[False], acting[:-1]]) & ~begins
    index = np.arange(len(acting))
    last = np.maximum.accumulate(np.where(onset, index, np.where(begins, index - lasts, -lasts)))
    return acting & (index - last >= lasts)


@dataclass(frozen=True, eq=False)
class State:
    """Where a derivative is taken: u (n,), its bound (n,) and the force (n,) there.

    Under an amplifier of any resolution: a small change would be lost in its steps, or be one.
    """

    task: Target
    u: Array
    ceiling: Array
    force: Array

    @classmethod
    def of(cls, task: Target, u: Array, ceiling: Array) -> State:
        """The state of a task at u."""
        smooth = replace(task, hold=task.hold.unstepped)
        return cls(smooth, u, ceiling, smooth.force(smooth.duty(u)))

    def answer(self, change: Array) -> Array:
        """(n,) change of the force with a change (n,) of u."""
        moved = np.clip(self.u + change, 0.0, self.ceiling)
        return self.task.force(self.task.duty(moved)) - self.force


def _mesh(state: State, nudge: float) -> Mesh:
    """Knots as dense as the length of the answers allows."""
    s = state.task.signals
    record = np.diff(s.starts)
    apart = max(len(s) // PROBES, int(WINDOW / max(s.typical_step, 1e-9)), 2)
    sites = np.concatenate([np.arange(a, b, apart) for a, b in pairwise(s.starts.tolist())])
    # Not at the same phase of a periodic motion.
    sites += (GOLDEN * np.arange(1, len(sites) + 1) % 0.5 * apart).astype(np.intp)
    sites = _moments(np.minimum(sites, len(s) - 1), state.task.hold, apart // 2)
    change = np.zeros(len(s))
    change[sites] = np.where(state.u + nudge > state.ceiling, -nudge, nudge)[sites]
    answer = np.abs(state.answer(change))
    bounds = np.union1d(sites, s.starts)
    firsts, ends = [], []
    for site in sites.tolist():
        there = answer[site : int(bounds[np.searchsorted(bounds, site, side="right")])]
        peak = float(there.max())
        if peak > 0.0:
            seen = np.flatnonzero(there > FADED * peak)
            firsts.append(int(seen[0]))
            ends.append(int(seen[-1]) + 1)
    # The first sample of a record answers one step sooner: it sets where the field begins.
    dead = max(min(firsts, default=0) - 1, 0)
    lasts = max(int(np.quantile(ends, 0.9)) - dead, 1) if ends else 1
    most = max(min(COLOURS, CELLS // max(len(s), 1)), 4)
    spacing = max(1, -(-lasts // (most - 2)))
    colours = -(-lasts // spacing) + 2
    offset = np.arange(len(s)) - np.repeat(s.starts[:-1], record)
    counts = (record - 1) // spacing + 2
    first = np.concatenate([[0], np.cumsum(counts)])
    base = np.repeat(first[:-1], record)
    left, part = offset // spacing, (offset % spacing) / spacing
    rows = np.tile(np.arange(len(s)), 2)
    columns = np.concatenate([base + left, base + left + 1])
    weights = np.concatenate([1.0 - part, part])
    number = np.concatenate([np.arange(c) for c in counts])
    knots = np.repeat(s.starts[:-1], counts) + number * spacing
    return Mesh(
        colours=colours, lasts=dead + lasts,
        hats=csr_matrix((weights, (rows, columns)), shape=(len(s), int(first[-1]))),
        at=np.minimum(knots, np.repeat(s.starts[1:] - 1, counts)), number=number,
        # The straight line to a knot begins one spacing before it.
        latest=np.minimum((offset - dead - 1) // spacing + 1, np.repeat(counts, record) - 1),
        base=base,
    )  # fmt: skip


def _moments(sites: Index, hold: CausalHold, apart: int) -> Index:
    """The samples next to sites at which the duty can be another one, where they are far apart."""
    moments = np.flatnonzero(hold.moments)
    after = np.searchsorted(moments, sites)
    found = np.unique(moments[after[after < len(moments)]])
    return found[np.diff(found, prepend=-apart - 1) > apart]


def _derivative(state: State, mesh: Mesh, nudge: float) -> Any:
    """(n, k) change of the force with the change of u at each knot, sparse."""
    p, n = mesh.colours, len(state.u)
    way = np.where(state.u[mesh.at] + nudge > state.ceiling[mesh.at], -nudge, nudge)
    # Of each colour, the knot that has acted on a sample last.
    knot = mesh.latest[:, None] - (mesh.latest[:, None] - np.arange(p)) % p
    column = mesh.base[:, None] + np.maximum(knot, 0)
    value = np.empty((n, p))
    for c in range(p):
        value[:, c] = state.answer(mesh.hats @ np.where(mesh.number % p == c, way, 0.0))
    value = np.where(knot >= 0, value / way[column], 0.0)
    rows = np.repeat(np.arange(n), p)
    return csr_matrix((value.ravel(), (rows, column.ravel())), shape=(n, len(way)))


def _solve(A: Any, g: Array, damping: float, band: int, low: Array, high: Array) -> Array:
    """The damped step: min of step A step / 2 - g step over low <= step <= high.

    A has `band` diagonals to a side and is damped by its own diagonal and the typical one. What
    leaves a bound is held there, and the others are asked again how far they go then: simply cut
    off, steps that lean on each other over the length of a lag make things worse.
    """
    diagonal = A.diagonal()
    seen = diagonal[diagonal > 0.0]
    typical = float(np.median(seen)) if seen.size else 1.0
    width = min(band, len(g) - 1)
    bands = np.zeros((width + 1, len(g)))
    for d in range(width + 1):
        bands[width - d, d:] = A.diagonal(d)
    bands[width] += damping * (diagonal + typical) + FLOOR * typical
    step, held = np.zeros_like(g), np.zeros(len(g), dtype=bool)
    for _ in range(PASSES):
        free = bands.copy()
        for d in range(1, width + 1):
            free[width - d, d:] *= ~(held[d:] | held[:-d])
        ask = np.where(held, 0.0, g - A @ np.where(held, step, 0.0))
        try:
            found = solveh_banded(free, ask)
        except LinAlgError:
            return np.zeros_like(g)
        step = np.where(held, step, found)
        beyond = (step < low) | (step > high)
        step = np.clip(step, low, high)
        if not beyond.any():
            break
        held |= beyond
    return step

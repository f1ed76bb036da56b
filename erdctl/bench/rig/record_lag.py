"""A record whose force is later or earlier against the motion than in the others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.linear_model import LEAST_RECORDS, Rows, levels_and_motion, model, steady
from erdctl.bench.rig.trend import clearest
from erdctl.core.messages import duration
from erdctl.core.recording import Array

PRIOR, PRIOR_SECONDS = 1e-3, 5e-4  # scatter of lags on a real rig: of a cycle; [s]
LAG, LAG_STEPS = 2e-3, 2.0  # least lag: [s], samples
# Parts of the record's misfit that the shift takes away: against a model of all records, and beside
# terms of the record's own.
EXPLAINED, OWN_EXPLAINED = 0.5, 0.3
LONGEST = 0.1  # s
BUILDS_UP = (0.03, 0.1, 0.3)  # of the stroke: travels over which a force may do so


def late(rows: Sequence[Rows]) -> RigFault | None:
    """By its lag behind a model of all, over the length of its cycle.

    Where the duty is steady: over duty, speed and stroke, and in cycles, since physics left out
    turns the phase.
    """
    theta = model(rows)
    seen, lags, cycles, least = [], [], [], []
    for r in rows:
        lag = _lag_of(r.columns @ theta, r.force, r.settled, r.piece.step)
        cycle = r.piece.cycle
        if lag is None or cycle == 0.0:
            continue
        unit = cycle if steady(rows) else 1.0
        seen.append(r)
        lags.append(lag[0] / unit)
        cycles.append(cycle)
        clear = lag[1] > EXPLAINED
        least.append(max(LAG, LAG_STEPS * r.piece.step) / unit if clear else np.inf)
    if len(seen) < LEAST_RECORDS:
        return None
    trend = levels_and_motion(seen) if steady(seen) else None
    if trend is None:
        trend = np.column_stack([np.ones(len(seen)), cycles])
    found = clearest(lags, trend, least, PRIOR if steady(rows) else PRIOR_SECONDS)
    if found is None:
        return None
    way = "later" if found.difference > 0 else "earlier"
    unit = cycles[found.index] if steady(rows) else 1.0
    late_by = found.difference * unit
    if not _itself_late(seen[found.index], late_by, loops=not steady(rows)):
        return None
    return RigFault(
        "record_lag", seen[found.index].piece.record,
        f"its force is {duration(abs(found.difference) * unit)} {way} against the motion than"
        f" in the other records, which differ by {duration(found.scatter * unit, 2)}",
        "it is left out of fits; look at the filters and the clocks of both channels", blocks=True,
    )  # fmt: skip


def _itself_late(r: Rows, lag: float, *, loops: bool) -> bool:
    """Whether a record is late (by so many seconds) by itself, whatever its spring, viscosity,
    yield force, friction and mass are.

    Of a smooth force any of these turns the phase as a lag does; where it jumps, none does.
    loops : whether its force may build up over some travel after a turn, which others, under
        another control, do not tell
    """
    t = r.piece.t[: len(r.force)]
    mass = np.gradient(r.piece.xdot[: len(t)], t)
    terms = np.column_stack([r.columns, mass, *([_building_up(r)] if loops else [])])
    shifted = np.column_stack([np.interp(t - lag, t, term) for term in terms.T])

    def misfit(columns: Array) -> float:
        A, F = columns[r.settled], r.force[r.settled]
        size = np.sqrt(np.mean(A**2, axis=0))
        A = A / np.where(size > 0, size, 1.0)
        return float(np.mean((F - A @ np.linalg.lstsq(A, F, rcond=1e-9)[0]) ** 2))

    return misfit(shifted) < (1.0 - OWN_EXPLAINED) * misfit(terms)


def _building_up(r: Rows) -> Array:
    """(n, 2 k) what friction and yield force lack until they slide, over some lengths of travel.

    As of a spring that slips, -2 sign(xdot) exp(-s / x_p), s : travel since the last turn.
    """
    x, way = r.piece.x[: len(r.force)], r.columns[:, 7]
    travel = np.append(0.0, np.cumsum(np.abs(np.diff(x))))
    turned = np.append(True, way[1:] != way[:-1])
    since = travel - travel[np.flatnonzero(turned)[np.cumsum(turned) - 1]]
    jumps = np.column_stack([way, r.columns[:, 5] + r.columns[:, 6]])
    parts = [np.exp(-since / (part * np.ptp(x)))[:, None] * jumps for part in BUILDS_UP]
    return np.column_stack(parts)


def _lag_of(
    modelled: Array, force: Array, use: npt.NDArray[np.bool_], step: float
) -> tuple[float, float] | None:
    """Lag of the force (n,) behind a model of it [s], and the part of the misfit that it takes."""
    if not use.any():
        return None
    m, f = (np.where(use, v - v[use].mean(), 0.0) for v in (modelled, force))
    most = min(int(LONGEST / step), len(f) // 8) if step > 0 else 0
    if most < 3 or not m.any() or not f.any():
        return None
    size = 1 << (2 * len(f) - 1).bit_length()
    cross = np.fft.irfft(np.fft.rfft(f, size) * np.conj(np.fft.rfft(m, size)), size)
    near = np.concatenate([cross[-most:], cross[: most + 1]])
    k = int(near.argmax())
    if k in (0, 2 * most):
        return None
    left, top, right = near[k - 1 : k + 2].tolist()
    bend = left - 2.0 * top + right
    part = 0.5 * (left - right) / bend if bend < 0 else 0.0
    squares = float(f @ f + m @ m)
    before, after = squares - 2.0 * float(near[most]), squares - 2.0 * top
    return (k - most + part) * step, 1.0 - max(after, 0.0) / before if before > 0 else 0.0

"""A record whose force has another gain, zero, lag or noise than the others have.

Each record is a few numbers: the size of its force, its mean, its lag behind a model, its noise.
Over the records of a test these follow what the test varied, the duty, speed and stroke, with
little scatter and whatever the physics; so a number is held against the straight-line trend of the
others, in units of their scatter (an externally studentised residual).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.linear_model import LEAST_RECORDS, Rows, best_rows, first_of_each, model
from erdctl.bench.rig.pieces import THIN, Piece, spread
from erdctl.bench.rig.trend import Away, studentised
from erdctl.core.quantiles import median, percentiles
from erdctl.core.recording import Array

CLEAR = 3.0  # below which nobody need ask for the chance
CHANCE = 4e-3  # of such a number among records that are alike, all of them together
# Records of one damper in one state differ by some per cent (2 to 6 % on a real rig): the scatter
# of a few others is taken together with such a prior, which counts like so many more degrees.
PRIOR_GAIN, PRIOR_OFFSET, PRIOR_LAG = 0.03, 0.01, 1e-3
PRIOR_LAG_SECONDS, PRIOR_NOISE = 5e-4, 0.2  # s; of the noise itself
LONG_ENOUGH, WHITE = 200, 1.2  # samples that noise is told from; see `white_noise`
PER_CYCLE = 24  # samples, of which the jumps at two reversals take a third of the third differences
GAIN, OFFSET, NOISE = 0.12, 0.04, 3.5  # least change: of 1, of the force's range, of the noise
GROSS, UNCERTAIN = float(np.log(100.0)), 4.0  # a factor that no test has; one that it may have
LAG, LAG_STEPS = 2e-3, 2.0  # least lag: [s], samples
EXPLAINED, LIKE_OTHERS = 0.8, 1.5  # part of the misfit that a gain takes; times the others' rest
# Columns of the spring with the zero, of the viscous, and of the yield force with friction; the
# part of a force from which a term is strong; the part of its change by which its gain may differ.
TERMS = ([0, 1, 2], [3, 4], [5, 6, 7])
STRONG, SAME_GAIN = 0.2, 0.3
LAG_EXPLAINED = 0.5  # part of the record's misfit that the shift takes away
LONGEST_LAG = 0.1  # s
STEADY = 0.02  # of the duty in a record, below which it is a level
UNITS = {
    "kilonewtons": 1e-3, "pounds-force": 1 / 4.4482216, "kilograms-force": 1 / 9.80665,
    "newtons, where the others are in pounds-force": 4.4482216,
    "newtons, where the others are in kilonewtons": 1e3,
    "newtons, where the others are in kilograms-force": 9.80665,
}  # fmt: skip


def check(found: Sequence[Piece]) -> list[RigFault]:
    """Records unlike the others."""
    if len({p.record for p in found}) < LEAST_RECORDS:
        return []
    out = _louder(found)
    loud = {f.record for f in out}
    rows = best_rows(first_of_each([p for p in found if p.record not in loud]))
    kinds: list[Callable[[Sequence[Rows]], RigFault | None]] = [_gained, _zeroed, _late]
    for kind in kinds:
        # The clearest first: left in, it widens the scatter that the next is held against.
        for _ in range(max(1, len(rows) // 3)):
            fault = kind(rows) if len(rows) >= LEAST_RECORDS else None
            if fault is None:
                break
            out.append(fault)
            rows = [r for r in rows if r.piece.record != fault.record]
    return out


def _clearest(
    values: Sequence[float], trend: Array, least: Sequence[float], prior: float
) -> Away | None:
    """The record that is farthest out, by its number, if any is by more than `least` of it."""
    found = [
        a
        for a in studentised(np.array(values), trend, prior)
        if abs(a.difference) > least[a.index]
        and abs(a.student) > CLEAR
        and a.chance * len(values) < CHANCE
    ]
    return max(found, key=lambda a: abs(a.student), default=None)


def _louder(found: Sequence[Piece]) -> list[RigFault]:
    """Records with several times the noise of the others, and of what their motion would give.

    Sampled too coarsely for it, a damper's own chatter is as white as noise, and grows with speed.
    """
    first: dict[int, Piece] = {}
    for p in found:
        if len(p) > LONG_ENOUGH and p.cycle > PER_CYCLE * p.step:
            first.setdefault(p.record, p)
    pieces = [p for p in first.values() if p.noise("force")[0] > 0]
    out = []
    # The clearest first, as in `check`.
    for _ in range(max(1, len(pieces) // 3)):
        levels = [p.noise("force")[0] for p in pieces]
        if len(pieces) < LEAST_RECORDS:
            break
        trend = np.array([
            [1.0, *(np.log(max(float(np.std(v)), 1e-12)) for v in (p.xdot, p.x))] for p in pieces
        ])  # fmt: skip
        least = [float(np.log(NOISE)) if p.noise("force")[1] > WHITE else np.inf for p in pieces]
        away = _clearest(np.log(levels).tolist(), trend, least, PRIOR_NOISE)
        if away is None:
            break
        usual = median([s for i, s in enumerate(levels) if i != away.index])
        p = pieces.pop(away.index)
        s = levels[away.index]
        if away.difference > 0 and s > NOISE * usual:
            out.append(
                RigFault(
                    "record_noise", p.record,
                    f"its force has {s / usual:.2g} times the noise of the other records"
                    f" ({s:.3g} N for {usual:.3g} N rms)",
                    "it is left out of fits; look at the cable, and record it again", blocks=True,
                )
            )  # fmt: skip
    return out


def _gained(rows: Sequence[Rows]) -> RigFault | None:
    """By the logarithm of the size of its force, over duty, speed and stroke."""
    values = []
    for r in rows:
        thin = r.piece.force[:: 1 + len(r.piece) // THIN]
        low, high = percentiles(thin, 2.0, 98.0)
        size = float(np.std(np.clip(thin, low, high)))
        values.append(float(np.log(max(size, 1e-12))))
    for i, value in enumerate(values):
        others = [v for k, v in enumerate(values) if k != i]
        if abs(value - median(others)) > GROSS and _same_speed(rows, i):
            return _gain_fault(rows[i], float(np.exp(value - median(others))), np.log(UNCERTAIN))
    trend = _trend(rows)
    found = None
    if trend is not None:
        least = [float(np.log1p(GAIN))] * len(rows)
        found = _clearest(values, trend, least, PRIOR_GAIN)
    # Where the control changes within records, sizes have no such trend, and a model decides, too.
    if found is not None and not _steady(rows) and not _only_gain(rows, found.index):
        return None
    if found is None:
        return None
    return _gain_fault(rows[found.index], float(np.exp(found.difference)), found.scatter)


def _gain_fault(r: Rows, ratio: float, scatter: float) -> RigFault:
    close = max(0.03, 2.0 * scatter)
    fitting = [u for u, f in UNITS.items() if abs(np.log(ratio / f)) < close]
    known = f", as if it were in {fitting[0]}" if len(fitting) == 1 else ""
    return RigFault(
        "record_gain", r.piece.record,
        f"its force is {ratio:.3g} times what the other records say{known}; these differ from their"
        f" trend by {100 * scatter:.2g} %",
        "it is left out of fits; look at the amplifier's range and the unit; if the damper itself"
        " changed, diagnose this record alone", blocks=True,
    )  # fmt: skip


def _same_speed(rows: Sequence[Rows], index: int) -> bool:
    """Whether a record is about as fast as the others, so that its force is about as large."""
    speeds = [float(np.std(r.piece.xdot)) for r in rows]
    usual = median(speeds)
    return usual / UNCERTAIN < speeds[index] < usual * UNCERTAIN


def _steady(rows: Sequence[Rows]) -> bool:
    return all(np.ptp(r.piece.of("duty")) < STEADY for r in rows)


def _only_gain(rows: Sequence[Rows], index: int) -> bool:
    """Whether a gain makes a record as good as the others, by a model of the others.

    And the same gain suits its terms one by one: an amplifier multiplies all of a force, physics
    that is missing one term of it. A record in which a single term rules tells nothing.
    """
    others = [r for i, r in enumerate(rows) if i != index]
    theta = model(others)
    if not _one_gain(rows[index], theta):
        return False

    def misfit(r: Rows, gain: float | None = 1.0) -> float:
        F, m = r.force[r.smooth], (r.columns @ theta)[r.smooth]
        if gain is None:
            gain = float(F @ m) / max(float(m @ m), 1e-300)
        return float(np.sqrt(np.mean((F - gain * m) ** 2))) if len(F) else np.inf

    usual = median([misfit(r) for r in others])
    before, after = misfit(rows[index]), misfit(rows[index], None)
    return after < LIKE_OTHERS * usual and after**2 < (1.0 - EXPLAINED) * before**2


def _one_gain(r: Rows, theta: Array) -> bool:
    """Whether all strong terms of a record's force have one gain, by a model of the others."""
    F, A = r.force[r.smooth], r.columns[r.smooth]
    terms = np.column_stack([A[:, c] @ theta[c] for c in TERMS])
    m = terms.sum(axis=1)
    square = float(m @ m)
    if square == 0.0:
        return False
    gain = float(F @ m) / square
    strong = np.sqrt(np.mean(terms**2, axis=0)) > STRONG * np.sqrt(np.mean(m**2))
    if np.count_nonzero(strong) < 2:
        return False
    weak = gain * terms[:, ~strong].sum(axis=1)
    own = np.linalg.lstsq(terms[:, strong], F - weak, rcond=None)[0]
    return bool((np.abs(own - gain) < SAME_GAIN * abs(gain - 1.0)).all())


def _trend(rows: Sequence[Rows]) -> Array | None:
    """What a test varied (k, p): the duty, by level or by a model, and log speed and stroke."""
    duties = [r.piece.of("duty") for r in rows]
    motion = [
        [np.log(max(float(np.std(v)), 1e-12)) for v in (r.piece.xdot, r.piece.x)] for r in rows
    ]
    if _steady(rows):
        at = np.array([round(median(d), 2) for d in duties])
        levels = np.array(sorted(set(at.tolist())))
        if len(levels) > len(rows) // 2:
            return None
        return np.column_stack([at[:, None] == levels, np.array(motion)]).astype(np.float64)
    theta = model(rows)
    out = []
    for r, m in zip(rows, motion, strict=True):
        viscous, field = (float(np.std(r.columns[:, c] @ theta[c])) for c in ([3, 4], [5, 6, 7]))
        whole = float(np.std(r.columns @ theta))
        out.append([1.0, np.log(max(whole, 1e-12)), *m, field / max(viscous + field, 1e-12)])
    return np.array(out)


def _zeroed(rows: Sequence[Rows]) -> RigFault | None:
    """By the zero that suits it, beside a model of all."""
    theta = model(rows)
    zeros, trend = [], []
    for r in rows:
        rest = (r.force - r.columns @ theta)[r.smooth]
        zeros.append(median(rest) if len(rest) else 0.0)
        trend.append([1.0, float(r.piece.x.mean())])
    span = spread(np.concatenate([r.piece.force for r in rows]))
    found = _clearest(zeros, np.array(trend), [OFFSET * span] * len(rows), PRIOR_OFFSET * span)
    if found is None:
        return None
    return RigFault(
        "record_offset", rows[found.index].piece.record,
        f"its force has a zero {found.difference:+.4g} N beside the other records', which differ by"
        f" {found.scatter:.2g} N",
        "it is left out of fits; set the load cell to zero before every run, or give diagnose"
        " --record-offsets", blocks=True,
    )  # fmt: skip


def _late(rows: Sequence[Rows]) -> RigFault | None:
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
        unit = cycle if _steady(rows) else 1.0
        seen.append(r)
        lags.append(lag[0] / unit)
        cycles.append(cycle)
        clear = lag[1] > LAG_EXPLAINED
        least.append(max(LAG, LAG_STEPS * r.piece.step) / unit if clear else np.inf)
    if len(seen) < LEAST_RECORDS:
        return None
    trend = _trend(seen) if _steady(seen) else None
    if trend is None:
        trend = np.column_stack([np.ones(len(seen)), cycles])
    found = _clearest(lags, trend, least, PRIOR_LAG if _steady(rows) else PRIOR_LAG_SECONDS)
    if found is None:
        return None
    way = "later" if found.difference > 0 else "earlier"
    unit = cycles[found.index] if _steady(rows) else 1.0
    return RigFault(
        "record_lag", seen[found.index].piece.record,
        f"its force is {1e3 * abs(found.difference) * unit:.3g} ms {way} against the motion than"
        f" in the other records, which differ by {1e3 * found.scatter * unit:.2g} ms",
        "it is left out of fits; look at the filters and the clocks of both channels", blocks=True,
    )  # fmt: skip


def _lag_of(
    modelled: Array, force: Array, use: npt.NDArray[np.bool_], step: float
) -> tuple[float, float] | None:
    """Lag of the force (n,) behind a model of it [s], and the part of the misfit that it takes."""
    if not use.any():
        return None
    m, f = (np.where(use, v - v[use].mean(), 0.0) for v in (modelled, force))
    most = min(int(LONGEST_LAG / step), len(f) // 8) if step > 0 else 0
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

"""A record whose force has another gain, zero, lag, noise or duty than the others have.

Each record is a few numbers: the size of its force, its mean, its lag behind a model, its noise.
Over the records of a test these follow what the test varied, the duty, speed and stroke, with
little scatter and whatever the physics; so a number is held against the straight-line trend of the
others, in units of their scatter (an externally studentised residual).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.linear_model import (
    LEAST_RECORDS,
    Rows,
    best_rows,
    first_of_each,
    levels_and_motion,
    model,
    of_others,
    steady,
)
from erdctl.bench.rig.pieces import THIN, Piece, spread
from erdctl.bench.rig.record_duty import mislabelled
from erdctl.bench.rig.record_lag import late
from erdctl.bench.rig.record_motion import misread
from erdctl.bench.rig.trend import clearest
from erdctl.core.quantiles import median, percentiles
from erdctl.core.recording import Array

# Records of one damper in one state differ by some per cent (2 to 6 % on a real rig): the scatter
# of a few others is taken together with such a prior, which counts like so many more degrees.
PRIOR_GAIN, PRIOR_OFFSET, PRIOR_NOISE = 0.03, 0.01, 0.2  # the last of the noise itself
LONG_ENOUGH, WHITE = 200, 1.2  # samples that noise is told from; see `white_noise`
PER_CYCLE = 24  # samples, of which the jumps at two reversals take a third of the third differences
GAIN, OFFSET, NOISE = 0.12, 0.04, 3.5  # least change: of 1, of the force's range, of the noise
GROSS, UNCERTAIN = float(np.log(100.0)), 4.0  # a factor that no test has; one that it may have
EXPLAINED, LIKE_OTHERS = 0.8, 1.5  # part of the misfit that a gain takes; times the others' rest
BEYOND = 2.5  # times what a model misses of the others, which of a weak record may be all of it
# Columns of the spring with the zero, of the viscous, and of the yield force with friction; the
# part of a force from which a term is strong; the part of its change by which its gain may differ.
TERMS = ([0, 1, 2], [3, 4], [5, 6, 7])
STRONG, SAME_GAIN = 0.2, 0.3
AT_REST = 0.01  # of the longest stroke
ZERO_EXPLAINED = 0.5  # part of a misfit to a model of the others that a zero takes
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
    # What friction holds at rest is any force between its ends, and tells no zero and no gain.
    least = AT_REST * max(spread(p.x) for p in found)
    moving = [p for p in found if spread(p.x) > least and p.record not in loud]
    rows = best_rows(first_of_each(moving)) if moving else []
    kinds: tuple[Callable[[Sequence[Rows]], RigFault | None], ...]
    kinds = (mislabelled, misread, _gained, _zeroed, late)
    for kind in kinds:
        # The clearest first: left in, it widens the scatter that the next is held against.
        for _ in range(max(1, len(rows) // 3)):
            fault = kind(rows) if len(rows) >= LEAST_RECORDS else None
            if fault is None:
                break
            out.append(fault)
            rows = [r for r in rows if r.piece.record != fault.record]
    return out


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
        away = clearest(np.log(levels).tolist(), trend, least, PRIOR_NOISE)
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
    """By the logarithm of the size of its force, over duty, speed and stroke.

    Where the control changes within records, over the size by a model of the others.
    """
    values = [float(np.log(_size(r.force))) for r in rows]
    for i, value in enumerate(values):
        others = [v for k, v in enumerate(values) if k != i]
        gross = abs(value - median(others)) > GROSS and _same_speed(rows, i)
        if gross and not (value < median(others) and _is_weak(rows, i)):
            return _gain_fault(rows[i], float(np.exp(value - median(others))), np.log(UNCERTAIN))
    if steady(rows):
        trend = levels_and_motion(rows)
    else:
        trend = np.ones((len(rows), 1))
        values = [
            v - float(np.log(_size(r.columns @ of_others(rows, i))))
            for i, (v, r) in enumerate(zip(values, rows, strict=True))
        ]
    if trend is None:
        return None
    found = clearest(values, trend, [float(np.log1p(GAIN))] * len(rows), PRIOR_GAIN)
    # Where the control changes within records a model decides, too.
    if found is None:
        return None
    ratio = float(np.exp(found.difference))
    if not (steady(rows) or _only_gain(rows, found.index, ratio)):
        return None
    return _gain_fault(rows[found.index], ratio, found.scatter)


def _size(force: Array) -> float:
    """Of a force (n,) without its outermost samples [N]."""
    thin = force[:: 1 + len(force) // THIN]
    low, high = percentiles(thin, 2.0, 98.0)
    return max(float(np.std(np.clip(thin, low, high))), 1e-12)


def _gain_fault(r: Rows, ratio: float, scatter: float) -> RigFault:
    close = max(0.03, 2.0 * scatter)
    fitting = [u for u, f in UNITS.items() if abs(np.log(ratio / f)) < close]
    known = f", as if it were in {fitting[0]}" if len(fitting) == 1 else ""
    return RigFault(
        "record_gain", r.piece.record,
        f"its force is {ratio:.3g} times what the other records say{known}; these differ from their"
        f" trend by {100 * scatter:.2g} %",
        "it is left out of fits; look at the amplifier's range, the unit and what its duty was; if"
        " the damper itself changed, diagnose this record alone", blocks=True,
    )  # fmt: skip


def _is_weak(rows: Sequence[Rows], index: int) -> bool:
    """Whether a record's force is as small as a model of the others has it, as without a field."""
    modelled = _size(rows[index].columns @ of_others(rows, index))
    return _size(rows[index].force) > modelled / UNCERTAIN


def _same_speed(rows: Sequence[Rows], index: int) -> bool:
    """Whether a record is about as fast as the others, so that its force is about as large."""
    speeds = [float(np.std(r.piece.xdot)) for r in rows]
    usual = median(speeds)
    return usual / UNCERTAIN < speeds[index] < usual * UNCERTAIN


def _only_gain(rows: Sequence[Rows], index: int, ratio: float) -> bool:
    """Whether a gain makes a record as good as the others, by a model of the others.

    It is the ratio of their sizes, or what differs is the shape. And the same gain suits its terms
    one by one: an amplifier multiplies all of a force, physics that is missing one term of it. A
    record in which a single term rules tells nothing.
    """
    theta = of_others(rows, index)
    others = [r for i, r in enumerate(rows) if i != index]
    if not _one_gain(rows[index], theta):
        return False

    def misfit(r: Rows, gain: float) -> float:
        F, m = r.force[r.smooth], (r.columns @ theta)[r.smooth]
        return float(np.sqrt(np.mean((F - gain * m) ** 2))) if len(F) else np.inf

    r = rows[index]
    F, m = r.force[r.smooth], (r.columns @ theta)[r.smooth]
    gain = float(F @ m) / max(float(m @ m), 1e-300)
    if abs(gain - ratio) > SAME_GAIN * abs(gain - 1.0):
        return False
    before, after = misfit(r, 1.0), misfit(r, gain)
    missed = median([misfit(o, 1.0) for o in others])
    # What the model misses is multiplied as well; noise may come behind the amplifier.
    usual = max(abs(gain) * missed, r.piece.noise("force")[0])
    taken = after < LIKE_OTHERS * usual and after**2 < (1.0 - EXPLAINED) * before**2
    return taken and before > BEYOND * missed


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


def _zeroed(rows: Sequence[Rows]) -> RigFault | None:
    """By the zero that suits it, beside a model of all."""
    theta = model(rows)
    zeros, trend = [], []
    for r in rows:
        rest = (r.force - r.columns @ theta)[r.smooth]
        zeros.append(median(rest) if len(rest) else 0.0)
        trend.append([1.0, float(r.piece.x.mean())])
    span = spread(np.concatenate([r.piece.force for r in rows]))
    found = clearest(zeros, np.array(trend), [OFFSET * span] * len(rows), PRIOR_OFFSET * span)
    if found is None or not _only_zero(rows, found.index):
        return None
    return RigFault(
        "record_offset", rows[found.index].piece.record,
        f"its force has a zero {found.difference:+.4g} N beside the other records', which differ by"
        f" {found.scatter:.2g} N",
        "it is left out of fits; set the load cell to zero before every run, or give diagnose"
        " --record-offsets", blocks=True,
    )  # fmt: skip


def _only_zero(rows: Sequence[Rows], index: int) -> bool:
    """Whether a constant is most of what a record has beside a model of the others.

    A zero moves all of a force, from the first sample on. Physics that is missing leaves a mean
    here and there as well, where a gas is compressed one that a curve over the deflection makes,
    and where it warms one that grows from none.
    """
    r = rows[index]
    rest = (r.force - r.columns @ of_others(rows, index))[r.smooth]
    if not len(rest) or np.var(rest) > (1.0 - ZERO_EXPLAINED) * np.mean(rest**2):
        return False
    x = r.columns[r.smooth, 1] + r.columns[r.smooth, 2]
    x = (x - x.mean()) / max(float(np.std(x)), 1e-12)
    t = np.linspace(0.0, 1.0, len(r.smooth))[r.smooth]
    A = np.column_stack([np.ones_like(x), x, x * x, t])
    return bool(np.linalg.lstsq(A, rest, rcond=1e-9)[0][0] / np.mean(rest) > ZERO_EXPLAINED)

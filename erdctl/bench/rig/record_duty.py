"""A record that was taken at a higher duty than is logged for it, as where a label is wrong."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.linear_model import STEADY, Rows, of_others
from erdctl.core.quantiles import median
from erdctl.core.recording import Array

BEYOND, LIKE_OTHERS = 2.5, 1.5  # times what a model misses of the others, before and after
TAKEN = 0.8  # of the square of the record's misfit
SAME = 0.2  # of the change of the yield force, by which it may differ from that of a level
ALIKE = 0.25  # of speed and stroke, by which a record may be beyond the others
SOUND = 0.5  # of the record's misfit, which those that it is held against must not have
NEARER = 0.5  # times the distance of the next level's yield force
NEXT = 0.02  # of full scale, by which levels differ


@dataclass(frozen=True, eq=False)
class _Against:
    """A record against a model of the others.

    duty : that is logged;  field : its yield force over that model's, U [1];  motion : (2,) speed
        [m/s] and stroke [m];  misfit : to the model [N];  theta : (p,) its parameters
    """

    rows: Rows
    duty: float
    field: float
    motion: Array
    misfit: float
    theta: Array

    @classmethod
    def against(cls, others: Array, r: Rows) -> _Against:
        p, yielding = r.piece, r.columns[r.smooth, 5] - r.columns[r.smooth, 6]
        return cls(
            r, median(p.of("duty")), median(np.abs(yielding)),
            np.array([np.std(p.xdot), np.std(p.x)]),
            _rms((r.force - r.columns @ others)[r.smooth]), others,
        )  # fmt: skip

    def moves_within(self, others: Sequence[_Against]) -> bool:
        """Whether its speed and stroke lie between those of others, or close to one."""
        all_of = np.array([h.motion for h in others])
        low, high = all_of.min(axis=0) / (1.0 + ALIKE), all_of.max(axis=0) * (1.0 + ALIKE)
        return bool(((low <= self.motion) & (self.motion <= high)).all())


def mislabelled(rows: Sequence[Rows]) -> RigFault | None:
    """By a yield force of another level that the log has, in compression and in release.

        F = k_i x + c_i xdot + S_i U sign(xdot) + friction,   U in place of duty^beta

    All but U is that of the other records. Others are logged at the same level and at the one that
    is found, others are as fast and as slow, with as long strokes and as short ones, and none of
    them is off as it is: so neither a law of the field is missing nor one of the motion. Another
    with a field came before it, or the supply may have failed behind it. A lower duty than logged
    is left to the diagnosis: an electrical fault leaves less voltage as well.
    """
    held = [_Against.against(of_others(rows, i), r) for i, r in enumerate(rows)]
    missed = median([h.misfit for h in held])
    for own in sorted(held, key=lambda h: -h.misfit):
        if own.misfit < BEYOND * missed:
            break
        level = _level(own, [h for h in held if h.misfit < SOUND * own.misfit], missed)
        if level is not None:
            return RigFault(
                "record_duty", own.rows.piece.record,
                f"its yield force is that of other records at {100 * level:.3g} % duty, and"
                f" {100 * own.duty:.3g} % is logged for it",
                "it is left out of fits; look at what its duty was; if the damper itself changed,"
                " diagnose this record alone", blocks=True,
            )  # fmt: skip
    return None


def _level(own: _Against, sound: Sequence[_Against], missed: float) -> float | None:
    """The higher duty that a record was taken at; None if it was not, or that is not sure."""
    r = own.rows
    if np.ptp(r.piece.of("duty")) >= STEADY:
        return None
    if not any(h.duty > NEXT and h.rows.piece.record < r.piece.record for h in sound):
        return None  # it may be the last that had all of its field
    if not any(abs(h.duty - own.duty) < NEXT for h in sound) or not own.moves_within(sound):
        return None
    A, F, theta = r.columns[r.smooth], r.force[r.smooth], own.theta
    unit = np.where(A[:, 7] > 0.0, theta[5], -theta[6])
    rest = F - A @ np.where(np.isin(np.arange(len(theta)), (5, 6)), 0.0, theta)
    found = float(unit @ rest) / max(float(unit @ unit), 1e-300)
    change = found - own.field
    level = _nearest(found, own, sound)
    if level is None or abs(found - level.field) > SAME * change:
        return None
    left = _rms(rest - found * unit)
    usual = max(missed, r.piece.noise("force")[0])
    if left > LIKE_OTHERS * usual or left**2 > (1.0 - TAKEN) * own.misfit**2:
        return None
    if left > _rms_with_a_gain(A @ theta, F):
        return None
    return level.duty


def _nearest(field: float, own: _Against, sound: Sequence[_Against]) -> _Against | None:
    """The one of a higher level that has such a yield force; None where two have nearly that."""
    held = [h for h in sound if np.ptp(h.rows.piece.of("duty")) < STEADY]
    by_distance = sorted(held, key=lambda h: abs(h.field - field))
    if not by_distance or by_distance[0].duty < own.duty + NEXT:
        return None
    first = by_distance[0]
    next_level = next((h for h in by_distance if abs(h.duty - first.duty) > NEXT), own)
    sure = abs(first.field - field) < NEARER * abs(next_level.field - field)
    return first if sure else None


def _rms_with_a_gain(modelled: Array, force: Array) -> float:
    """What a gain of all of the force leaves, in place of another yield force [N]."""
    gain = float(modelled @ force) / max(float(modelled @ modelled), 1e-300)
    return _rms(force - gain * modelled)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0

"""Records of one kind of excitation, which are left out of a fit together.

A law that only fits the excitations at hand predicts a record well by the others of its kind, and
fails at the next stroke, frequency or level of control. What is left out together shows that.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose import thresholds


def excitation(recording: Recording) -> Array:
    """(r, 4) of each record: log of effective stroke and speed, mean and spread of the duty.

    Differences are then relative ones of the motion, and ones of the duty.
    """
    sizes = [[float(np.std(v[s])) for v in (recording.x, recording.xdot)] for s in recording.slices]
    duty = [
        [float(recording.duty[s].mean()), float(recording.duty[s].std())] for s in recording.slices
    ]
    return np.hstack([np.log(np.maximum(sizes, 1e-12)), duty])


def kinds_of_motion(recording: Recording, *, coarse: bool = False) -> Index | None:
    """(n,) kind of motion of each sample; None if every record is of its own kind, or all of one.

    Of one kind are records whose effective stroke and speed differ by less than a factor of
    KIND_FACTOR, or that are joined by others in between; where that makes more than MOST_KINDS, so
    many, each as narrow as can be.

    coarse : records that are each of their own kind are of COARSE_KINDS, each as narrow as can be
    """
    at = excitation(recording)[:, :2]
    if len(at) < 2:
        return None
    found = _of_most(at)
    if coarse and found.max() == len(at):
        found = _of_most(at, thresholds.COARSE_KINDS)
    return _along(recording, found - 1, thresholds.MOTION_KINDS)


def duties_of_records(recording: Recording) -> list[Array]:
    """Duties that each record holds, over the largest of all, by thousandths."""
    most = max(float(recording.duty.max()), 1e-12)
    return [np.unique(np.round(recording.duty[s] / most, 3)) for s in recording.slices]


def duties_known(recording: Recording) -> npt.NDArray[np.bool_]:
    """(r,) whether the other records hold most of a record's duties, see `held_by_others`."""
    duties = duties_of_records(recording)
    if len(duties) < 2:
        return np.zeros(len(duties), dtype=bool)
    others = (duties[:r] + duties[r + 1 :] for r in range(len(duties)))
    return np.array([held_by_others(d, o) for d, o in zip(duties, others, strict=True)])


def held_by_others(duties: Array, others: Sequence[Array]) -> bool:
    """Whether most of some duties are near such as others hold.

    Levels far from those of all others tell what no other record does, where a yield stress levels
    off between them, say; a law is not to be judged by what its fit could not see.
    >>> held_by_others(np.array([0.0, 0.3]), [np.array([0.0, 0.5]), np.array([0.28, 1.0])])
    True
    >>> held_by_others(np.array([0.0, 0.3]), [np.array([0.0, 0.5, 1.0])])
    False
    """
    known = np.unique(np.concatenate(others))
    after = np.clip(np.searchsorted(known, duties), 1, max(len(known) - 1, 1))
    near = known[np.minimum(np.stack([after - 1, after]), len(known) - 1)]
    apart = np.abs(near - duties).min(axis=0)
    return float(np.mean(apart > thresholds.DUTY_NEAR)) < thresholds.DUTY_FAR


def motions(recording: Recording) -> int:
    """Number of kinds of motion, as `kinds_of_motion` joins records to kinds."""
    return int(motion_of_records(recording).max())


def motion_of_records(recording: Recording) -> Index:
    """(r,) kind of each record's motion, from 1, however many there are."""
    at = excitation(recording)[:, :2]
    return _joined(at) if len(at) > 1 else np.ones(len(at), dtype=np.intp)


def _joined(at: Array) -> Index:
    """(r,) kind of each record, from 1: those nearer than KIND_FACTOR, or joined by others."""
    from scipy.cluster.hierarchy import fcluster, linkage

    apart = np.log(thresholds.KIND_FACTOR)
    found = fcluster(linkage(at, "single", "chebyshev"), apart, "distance")
    return np.asarray(found, dtype=np.intp)


def _of_most(at: Array, most: int = thresholds.MOST_KINDS) -> Index:
    """(r,) kind of each record as `_joined`; where that makes more than so many, so many."""
    from scipy.cluster.hierarchy import fcluster, linkage

    found = _joined(at)
    if found.max() > most:
        found = np.asarray(fcluster(linkage(at, "complete", "chebyshev"), most, "maxclust"))
    return found.astype(np.intp)


def levels_of_duty(recording: Recording) -> Index | None:
    """(n,) steady duty of each sample's record, numbered; None if a record has several."""
    duty = [recording.duty[s] for s in recording.slices]
    if any(np.ptp(d) > thresholds.KIND_DUTY for d in duty):
        return None
    levels = np.round([float(d.mean()) / thresholds.KIND_DUTY for d in duty])
    found = np.unique(levels, return_inverse=True)[1]
    return _along(recording, np.asarray(found, dtype=np.intp), thresholds.CONTROL_KINDS)


def _along(recording: Recording, kinds: Index, least: int) -> Index | None:
    count = len(set(kinds.tolist()))
    if not least <= count < len(kinds):
        return None
    return np.repeat(kinds, np.diff(recording.starts))

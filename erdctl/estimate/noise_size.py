"""Noise that is not everywhere the same: its size by that of the force, and by record."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index

LEVELS = 10  # of |force|, with equal numbers of samples, between which the size is a straight line
ENOUGH = 100  # samples in each; fewer make fewer levels


def within_records(residual: Array, force: Array, one: Array, starts: Index) -> Array:
    """(n,) a residual [N] beyond the gain and the zero of each record that fit it best.

    residual, force, one : (n,) times the root of the weight
    """
    out = np.array(residual)
    for a, b in pairwise(starts.tolist()):
        columns = np.array([force[a:b], one[a:b]])
        if np.count_nonzero(one[a:b]) < ENOUGH:
            continue
        gram, right = columns @ columns.T, columns @ residual[a:b]
        out[a:b] -= np.linalg.lstsq(gram, right, rcond=1e-10)[0] @ columns
    return out


def innovation_size(
    innovations: Array, force: Array, used: npt.NDArray[np.bool_], starts: Index
) -> Array:
    """(n,) standard deviation of the innovations (n,) of a residual at each sample [N].

        E e_i^2 = d(|F_i|) f_r

    force : (n,) |F| of the model [N];  used : (n,) samples that count
    d : line through the means of e^2 over levels of |F|;  f_r : of record r, mean 1 over samples
    """
    e2 = innovations**2
    sure = used.copy()
    sure[1:] &= used[:-1]  # after a gap the model has nothing to predict from
    count = int(np.count_nonzero(sure))
    mean = float(e2[sure].mean()) if count else 0.0
    size = np.full(len(e2), mean)
    levels = min(LEVELS, count // ENOUGH)
    if levels > 1 and mean > 0.0:
        at = np.flatnonzero(sure)
        parts = np.array_split(at[np.argsort(force[at], kind="stable")], levels)
        centre = [float(force[i].mean()) for i in parts]
        size = np.interp(force, centre, [float(e2[i].mean()) for i in parts])
    for a, b in pairwise(starts.tolist()):
        here = np.flatnonzero(sure[a:b]) + a
        if len(here) >= ENOUGH and size[here].sum() > 0.0:
            size[a:b] *= e2[here].sum() / size[here].sum()
    return np.asarray(np.sqrt(size))

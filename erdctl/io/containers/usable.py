"""What of the samples that a library hands out can become a column."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from erdctl.core.messages import counted
from erdctl.core.recording import Array
from erdctl.io.containers.channels import Samples


def checked(samples: Samples, time: Array | None) -> tuple[npt.NDArray[Any], Array] | str:
    """The samples as they can be used, or why they cannot."""
    values = sound(samples.values)
    if values is None:
        return "neither numbers nor text, one for each sample"
    if not values.size:
        return "it has no samples"
    if time is None:
        return samples.why or (
            "it has no time; neither a sampling interval nor a channel called t or time is stored"
            ' with it; if another channel is the time, say so, e.g. --map "t=NAME[s]"'
        )
    if len(time) != len(values):
        return f"it has {counted(len(values), 'sample')}, and its time has {len(time)}"
    return values, time


def sound(values: npt.NDArray[Any]) -> npt.NDArray[Any] | None:
    """(n,) numbers in the machine's byte order, logicals, text or points of time; else None."""
    values = np.asarray(values)
    if values.ndim != 1:
        return None
    if values.dtype.kind == "S":
        return np.array([v.decode(errors="replace") for v in values.tolist()], object)
    if values.dtype.kind == "U" or (
        values.dtype.kind == "O" and all(isinstance(v, str) for v in values.tolist())
    ):
        return values.astype(object)
    if values.dtype.kind in "iuf" and values.dtype.itemsize <= 8:
        return values.astype(values.dtype.newbyteorder("="), copy=False)
    return values if values.dtype.kind in "bMm" else None


def numbers(values: npt.NDArray[Any] | None) -> Array | None:
    """(n,) float64, None if they are not numbers; points of time in seconds from the first."""
    if values is not None and values.dtype.kind == "M" and values.size:
        values = values - values[0]
    if values is not None and values.dtype.kind == "m":
        return np.asarray(values / np.timedelta64(1, "ns") * 1e-9, np.float64)
    if values is None or values.dtype.kind not in "iuf":
        return None
    return values.astype(np.float64)

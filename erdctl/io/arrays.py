"""Arrow arrays of numbers as NumPy arrays and back, without a copy.

pyarrow's own `to_numpy` and `pa.array` import pandas if it is installed: 0.15 s at every start.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from erdctl.core.recording import Array

MOST_BYTES = 2**31 - 1  # of one text array: its offsets are 32-bit


def view(array: pa.Array) -> npt.NDArray[Any]:
    """(n,) the values of an array of a number type without nulls, read-only."""
    dtype = np.dtype(str(array.type).replace("double", "float64"))
    data = array.buffers()[1]
    if data is None:
        return np.empty(0, dtype)
    return np.frombuffer(data, dtype, len(array), array.offset * dtype.itemsize)


def arrow(values: Array) -> pa.Array:
    """The Arrow array of (n,) float64 values."""
    values = np.ascontiguousarray(values)
    return pa.Array.from_buffers(pa.float64(), len(values), [None, pa.py_buffer(values)])


def runs_of_text(
    texts: Sequence[str], lengths: npt.NDArray[np.intp], kind: pa.DataType
) -> pa.ChunkedArray:
    """The text column of type `kind` that holds each text so many times in a row."""
    encoded = [text.encode() for text in texts]
    sizes = np.array([len(e) for e in encoded], np.int64)
    wide = pa.types.is_large_string(kind)
    if not wide and int(sizes @ lengths) > MOST_BYTES:
        half = int(lengths.sum()) // 2
        first = np.clip(half - (np.cumsum(lengths) - lengths), 0, lengths)
        parts = [runs_of_text(texts, part, kind).chunks for part in (first, lengths - first)]
        return pa.chunked_array([chunk for part in parts for chunk in part], kind)
    offsets = np.concatenate([[0], np.cumsum(np.repeat(sizes, lengths))])
    offsets = offsets.astype(np.int64 if wide else np.int32)
    data = b"".join(e * n for e, n in zip(encoded, lengths.tolist(), strict=True))
    buffers = [None, pa.py_buffer(offsets), pa.py_buffer(data)]
    return pa.chunked_array([pa.Array.from_buffers(kind, len(offsets) - 1, buffers)])

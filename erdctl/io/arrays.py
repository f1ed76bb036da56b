"""Arrow arrays of numbers as NumPy arrays and back, without a copy.

pyarrow's own `to_numpy` and `pa.array` import pandas if it is installed: 0.15 s at every start.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from erdctl.recording import Array


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
) -> pa.Array:
    """The text array of type `kind` that holds each text so many times in a row."""
    encoded = [text.encode() for text in texts]
    sizes = np.repeat([len(e) for e in encoded], lengths)
    wide = np.int64 if pa.types.is_large_string(kind) else np.int32
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(wide)
    data = b"".join(e * n for e, n in zip(encoded, lengths.tolist(), strict=True))
    return pa.Array.from_buffers(
        kind, len(sizes), [None, pa.py_buffer(offsets), pa.py_buffer(data)]
    )

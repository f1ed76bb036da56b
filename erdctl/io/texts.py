"""Text that is stored once and said often: how much it is when it is written out."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from erdctl.core.memory import check_claim
from erdctl.core.recording import Index
from erdctl.io.arrays import view

_SMALL = 1 << 24  # bytes that need no exact count


def check_texts(table: pa.Table, size: int, name: str) -> None:
    """Raise InputProblem if the dictionary-encoded text of a table opens to more than a log can
    have; size : bytes of the file."""
    for field, column in zip(table.schema, table.columns, strict=True):
        if pa.types.is_dictionary(field.type) and is_text(field.type.value_type):
            check_claim(_opened(column), size, name, f"column '{field.name}'", copies=1)


def is_text(kind: pa.DataType) -> bool:
    """Whether a type holds texts or bytes, each of its own length."""
    kinds = (pa.string(), pa.large_string(), pa.binary(), pa.large_binary(), pa.string_view())
    return kind in kinds


def _opened(column: pa.ChunkedArray) -> int:
    """Bytes of all texts of a column; an upper bound where that is small enough."""
    total = 0
    for chunk in column.chunks:
        lengths = _lengths(chunk.dictionary)
        bound = int(lengths.max(initial=0)) * len(chunk)
        if bound > _SMALL:
            indices = chunk.indices.drop_null() if chunk.null_count else chunk.indices
            bound = int(lengths[view(indices)].sum())
        total += bound
    return total


def _lengths(texts: pa.Array) -> Index:
    """(k,) bytes of each text.

    By where each ends, as Arrow stores it: its own functions take longer to import than most logs
    to read.
    """
    kinds = {pa.string(): "i4", pa.binary(): "i4", pa.large_string(): "i8", pa.large_binary(): "i8"}
    if texts.type not in kinds:
        return np.array([len(text or b"") for text in texts.cast(pa.binary()).to_pylist()], np.intp)
    ends = texts.buffers()[1]
    if ends is None or not len(texts):
        return np.zeros(len(texts), np.intp)
    ends = np.frombuffer(ends, kinds[texts.type])[texts.offset :][: len(texts) + 1]
    return np.diff(ends).astype(np.intp)

"""Text that is stored once and said often: how much it is when it is written out."""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from erdctl.core.memory import check_claim

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
        # Before the lengths themselves, which need an import that takes longer than most logs.
        bound = chunk.dictionary.nbytes * len(chunk)
        if bound > _SMALL:
            bound = _lengths(chunk)
        total += bound
    return total


def _lengths(chunk: pa.DictionaryArray) -> int:
    import pyarrow.compute as pc

    lengths: Any = pc.binary_length(chunk.dictionary)
    bound: int = (pc.max(lengths).as_py() or 0) * len(chunk)
    if bound > _SMALL:
        bound = pc.sum(pc.take(lengths, chunk.indices)).as_py() or 0
    return bound

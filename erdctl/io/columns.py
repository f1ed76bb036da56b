"""Arrow columns as what a Recording is made of: float64 arrays and records."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from erdctl.core.recording import Array, Index
from erdctl.io.arrays import view
from erdctl.io.checks import Place


def to_numbers(column: pa.ChunkedArray, name: str, place: Place) -> Array:
    """(n,) float64 of a column of integers, floats or decimals; no copy where none is needed.

    Raises InputProblem at the first empty cell, and for columns that hold something else.
    """
    if pa.types.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    if column.null_count:
        import pyarrow.compute as pc

        at = pc.index(pc.is_null(column), True).as_py()
        raise place.problem(
            "empty, expected a number; remove the rows without a value, or fill them in", at, name
        )
    kind = column.type
    if not (pa.types.is_floating(kind) or pa.types.is_integer(kind) or pa.types.is_decimal(kind)):
        raise place.problem(*_not_numbers(column), name)
    if kind != pa.float64():
        # Unsafe only for integers beyond 2^53, which no check lets pass.
        column = column.cast(pa.float64(), safe=False)
    chunks = [view(chunk) for chunk in column.chunks]
    return chunks[0] if len(chunks) == 1 else np.concatenate([np.empty(0), *chunks])


def to_records(column: pa.ChunkedArray, name: str, place: Place) -> tuple[Index, tuple[str, ...]]:
    """Offsets of the runs of equal values, and each as text.

    Raises InputProblem for empty cells, and at a record that comes back after another.
    """
    if column.null_count:
        import pyarrow.compute as pc

        at = pc.index(pc.is_null(column), True).as_py()
        raise place.problem("empty, expected the name of a record", at, name)
    whole = column.combine_chunks()
    if isinstance(whole, pa.ChunkedArray):  # too long for one array
        raise place.problem("too long for one log; split it", None, name)
    try:
        if not pa.types.is_dictionary(whole.type):
            whole = whole.dictionary_encode()
        labels = _text(whole.dictionary)
    except (pa.ArrowNotImplementedError, pa.ArrowInvalid):
        raise place.problem(f"holds {column.type}, expected text", None, name) from None
    keys = view(whole.indices)
    starts = np.concatenate([[0], np.flatnonzero(keys[1:] != keys[:-1]) + 1])
    names = tuple(labels[key] for key in keys[starts])
    seen: set[str] = set()
    for record, start in zip(names, starts.tolist(), strict=True):
        if record in seen:
            raise place.problem(
                f"record '{record}' comes back after another record; sort the rows by record",
                start,
                name,
            )
        seen.add(record)
    if "" in seen:
        raise place.problem(
            "empty, expected the name of a record", int(starts[names.index("")]), name
        )
    return np.append(starts, len(whole)).astype(np.intp), names


def _text(values: pa.Array) -> list[str]:
    # Casting text to text would import the compute functions for nothing, at every start.
    text: list[str] = (
        values if pa.types.is_string(values.type) else values.cast(pa.string())
    ).to_pylist()
    return text


def _not_numbers(column: pa.ChunkedArray) -> tuple[str, int | None]:
    """What a column of no numbers holds, and where it shows first."""
    if pa.types.is_temporal(column.type):
        return "holds dates or durations, expected a number; subtract the first and divide", None
    try:
        text = column.cast(pa.string())
    except (pa.ArrowNotImplementedError, pa.ArrowInvalid):
        return f"holds {column.type}, expected a number", None
    low, high = 0, len(text)
    # Halving finds the first cell that is no number with casts of twice the column at most.
    while high - low > 1:
        middle = (low + high) // 2
        if _castable(text.slice(low, middle - low)):
            low = middle
        else:
            high = middle
    if _castable(text.slice(low, 1)):
        return f"holds numbers as {column.type}; store them as float64", None
    return f"found '{text[low].as_py()[:40]}', expected a number", low


def _castable(text: pa.ChunkedArray) -> bool:
    try:
        text.cast(pa.float64())
    except pa.ArrowInvalid:
        return False
    return True

"""Points of time and durations as seconds."""

from __future__ import annotations

import pyarrow as pa

_PER_SECOND = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}


def in_seconds(column: pa.ChunkedArray, name: str) -> tuple[pa.ChunkedArray, str] | None:
    """The column in seconds (float64) and what was done, None if it holds no times.

    Timestamps of any resolution and zone, dates and times of day count from the first one that is
    there; the difference is taken in whole ticks, so that none is rounded. Durations keep their
    zero. Empty cells stay empty.
    """
    if pa.types.is_dictionary(column.type) and pa.types.is_temporal(column.type.value_type):
        column = column.cast(column.type.value_type)
    kind = column.type
    if not pa.types.is_temporal(kind) or pa.types.is_interval(kind):
        return None
    import pyarrow.compute as pc  # takes longer to import than most logs to read

    if pa.types.is_date(kind):
        column = column.cast(pa.timestamp("ms"))
        kind = column.type
    ticks = column.cast(pa.int32()) if kind.bit_width == 32 else column
    ticks = ticks.cast(pa.int64())
    per_second = float(_PER_SECOND[kind.unit])
    if pa.types.is_duration(kind):
        return pc.divide(ticks.cast(pa.float64(), safe=False), per_second), (
            f"'{name}' holds durations; taken in seconds"
        )
    first = pc.min(pc.drop_null(ticks).slice(0, 1)).as_py()
    if first is None:
        return pc.divide(ticks.cast(pa.float64(), safe=False), per_second), f"'{name}' is empty"
    start = pc.drop_null(column).slice(0, 1)[0].cast(pa.string()).as_py()
    since = pc.subtract(ticks, pa.scalar(first, pa.int64())).cast(pa.float64(), safe=False)
    return pc.divide(since, per_second), (
        f"'{name}' holds points of time; taken in seconds from the first one, {start}"
    )

"""CSV out, and what becomes of the text of CSV cells that nobody computes with.

CSV knows no types. Columns that pass through a command stay the text they are, so that a CSV log
gives them back to the letter (`007`, `1.50`); in a typed format they become numbers where that
loses nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pyarrow as pa

from erdctl.core.errors import UsageProblem
from erdctl.io.stored import header

ROWS = 1 << 16  # formatted at a time
_MARK = {b"erdctl": b"text of CSV cells"}
_KEY = next(iter(_MARK))


def as_csv_text(table: pa.Table, columns: Sequence[str]) -> pa.Table:
    """The same table, with text columns marked as cells of a CSV file."""
    schema = table.schema
    for name in columns:
        index = schema.get_field_index(name)
        schema = schema.set(index, schema.field(index).with_metadata(_MARK))
    return table.cast(schema)


def typed(table: pa.Table) -> pa.Table:
    """The same table with cells of a CSV file as numbers where nothing is lost by it.

    A column becomes whole numbers if they print as the same text again; float64 if every cell
    is a number and none begins with a superfluous 0 (`007` is a name). Empty cells become null.
    """
    for index, field in enumerate(table.schema):
        metadata = dict(field.metadata or {})
        if metadata.pop(_KEY, None) is not None:
            column = table.column(index)
            if field.name != "record":  # text in the contract, whatever it looks like
                column = _typed(column)
            table = table.set_column(
                index, pa.field(field.name, column.type, metadata=metadata), column
            )
    return table


def chunks(table: pa.Table, *, head: bool = True) -> Iterator[pa.Buffer]:
    """A table as CSV: a header with units, then lines, numbers as short as reads back exactly.

    head : whether it begins with the header

    Only cells that need quotes get them. Raises UsageProblem for columns that CSV cannot hold.
    """
    import pyarrow.compute as pc

    names = pa.array(header(table.schema), pa.string())
    line = pc.binary_join(pa.array([_quoted(names).to_pylist()]), ",")[0].as_py()
    if head:
        yield pa.py_buffer((line + "\n").encode())
    for batch in table.to_batches(ROWS):
        if not batch.num_rows:
            continue
        cells = [_cells(c, f.name) for c, f in zip(batch.columns, batch.schema, strict=True)]
        # Joined with the line end as a last, empty column, the cells are the lines.
        cells[-1] = pc.binary_join_element_wise(cells[-1], "\n", "")
        lines = pc.binary_join_element_wise(*cells, ",")
        yield _characters(lines)


def _characters(lines: pa.Array) -> pa.Buffer:
    """All characters of an array of text, one after the other, without copying them.

    The buffer behind an array may hold more than belongs to it, before, between and after.
    """
    _, ends, characters = lines.buffers()
    bounds = np.frombuffer(ends, np.int32)[lines.offset : lines.offset + len(lines) + 1]
    first, last = int(bounds[0]), int(bounds[-1])
    return characters.slice(first, last - first)


def _cells(column: pa.Array, name: str) -> pa.Array:
    if pa.types.is_dictionary(column.type):
        column = column.dictionary_decode()
    is_text = pa.types.is_string(column.type) or pa.types.is_large_string(column.type)
    try:
        text = column.cast(pa.string())
    except (pa.ArrowNotImplementedError, pa.ArrowInvalid):
        raise UsageProblem(
            f"column '{name}' holds {column.type}, which CSV cannot hold; write .parquet or .arrow"
        ) from None
    if text.null_count:
        text = text.fill_null("")
    needs_no_quotes = pa.types.is_primitive(column.type) and not is_text
    return text if needs_no_quotes else _quoted(text)


def _quoted(text: pa.Array) -> pa.Array:
    import pyarrow.compute as pc

    special = pc.match_substring_regex(text, '[",\r\n]')
    if not pc.any(special).as_py():
        return text
    doubled = pc.replace_substring(text, '"', '""')
    return pc.if_else(special, pc.binary_join_element_wise('"', doubled, '"', ""), text)


def _typed(column: pa.ChunkedArray) -> pa.ChunkedArray:
    import pyarrow.compute as pc

    empty = pc.equal(column, "")
    if pc.all(empty).as_py():
        return column
    cells = pc.if_else(empty, None, column)
    try:
        whole = cells.cast(pa.int64())
        if pc.all(pc.equal(whole.cast(pa.string()), cells)).as_py():
            return whole
    except pa.ArrowInvalid:
        pass
    if pc.any(pc.match_substring_regex(cells, "^[+-]?0[0-9]")).as_py():
        return column
    try:
        return cells.cast(pa.float64())
    except pa.ArrowInvalid:
        return column

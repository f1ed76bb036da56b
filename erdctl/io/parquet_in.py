"""Parquet in: numbers as they are, text by way of its dictionary where it may open to much."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Any

import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.core.memory import SMALL, check_claim
from erdctl.io.texts import check_texts, is_text

BATCH = 1 << 18  # rows read at a time
_BUFFER = 1 << 20  # bytes of a column
_OWN = ("DELTA_BYTE_ARRAY",)  # each text says what it shares with the one before


def described(file: Any) -> tuple[pa.Schema, int]:
    """Schema and number of rows, as the file states them."""
    import pyarrow.parquet as pq

    opened = pq.ParquetFile(file)
    return opened.schema_arrow, int(opened.metadata.num_rows)


def read(
    file: Any,
    size: int,
    schema: pa.Schema,
    names: Sequence[str],
    labels: Collection[str],
    name: str,
) -> pa.Table:
    """The columns; file : a NativeFile of `size` bytes;  labels : text to stay dictionary-encoded.

    Raises InputProblem if they open to more than memory holds or a log can have.
    """
    opened, risky = _opened(file, size, schema, names, labels, name)
    with opened:
        table = opened.read(columns=list(names)).select(list(names))
    return _sound(table, size, schema, risky, name)


def batches(
    file: Any,
    size: int,
    schema: pa.Schema,
    names: Sequence[str],
    labels: Collection[str],
    name: str,
) -> Iterator[pa.Table]:
    """The same, some rows at a time, however long its row groups are."""
    opened, risky = _opened(file, size, schema, names, labels, name, held=False)
    with opened:
        for batch in opened.iter_batches(BATCH, columns=list(names)):
            table = pa.Table.from_batches([batch]).select(list(names))
            yield _sound(table, size, schema, risky, name)


def _opened(
    file: Any,
    size: int,
    schema: pa.Schema,
    names: Sequence[str],
    labels: Collection[str],
    name: str,
    *,
    held: bool = True,
) -> tuple[Any, list[str]]:
    """The file, and which columns come dictionary-encoded though nobody asked for it."""
    import pyarrow.parquet as pq

    texts = [n for n in names if is_text(schema.field(n).type)]
    # As dictionary indices: text takes longer to read than five columns of numbers.
    coded = [n for n in texts if n in labels]
    # Without its own buffer a column of a row group is read as a whole, and with `pre_buffer` what
    # was read of all of them is kept to the end.
    options: dict[str, Any] = {"page_checksum_verification": True, "pre_buffer": held}
    if not held:
        options["buffer_size"] = _BUFFER
    opened = pq.ParquetFile(file, read_dictionary=coded, **options)
    metadata = opened.metadata
    leaves = _leaves(metadata, names)
    decoded = sum(
        chunk.num_values * _width(schema.field(column).type)
        for column, chunks in leaves.items()
        for chunk in chunks
    )
    check_claim(decoded, size, name, f"its {len(names)} columns", held=held)
    _refuse_prefixes({n: leaves[n] for n in texts}, name)
    risky = [n for n in texts if n not in coded and _may_open(leaves[n])]
    if risky:
        coded += risky
        opened = pq.ParquetFile(file, metadata=metadata, read_dictionary=coded, **options)
    return opened, risky


def _sound(
    table: pa.Table, size: int, schema: pa.Schema, risky: Sequence[str], name: str
) -> pa.Table:
    # Reading builds all buffers anew, so that the quick check finds what there is to find.
    table.validate()
    check_texts(table, size, name)
    for index, field in enumerate(table.schema):
        if field.name in risky:
            own = schema.field(field.name)
            table = table.set_column(index, own, table.column(index).cast(own.type))
    return table


def _leaves(metadata: Any, names: Sequence[str]) -> dict[str, list[Any]]:
    """What the file says of the chunks of each column, those inside of nested ones too."""
    out: dict[str, list[Any]] = {name: [] for name in names}
    paths = [metadata.schema.column(i).path for i in range(metadata.num_columns)]
    for index, path in enumerate(paths):
        # A name may hold dots itself.
        column = path if path in out else path.partition(".")[0]
        for group in range(metadata.num_row_groups if column in out else 0):
            out[column].append(metadata.row_group(group).column(index))
    return out


def _width(kind: pa.DataType) -> int:
    """Bytes of a value of a type; of text only what says where it is."""
    try:
        return max(int(kind.bit_width) // 8, 1)
    except ValueError:
        return 8


def _may_open(chunks: Sequence[Any]) -> bool:
    """Whether text could be more than a log, if every value were all that is stored."""
    return bool(sum(c.num_values * c.total_uncompressed_size for c in chunks) > SMALL)


def _refuse_prefixes(columns: dict[str, list[Any]], name: str) -> None:
    for column, chunks in columns.items():
        of_prefixes = [c for c in chunks if any(e in _OWN for e in c.encodings)]
        if _may_open(of_prefixes):
            raise InputProblem(
                f"text stored as {_OWN[0]}, which may open to any size; write it with another"
                " encoding, or leave the column out",
                file=name,
                column=column,
            )

"""Does a log fit into memory? Better a message before reading than the system's killer during."""

from __future__ import annotations

from erdctl.core.errors import InputProblem
from erdctl.core.memory import available
from erdctl.io.formats import Format
from erdctl.io.sources import TableSource

# The columns, those derived from them by a model, and one more while something is computed.
COPIES = 3
_SAMPLE = 1 << 16


def check_fits(source: TableSource, columns: int) -> None:
    """Raise InputProblem if that many columns of a log will not fit into memory."""
    need = expected_rows(source) * columns * 8 * COPIES
    have = available()
    if have is not None and need > have:
        raise InputProblem(
            f"too large: its {columns} columns need about {_gigabytes(need)} of memory and"
            f" {_gigabytes(have)} are free; split it into several logs",
            file=source.name,
        )


def expected_rows(source: TableSource) -> int:
    """Number of rows, without reading them; an estimate unless the format states it."""
    if source.format is Format.CSV:
        if isinstance(source.data, str):
            with open(source.data, "rb") as file:
                head = file.read(_SAMPLE)
        else:
            head = bytes(source.data[:_SAMPLE])
        return source.size * max(head.count(b"\n"), 1) // len(head)
    if source.format is Format.PARQUET and isinstance(source.data, str):
        import pyarrow.parquet as pq

        return int(pq.read_metadata(source.data).num_rows)
    return source.size // (8 * len(source.columns))


def _gigabytes(size: int) -> str:
    return f"{size / 1e9:.3g} GB"

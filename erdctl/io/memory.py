"""Does a log fit into memory? Better a message before reading than the system's killer during."""

from __future__ import annotations

from erdctl.core.memory import check_claim
from erdctl.io.formats import Format
from erdctl.io.sources import TableSource

_SAMPLE = 1 << 16


def check_fits(source: TableSource, columns: int) -> None:
    """Raise InputProblem if that many columns of a log will not fit into memory."""
    check_claim(
        expected_rows(source) * columns * 8,
        source.size,
        source.name,
        f"its {columns} columns",
        about=True,
    )


def expected_rows(source: TableSource) -> int:
    """Number of rows, without reading them; an estimate unless the format states it."""
    if source.format is Format.CSV:
        if isinstance(source.data, str):
            with open(source.data, "rb") as file:
                head = file.read(_SAMPLE)
        else:
            head = bytes(source.data[:_SAMPLE])
        return source.size * max(head.count(b"\n"), 1) // max(len(head), 1)
    if source.rows is not None:
        return source.rows
    return source.size // (8 * max(len(source.columns), 1))

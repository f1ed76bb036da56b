"""The table of a campaign, written from what was kept of each log."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

import msgspec
import pyarrow as pa
import pyarrow.parquet as pq

from erdctl.io.atomic import output
from erdctl.io.campaign_journal import Entry
from erdctl.io.campaign_table import NAME, SCHEMA

GROUP = 1 << 16  # rows that are written at a time


def write_table(entries: Iterable[Entry], path: str, folder: str) -> int:
    """Write the table of a campaign, whole or not at all; the number of its rows.

    entries : in the order of the table's rows, which are written as they come
    folder : of the journal, to which the entries' documents are relative; the table's are relative
        to its own folder
    """
    beside = os.path.relpath(folder, os.path.dirname(path) or ".")
    rows: list[dict[str, Any]] = []
    count = 0
    with output(path) as stream, pq.ParquetWriter(stream, SCHEMA, compression="zstd") as writer:

        def flush() -> None:
            writer.write_table(pa.Table.from_pylist(rows, schema=SCHEMA), row_group_size=GROUP)
            rows.clear()

        for entry in entries:
            new = rows_of(entry, beside)
            count += len(new)
            rows += new
            if len(rows) >= GROUP:
                flush()
        if rows or not count:
            flush()
    return count


def is_table(path: str) -> bool:
    """Whether a file is the table of a campaign."""
    try:
        metadata = pq.read_schema(path).metadata or {}
    except (OSError, pa.ArrowException):
        return False
    return bool(metadata.get(b"schema") == NAME.encode())


def rows_of(entry: Entry, beside: str = ".") -> list[dict[str, Any]]:
    """The rows of one log: one for each parameter, or a single one without."""
    of_log = {
        "log": entry.log,
        "logs": entry.logs,
        "hash": entry.hash,
        "version": entry.version,
        "damper": entry.damper,
        "corner": entry.corner,
        "date": instant(entry.date),
        "conditions": [*entry.conditions.items()],
        "verdict": entry.verdict,
        "findings": entry.findings,
        "rig": entry.rig,
        "nrmse": entry.nrmse,
        "nrmse_worst": entry.nrmse_worst,
        "noise_rms": entry.noise_rms,
        "documents": [
            (command, posixpath.normpath(posixpath.join(*beside.split(os.sep), name)))
            for command, name in entry.documents.items()
        ],
        "remarks": entry.remarks,
        "exit_code": entry.exit_code,
        "error": entry.error,
    }
    if not entry.parameters:
        return [of_log]
    return [{**of_log, **msgspec.structs.asdict(p)} for p in entry.parameters]


def instant(date: str | None) -> datetime | None:
    """The moment of an ISO 8601 date; one with a time zone is taken to UTC."""
    if date is None:
        return None
    found = datetime.fromisoformat(date)
    return found if found.tzinfo is None else found.astimezone(UTC).replace(tzinfo=None)

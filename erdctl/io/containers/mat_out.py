"""A log as a MATLAB 5 file: `records`, a struct array with a field for each column.

`units` is a struct with the unit of each field that has one, `names` one with the column's own
name where MATLAB does not allow it as a field.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, BinaryIO

import numpy as np

from erdctl.core.errors import UsageProblem
from erdctl.io.containers.outgoing import Columns

_LONGEST = 63  # characters in a MATLAB name


def write(records: Sequence[tuple[str | None, Columns]], stream: BinaryIO) -> None:
    """Write records as an array of structs.

    Raises UsageProblem if a record is too long for the format.
    """
    from scipy.io import savemat
    from scipy.io.matlab import MatWriteError

    fields = _fields([c.name for c in records[0][1]])
    named = records[0][0] is not None
    kinds: list[tuple[str, Any]] = [(f, object) for f in fields]
    out = np.empty((1, len(records)), [*([("record", object)] if named else []), *kinds])
    for i, (name, columns) in enumerate(records):
        if named:
            out["record"][0, i] = name
        for field, column in zip(fields, columns, strict=True):
            out[field][0, i] = column.values.reshape(-1, 1)
    first = records[0][1]
    units = {f: c.unit for f, c in zip(fields, first, strict=True) if c.unit is not None}
    names = {f: c.name for f, c in zip(fields, first, strict=True) if f != c.name}
    variables: dict[str, Any] = {"records": out, "units": units or [], "names": names or []}
    try:
        savemat(stream, variables, long_field_names=True)
    except (MatWriteError, OverflowError, ValueError) as error:
        raise UsageProblem(f"MAT cannot hold this log ({error}); write .parquet") from None


def _fields(names: Sequence[str]) -> list[str]:
    """MATLAB names that are as near to the columns' own as can be, each once."""
    out: list[str] = []
    for name in names:
        field = re.sub(r"\W", "_", name, flags=re.ASCII)
        if not re.match(r"[A-Za-z]", field):
            field = f"c_{field}"
        whole, copy = field[:_LONGEST], 2
        field = whole
        while field in (*out, "record"):
            field, copy = f"{whole[: _LONGEST - 5]}_{copy}", copy + 1
        out.append(field)
    return out

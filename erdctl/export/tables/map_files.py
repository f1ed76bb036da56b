"""Force over speed and duty as CSV, a row for each place, and as a MATLAB 5 file, as matrices."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np

from erdctl.export.tables.peak_map import PeakMap

COLUMNS = ("xdot", "duty", "force", "stderr")
UNITS = {"xdot": "m/s", "duty": "1", "force": "N", "stderr": "N"}
SIGN = "sign: xdot and force are positive in compression"


def csv(table: PeakMap, remarks: Sequence[str]) -> str:
    """Lines that begin with # say what it is; then a header and SI values, exact when read back."""
    n, m = table.force.shape
    columns = (
        np.repeat(table.grid.speed, m), np.tile(table.grid.duty, n), table.force.ravel(),
        table.stderr.ravel(),
    )  # fmt: skip
    rows = zip(*(c.tolist() for c in columns), strict=True)
    head = [f"# {line}" for line in (SIGN, *remarks, f"units: {_units()}")]
    return "\n".join([*head, ",".join(COLUMNS), *(",".join(map(repr, r)) for r in rows), ""])


def mat(table: PeakMap, remarks: Sequence[str], nrmse: float) -> bytes:
    """force and stderr (speeds, duties), xdot (column), duty (row), units, notes, nrmse."""
    from scipy.io import savemat

    notes = np.array([SIGN, *remarks], dtype=object).reshape(-1, 1)
    stream = io.BytesIO()
    savemat(stream, {
        "xdot": table.grid.speed.reshape(-1, 1), "duty": table.grid.duty.reshape(1, -1),
        "force": table.force, "stderr": table.stderr, "nrmse": nrmse, "units": UNITS,
        "notes": notes,
    })  # fmt: skip
    return stream.getvalue()


def _units() -> str:
    return ", ".join(f"{name} [{unit}]" for name, unit in UNITS.items())

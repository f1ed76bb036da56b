"""A record whose xdot goes otherwise with its x than in the other records."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.linear_model import LEAST_RECORDS
from erdctl.bench.rig.pieces import Piece
from erdctl.bench.rig.trend import clearest
from erdctl.core.messages import duration
from erdctl.core.quantiles import median

# Least difference, and scatter that is known beforehand: of the gain; of the lag in seconds, and
# least lag in steps and of a cycle.
GAIN, PRIOR_GAIN = 0.08, 0.02
LATE, PRIOR_LATE, LATE_STEPS, LATE_CYCLE = 4e-3, 1e-3, 2.0, 0.01
# A piece of a record, the gain of xdot over x there, and its lag [s].
Row = tuple[Piece, float, float]


def check(rows: Sequence[Row]) -> list[RigFault]:
    """By gain and lag, each against the mean of the other records; the clearest first."""
    left = {row[0].record: row for row in rows}
    out: list[RigFault] = []
    for _ in range(max(1, len(left) // 3)):
        if len(left) < LEAST_RECORDS:
            break
        others = list(left.values())
        said = _late(others) or _gained(others)
        if said is None:
            break
        record, text = said
        out.append(
            RigFault(
                "record_velocity", record, text,
                "it is left out of fits; leave the column xdot out, or repair it there",
                blocks=True,
            )
        )  # fmt: skip
        del left[record]
    return out


def _late(rows: Sequence[Row]) -> tuple[int, str] | None:
    lags = [s for _, _, s in rows]
    least = [max(LATE, LATE_STEPS * p.step, LATE_CYCLE * p.cycle) for p, _, _ in rows]
    away = clearest(lags, np.ones((len(rows), 1)), least, PRIOR_LATE)
    if away is None:
        return None
    way = "later" if away.difference > 0 else "earlier"
    by = duration(abs(away.difference))
    return (
        rows[away.index][0].record,
        f"its xdot is {by} {way} against its x than in the other records",
    )


def _gained(rows: Sequence[Row]) -> tuple[int, str] | None:
    logs = [float(np.log(g)) for _, g, _ in rows]
    away = clearest(logs, np.ones((len(rows), 1)), [GAIN] * len(rows), PRIOR_GAIN)
    if away is None:
        return None
    others = median([g for i, (_, g, _) in enumerate(rows) if i != away.index])
    p, own, _ = rows[away.index]
    return p.record, (
        f"its xdot is {own:.3g} times the derivative of its x, where that of the other records is"
        f" {others:.3g} times"
    )

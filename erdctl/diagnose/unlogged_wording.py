"""What a diagnosis says of strokes that motion and control do not tell apart, in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.core.messages import counted
from erdctl.diagnose import thresholds
from erdctl.diagnose.residual.unlogged import Unlogged


def unlogged_text(told: Sequence[Unlogged], names: Sequence[str]) -> str:
    """That something acts which is not logged, and when; the strongest first.

    names : of the records
    """
    if not told:
        return ""
    square = [float(np.dot(u.change, u.change)) for u in told]
    order = [told[i] for i in np.argsort(square)[::-1].tolist()]
    shown = order[: thresholds.UNLOGGED_SAID]
    said = "; ".join(_said(u, names[u.record]) for u in shown)
    more = len(order) - len(shown)
    said += f"; and {more} such beside" if more else ""
    return (
        "; strokes that motion and duty do not tell from others have another force for a while, so"
        f" that something acts which is not logged (a setting, the supply, a temperature): {said};"
        " these strokes are left out of fits and scores, and all that is said here is of the others"
    )


def _said(u: Unlogged, name: str) -> str:
    low, high = (100.0 * float(v) for v in (u.part.min(), u.part.max()))
    if low < 0.0 < high:
        part = f"from {-low:.2g} % less to {high:.2g} % more"
    else:
        ends = sorted((abs(low), abs(high)))
        part = f"{ends[0]:.2g} to {ends[1]:.2g} % {'more' if high > 0.0 else 'less'}"
    return (
        f"in record {name!r}, from {u.begin:.2f} to {u.end:.2f} s,"
        f" {counted(u.count, 'stroke')} in {u.way} have {part} force than"
        f" {u.others} others like them, beside a scatter of {100.0 * u.scatter:.2g} %"
    )

"""Where searches for the paper's parameters begin, whatever a fit has found before."""

from __future__ import annotations

from erdctl.core.recording import DIRECTIONS


def fresh_start(T_d: float, beta: float) -> dict[str, float]:
    """The same time constant [s] and exponent [1] in both directions."""
    return {f"{d}.T_d": T_d for d in DIRECTIONS} | {f"{d}.beta": beta for d in DIRECTIONS}

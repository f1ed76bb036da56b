"""How many processes a diagnosis is worth."""

from __future__ import annotations

from collections.abc import Sized

from erdctl.core.workers import cores
from erdctl.diagnose import thresholds


def worthwhile(recording: Sized, candidates: Sized) -> int:
    """As many processes as cores, where the work is worth starting them; else 1."""
    return cores() if len(recording) * len(candidates) > thresholds.WORTH_PROCESSES else 1

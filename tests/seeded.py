"""Effects that a seed can hide as when the seeds of tests were picked.

One more in the pool moves what most seeds hide: name it here as it comes.
"""

from __future__ import annotations

from erdctl.effects import names

# In the order in which they came.
LATER = (
    "damped_backlash", "deflection_offset", "duty_skew", "force_lowpass", "force_crosstalk",
    "clock_drift",
)  # fmt: skip


def known_before(name: str) -> tuple[str, ...]:
    """The effects that there were before one of those came."""
    return tuple(n for n in names() if n not in LATER[LATER.index(name) :])


KNOWN = known_before("damped_backlash")

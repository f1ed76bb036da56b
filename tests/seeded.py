"""Effects that a seed can hide as when the seeds of tests were picked.

One more in the pool moves what most seeds hide: name it here as it comes.
"""

from __future__ import annotations

from erdctl.effects import names

LATER = {"damped_backlash"}
KNOWN = tuple(name for name in names() if name not in LATER)

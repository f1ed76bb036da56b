"""What the columns of a log are needed for, by which those of a container share a time base."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from erdctl.io.units import Conversion


@dataclass(frozen=True)
class Roles:
    """What columns are needed for.

    targets : column -> contract column, `t` among them if it is a channel of its own
    seconds : how the values of such a channel become seconds
    say : takes a line about what was done
    """

    targets: Mapping[str, str] = field(default_factory=dict)
    seconds: Conversion = field(default_factory=Conversion)
    say: Callable[[str], None] = lambda line: None

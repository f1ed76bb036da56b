"""Which faults an emulator has inputs for."""

from __future__ import annotations

from erdctl.core.errors import UsageProblem
from erdctl.model.faults import FaultKind


def emulated(text: str) -> tuple[FaultKind, ...]:
    """The faults of a list, in the order of the paper.

    Raises UsageProblem for a name that is none, or is there twice.
    Check: "electrical,oil" is oil, electrical.
    >>> [kind.short for kind in emulated("electrical,oil")]
    ['oil', 'electrical']
    """
    known = {kind.short: kind for kind in FaultKind}
    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in known:
            raise UsageProblem(f"--emulate '{name}': known are {', '.join(known)}")
        if names.count(name) > 1:
            raise UsageProblem(f"--emulate: '{name}' is there twice")
    return tuple(kind for kind in FaultKind if kind.short in names)

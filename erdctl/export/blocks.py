"""The damper, or the online emulator of its faults, as a block of C, for .c and .fmu alike."""

from __future__ import annotations

import os
from collections.abc import Sequence

from erdctl.core.errors import UsageProblem
from erdctl.export.c.source import CBlock, write_c
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.emulator.source import EmulatorBlock, write_emulator
from erdctl.model.faults import FaultKind
from erdctl.model.parameters import Parameters


def stem_of(path: str) -> str:
    """The name of a file without folder and suffix, from which all names in it come.

    Raises UsageProblem for one that cannot stand in an #include.
    """
    stem = os.path.splitext(os.path.basename(path))[0]
    if not stem.isprintable() or any(c in stem for c in '"\\'):
        raise UsageProblem(f"'{stem}' cannot stand in an #include; name another file")
    return stem


def block_of(
    parameters: Parameters, stem: str, faults: Sequence[FaultKind], limits: EmulatorLimits
) -> tuple[CBlock | EmulatorBlock, list[str]]:
    """The block, and what is to be said of it: what is left out.

    stem : of the file, from which its names come;  faults : of an emulator, none for the damper
    """
    block: CBlock | EmulatorBlock
    if faults:
        block = write_emulator(parameters, prefix=stem, faults=faults, limits=limits)
    else:
        block = write_c(parameters, prefix=stem)
    return block, [f"left out: {what}" for what in block.left_out]

"""The damper, or the online emulator of its faults, as a block of C, for .c and .fmu alike."""

from __future__ import annotations

import os
from collections.abc import Sequence

from erdctl.core.errors import UsageProblem
from erdctl.export.c.names import identifier
from erdctl.export.c.source import CBlock, write_c
from erdctl.export.damper_alone import of_the_bench
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


def damper_in_c(parameters: Parameters, path: str) -> CBlock:
    """The damper as a block whose names come from a file's."""
    return write_c(parameters, prefix=stem_of(path))


def emulator_in_c(
    parameters: Parameters, path: str, faults: Sequence[FaultKind], limits: EmulatorLimits
) -> EmulatorBlock:
    """The emulator as a block whose names come from a file's."""
    return write_emulator(
        parameters, prefix=identifier(stem_of(path)), faults=faults, limits=limits,
        remarks=not_inverted(parameters),
    )  # fmt: skip


def not_inverted(parameters: Parameters) -> list[str]:
    """What the emulator does not know of the damper."""
    names = ", ".join(e.name for e in parameters.model.effects if not of_the_bench(e))
    return [f"the emulator inverts the paper's model, without {names}"] if names else []


def left_out_of(block: CBlock) -> list[str]:
    """What the block of a damper has not, in words."""
    return [f"left out: {what}" for what in block.left_out]

"""The damper, or the online emulator of its faults, as a block of C, for .c and .fmu alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from erdctl.export.c.names import identifier
from erdctl.export.c.source import CBlock, write_c
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.emulator.source import EmulatorBlock, write_emulator
from erdctl.model.faults import FaultKind
from erdctl.model.parameters import Parameters


class Block(Protocol):
    """What both have."""

    @property
    def prefix(self) -> str: ...
    @property
    def header(self) -> str: ...
    @property
    def source(self) -> str: ...


def block_of(
    parameters: Parameters, stem: str, faults: Sequence[FaultKind], limits: EmulatorLimits
) -> tuple[CBlock | EmulatorBlock, list[str]]:
    """The block, and remarks for the user.

    stem : of the file, from which its names come;  faults : of an emulator, none for the damper
    """
    if faults:
        return write_emulator(
            parameters, prefix=identifier(stem), faults=faults, limits=limits
        ), _not_inverted(parameters)
    block = write_c(parameters, prefix=stem)
    return block, [f"left out: {what}" for what in block.left_out]


def _not_inverted(parameters: Parameters) -> list[str]:
    names = ", ".join(e.name for e in parameters.model.effects)
    return [f"the emulator inverts the paper's model, without {names}"] if names else []

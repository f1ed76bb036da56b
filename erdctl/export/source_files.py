"""A block of C as two files beside each other: both, or none."""

from __future__ import annotations

import os
from collections.abc import Sequence

from erdctl.core.errors import UsageProblem
from erdctl.export.blocks import Block, block_of
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.io.atomic import output
from erdctl.model.faults import FaultKind
from erdctl.model.parameters import Parameters


def write_sources(
    parameters: Parameters, path: str, faults: Sequence[FaultKind], limits: EmulatorLimits
) -> Sequence[str]:
    """Write FILE.c and FILE.h; returns remarks for the user.

    faults : of an emulator, none for the damper itself
    """
    stem = os.path.splitext(path)[0]
    name = f"{os.path.basename(stem)}.h"
    if not name.isprintable() or any(c in name for c in '"\\'):
        raise UsageProblem(f"'{name}' cannot stand in an #include; name another file")
    block, remarks = block_of(parameters, os.path.basename(stem), faults, limits)
    with output(f"{stem}.h") as header, output(path) as source:
        header.write(block.header.encode())
        source.write(including(block, name).encode())
    return [*remarks, f"{name} is beside it; every name in both begins with {block.prefix}_"]


def including(block: Block, header: str) -> str:
    """The source, with the header's name as its file has it, which need be no name of C."""
    return block.source.replace(f'#include "{block.prefix}.h"', f'#include "{header}"', 1)

"""A block of C as two files beside each other: both, or none."""

from __future__ import annotations

import os
from collections.abc import Sequence

from erdctl.export.blocks import block_of, stem_of
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
    stem = stem_of(path)
    block, remarks = block_of(parameters, stem, faults, limits)
    name = f"{stem}.h"
    header = f"{os.path.splitext(path)[0]}.h"
    # A file's name need be no name of C.
    source = block.source.replace(f'#include "{block.prefix}.h"', f'#include "{name}"', 1)
    with output(header) as first, output(path) as second:
        first.write(block.header.encode())
        second.write(source.encode())
    return [*remarks, f"{name} is beside it; every name in both begins with {block.prefix}_"]

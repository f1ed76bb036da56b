"""An FMU written to a file, and what is to be said of it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from erdctl.export.blocks import block_of
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.emulator.source import EmulatorBlock
from erdctl.export.fmu.damper import damper_block
from erdctl.export.fmu.emulator import emulator_block
from erdctl.export.fmu.package import Package, packaged
from erdctl.export.fmu.version import VERSIONS
from erdctl.io.atomic import output
from erdctl.model.faults import FaultKind
from erdctl.model.parameters import Parameters


def write_fmu(
    parameters: Parameters,
    path: str,
    faults: Sequence[FaultKind],
    limits: EmulatorLimits,
    fmi: str,
) -> Sequence[str]:
    """Write an FMU; returns remarks for the user.

    faults : of an emulator, none for the damper itself;  fmi : version, a key of VERSIONS
    """
    stem = os.path.splitext(os.path.basename(path))[0]
    c, remarks = block_of(parameters, stem, faults, limits)
    if isinstance(c, EmulatorBlock):
        block = emulator_block(c, parameters)
    else:
        block = damper_block(c, parameters)
    made = packaged(block, version=VERSIONS[fmi])
    with output(path) as stream:
        stream.write(made.data)
    return [*remarks, *_said(made, VERSIONS[fmi].number)]


def _said(made: Package, number: str) -> Iterator[str]:
    if not made.platforms:
        yield (
            f"FMI {number}, sources only: no compiler was found; pip install 'erdctl[fmu]' brings"
            " one that builds for all platforms"
        )
        return
    yield f"FMI {number}, with sources and binaries for {', '.join(made.platforms)}"
    for platform, reason in made.failed.items():
        yield f"no binary for {platform}: {reason}"
    if len(made.platforms) == 1 and not made.failed:
        yield f"built by {made.compiler}; pip install 'erdctl[fmu]' builds for all platforms"

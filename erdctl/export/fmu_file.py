"""A block of C as an FMU."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.core.errors import UsageProblem
from erdctl.export.blocks import damper_in_c, left_out_of
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.fmu.damper import damper_block
from erdctl.export.fmu.package import Package, packaged
from erdctl.export.fmu.version import VERSIONS
from erdctl.io.atomic import output
from erdctl.model.faults import FaultKind
from erdctl.model.parameters import Parameters


def write_fmu(
    parameters: Parameters, path: str, faults: Sequence[FaultKind], limits: EmulatorLimits, fmi: str
) -> Sequence[str]:
    """Write an FMU; returns remarks for the user.

    faults : of an emulator, none for the damper itself;  fmi : its version, "2" or "3"
    """
    if faults:
        raise UsageProblem("an emulator is exported as .c only so far")
    c = damper_in_c(parameters, path)
    made = packaged(damper_block(c, parameters), version=VERSIONS[fmi])
    with output(path) as stream:
        stream.write(made.data)
    return [*left_out_of(c), *said(made)]


def said(made: Package) -> list[str]:
    """For which platforms it has binaries, and for which it has not."""
    out = [
        f"binaries for {', '.join(made.platforms)}, built by {made.compiler}; the sources are in it"
        if made.platforms
        else "no binaries, since no C compiler is there: importers that compile can use its sources"
    ]
    return out + [f"none for {name}: {reason}" for name, reason in made.failed.items()]

"""A damper property file (`.dpr`) in the TeimOrbit format of Adams Car and other vehicle programs.

Blocks in [brackets] with lines KEY = value, texts in single quotes; a table begins with the names
of its columns in {braces}; what begins with $ is a comment. The curve is read with linear or Akima
interpolation of force over speed, in the units of the file.

Sign: here x, xdot and force are positive in compression. Adams takes the rate of change of the
distance between both ends as speed, so extension (rebound) is positive and so is the force that
pulls both ends together: both change their sign, and a damper's curve stays in the first and third
quadrant.

Source: MSC Adams help, about TeimOrbit files (Adams Tire) and the function VR; Altair MotionView
2021 help, AutoDamper and TeimOrbit file format.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from erdctl.core.recording import Array

WIDTH = 79
MM = 1e3  # the usual length of vehicle models


def property_file(
    speed: Array, force: Array, stderr: Array, *, remarks: Sequence[str], extension: bool
) -> str:
    """The text of the file.

    speed : (n,) rising, positive in compression [m/s];  force, stderr : (n,) [N]
    extension : whether speed and force are positive in extension in the file
    """
    if extension:
        speed, force, stderr = -speed[::-1], -force[::-1], stderr[::-1]
    way = "extension (rebound)" if extension else "compression (jounce)"
    sign = (
        f"sign: vel and force are positive in {way}"
        + (", as Adams Car reads them" if extension else ", the opposite of what Adams Car reads")
        + "; erdctl's own x, xdot and force are positive in compression"
    )
    rows = [
        f"{v:.9g}   {f:.9g}" for v, f in zip((MM * speed).tolist(), force.tolist(), strict=True)
    ]
    errors = [
        f"{v:14.6g} {f:14.6g} {e:14.3g}"
        for v, f, e in zip((MM * speed).tolist(), force.tolist(), stderr.tolist(), strict=True)
    ]
    return "\n".join([
        _rule("MDI_HEADER"), "[MDI_HEADER]",
        " FILE_TYPE     =  'dpr'", " FILE_VERSION  =  4.0", " FILE_FORMAT   =  'ASCII'",
        _rule("UNITS"), "[UNITS]",
        " LENGTH  =  'mm'", " ANGLE  =  'degrees'", " FORCE  =  'newton'", " MASS  =  'kg'",
        " TIME  =  'second'",
        _rule("ABOUT"), *[c for r in (sign, *remarks) for c in comment(r)],
        "$", f"$ {'vel [mm/s]':>14} {'force [N]':>14} {'stderr [N]':>14}",
        *[f"$ {row}" for row in errors],
        _rule("CURVE"), "[CURVE]", "{   vel       force}", *rows, "",
    ])  # fmt: skip


def _rule(title: str) -> str:
    return "$" + title.rjust(WIDTH - 1, "-")


def comment(text: str) -> list[str]:
    """Lines of a comment, each short enough for every reader."""
    return textwrap.wrap(text, WIDTH, initial_indent="$ ", subsequent_indent="$   ")

"""How a kind of picture becomes a figure, and a figure a file."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, BinaryIO

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.report import pictures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject

SUFFIXES = ("png", "svg", "pdf")
_PLAIN = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}


def suffix(path: str) -> str:
    """The format of a picture file, by its suffix; raises UsageProblem for others."""
    found = os.path.splitext(path)[1][1:].lower()
    if found not in SUFFIXES:
        known = ", ".join(f".{s}" for s in SUFFIXES)
        raise UsageProblem(f"'{path}': a picture is one of {known}")
    return found


def figure(kind: str, subject: Subject) -> Figure:
    """A figure of one kind.

    Raises UsageProblem for an unknown kind, or if the subject lacks what the kind draws,
    InputProblem if the log has nothing of that kind.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    chosen = pictures.get(kind)
    lacking = subject.lacks(chosen.needs)
    if lacking is not None:
        raise UsageProblem(f"the picture '{kind}' needs {lacking}")
    empty = chosen.nothing(subject)
    if empty is not None:
        raise InputProblem(f"the picture '{kind}' would show nothing: {empty}")
    size = chosen.size(subject) if callable(chosen.size) else chosen.size
    with mpl.rc_context(fname=style_file()):
        out = Figure(figsize=size, layout="constrained")
        chosen.draw(out, subject)
        out.suptitle(chosen.title, x=0.01, ha="left")
        if subject.about:
            out.text(0.995, 0.995, subject.about, ha="right", va="top", size=7, color="0.4")
    return out


def write(out: Figure, stream: BinaryIO, format: str) -> None:
    """Write a figure; the same figure gives the same bytes."""
    import matplotlib as mpl

    with mpl.rc_context(fname=style_file()):
        if format == "png":
            _write_png(out, stream, float(mpl.rcParams["savefig.dpi"]))
        else:
            metadata: dict[str, Any] = _PLAIN.get(format, {})
            out.savefig(stream, format=format, metadata=metadata)


def _write_png(out: Figure, stream: BinaryIO, dpi: float) -> None:
    """A PNG with a palette: a quarter of the size, and written faster, than with full colours."""
    from io import BytesIO

    from PIL import Image

    out.set_dpi(dpi)
    raw = BytesIO()
    out.savefig(raw, format="rgba", dpi=dpi)
    pixels = Image.frombytes("RGBA", out.canvas.get_width_height(), raw.getvalue()).convert("RGB")
    few = pixels.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.save(stream, format="png", dpi=(dpi, dpi))


def style_file() -> str:
    """The style of all pictures, as matplotlib takes it."""
    return os.path.join(os.path.dirname(__file__), "erdctl.mplstyle")

"""What a kind of picture declares."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject


@dataclass(frozen=True, kw_only=True)
class Picture:
    """One kind of picture.

    title : above it;  figures : of the paper that it draws
    needs, wants : of `Subject`, what it cannot do without, and what it shows if it is there
    nothing : why a subject that has all this would still make an empty picture; None if it does not
    draw : puts it into an empty figure
    size : width and height [inch], or how to find them from the subject
    """

    title: str
    needs: tuple[str, ...]
    draw: Callable[[Figure, Subject], None]
    figures: str = ""
    wants: tuple[str, ...] = ()
    nothing: Callable[[Subject], str | None] = lambda subject: None
    size: tuple[float, float] | Callable[[Subject], tuple[float, float]] = (10.0, 4.6)

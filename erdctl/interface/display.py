"""How results show themselves: at a prompt, in a notebook, as a figure, as a file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any

from erdctl.core.errors import UsageProblem

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from erdctl.report.subject import Subject

SHOWN = 24  # rows of a table in a notebook, and remarks at a prompt


def text(title: str, lines: Sequence[str]) -> str:
    """A title with lines below it, as a prompt shows it."""
    return "\n  ".join([title, *_some(lines)])


def html(title: str, frame: pd.DataFrame, lines: Sequence[str] = ()) -> str:
    """A title, a table and lines below it; whatever comes from a log is escaped."""
    table = frame.to_html(
        index=False, border=0, max_rows=SHOWN, na_rep="", float_format=_number, escape=True
    )
    notes = "".join(f"<li>{escape(line)}</li>" for line in _some(lines))
    return f"<div><b>{escape(title)}</b>{table}{f'<ul>{notes}</ul>' if notes else ''}</div>"


def frame_of(
    rows: Sequence[dict[str, Any]], columns: Sequence[str], units: dict[str, str] | None = None
) -> pd.DataFrame:
    """A frame with these columns, also of no rows; units, where columns have one, in its attrs."""
    import pandas as pd

    out = pd.DataFrame(list(rows), columns=list(columns))
    out.attrs["units"] = units or {}
    return out


def draw(
    subject: Subject,
    kind: str,
    records: Sequence[str] | str,
    span: tuple[float, float] | None,
    *,
    locate: bool = False,
) -> Figure:
    """One kind of picture of some records and a time span [s]; a notebook shows it by itself.

    locate : find where the model misses, if the picture shows that
    Raises UsageProblem, as `erdctl plot` says it.
    """
    from erdctl.report import picture, pictures
    from erdctl.report.subject import part
    from erdctl.report.subjects import located

    if span is not None and not span[0] < span[1]:
        raise UsageProblem(f"span is (start, end) in seconds, e.g. (2, 5.5), not {span}")
    declared = pictures.get(kind)
    modelled = subject.modelled
    if locate and "regions" in (*declared.needs, *declared.wants) and modelled is not None:
        subject = replace(subject, regions=located(subject.recording, modelled))
    chosen = [records] if isinstance(records, str) else records
    out = picture.figure(kind, part(subject, chosen, span))
    # Without pyplot, which keeps every figure until it is closed, a notebook would show no picture.
    setattr(out, "_repr_png_", partial(_png, out))  # noqa: B010  # a name that Figure has not
    return out


def option(value: str, known: Sequence[str], name: str) -> str:
    """The value, if it is one of those known; raises UsageProblem that lists them."""
    if value not in known:
        raise UsageProblem(f"{name} takes {', '.join(known)}, not '{value}'")
    return value


def _png(figure: Figure) -> bytes:
    from erdctl.report.picture import write

    stream = BytesIO()
    write(figure, stream, "png")
    return stream.getvalue()


def _some(lines: Sequence[str]) -> list[str]:
    more = len(lines) - SHOWN
    return [*lines] if more <= 0 else [*lines[:SHOWN], f"and {more} more"]


def _number(value: float) -> str:
    return f"{value:.5g}"

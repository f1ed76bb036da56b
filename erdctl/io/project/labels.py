"""Which damper, corner, date and conditions a log is of, as a project reads them."""

from __future__ import annotations

import datetime as dt
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from erdctl.core.errors import InputProblem
from erdctl.core.labels import LONGEST
from erdctl.core.messages import as_text
from erdctl.io.project.shape import CORNERS

OWN = ("damper", "corner", "date")


@dataclass(frozen=True)
class Labels:
    """What a log is of; None where nobody says it.

    corner : fl, fr, rl or rr;  date : ISO 8601;  conditions : any other name -> text
    """

    damper: str | None = None
    corner: str | None = None
    date: str | None = None
    conditions: Mapping[str, str] = field(default_factory=dict)

    def value(self, name: str) -> str | None:
        """A label by its name."""
        return getattr(self, name) if name in OWN else self.conditions.get(name)

    def texts(self) -> dict[str, str]:
        """As provenance has them, without those that are None."""
        given = {name: getattr(self, name) for name in OWN}
        said = ", ".join(f"{name} {value}" for name, value in self.conditions.items())
        return {k: v for k, v in (given | {"conditions": said}).items() if v}


def over(labels: Labels, given: Labels) -> Labels:
    """Labels with those that are given in their place, name by name.

    Check: a date that is given does not take the damper away.
    >>> over(Labels("A07", date="2024-05-01"), Labels(date="2024-06-01"))
    Labels(damper='A07', corner=None, date='2024-06-01', conditions={})
    """
    own = {name: given.value(name) or labels.value(name) for name in OWN}
    return Labels(**own, conditions={**labels.conditions, **given.conditions})


def relative(path: str, folder: str) -> str:
    """A path from the project's folder on, with / between folders; absolute where it is outside.

    Check: from /lab on, /lab/raw/a.csv is raw/a.csv, and /other/a.csv stays.
    >>> relative("/lab/raw/a.csv", "/lab"), relative("/other/a.csv", "/lab")
    ('raw/a.csv', '/other/a.csv')
    """
    full = os.path.abspath(path)
    try:
        inside = os.path.commonpath([full, folder]) == folder
    except ValueError:  # another drive
        inside = False
    return as_text(os.path.relpath(full, folder) if inside else full).replace(os.sep, "/")


def labels_of_groups(found: Mapping[str, str | None], form: str | None, file: str) -> Labels:
    """Labels of what was found under their names, in a path or in columns.

    form : of the date (strptime); None for ISO 8601
    Raises InputProblem for a corner or a date that is none, and for what no table could show.
    Check: a date of eight digits by its format, and what is neither is a condition.
    >>> labels_of_groups({"date": "01052024", "degC": "25"}, "%d%m%Y", "a.csv")
    Labels(damper=None, corner=None, date='2024-05-01', conditions={'degC': '25'})
    """
    given = {name: text.strip() for name, text in found.items() if text and text.strip()}
    for name, text in given.items():
        if len(text) > LONGEST or not text.isprintable():
            raise InputProblem(
                f"{name} is {text[:40]!r} by the project; expected 1 to {LONGEST} printable"
                " characters", file=file,
            )  # fmt: skip
    corner = given.get("corner")
    if corner is not None:
        corner = corner.casefold()
        if corner not in CORNERS:
            raise InputProblem(
                f"corner is '{given['corner']}' by the project; expected {', '.join(CORNERS)}",
                file=file,
            )
    return Labels(
        damper=given.get("damper"), corner=corner,
        date=_iso(given["date"], form, file) if "date" in given else None,
        conditions={name: text for name, text in given.items() if name not in OWN},
    )  # fmt: skip


def _iso(text: str, form: str | None, file: str) -> str:
    try:
        when = dt.datetime.fromisoformat(text) if form is None else dt.datetime.strptime(text, form)
    except ValueError:
        like = "a date such as 2024-05-01 or 20240501; labels.date says another form"
        raise InputProblem(
            f"date is '{text}' by the project; expected"
            f" {like if form is None else f'the form {form}'}",
            file=file,
        ) from None
    bare = when.time() == dt.time() and when.tzinfo is None
    return (when.date() if bare else when).isoformat()


def groups(pattern: re.Pattern[str] | None, path: str) -> dict[str, str | None]:
    """Named groups of the first place in a path where the pattern fits."""
    found = pattern.search(path) if pattern is not None else None
    return found.groupdict() if found else {}


def common(labels: Sequence[Labels]) -> Labels:
    """What all of some logs are of.

    Check: two dates of one damper leave the damper.
    >>> common([Labels("A07", date="2024-05-01"), Labels("A07", date="2024-06-01")])
    Labels(damper='A07', corner=None, date=None, conditions={})
    """

    def shared(values: set[str | None]) -> str | None:
        return values.pop() if len(values) == 1 else None

    conditions = {
        name: text for name in (labels[0].conditions if labels else {})
        if (text := shared({one.conditions.get(name) for one in labels})) is not None
    }  # fmt: skip
    damper, corner, date = (shared({getattr(one, name) for one in labels}) for name in OWN)
    return Labels(damper, corner, date, conditions)

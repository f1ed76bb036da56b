"""Whose log it is and when it was taken, as its path says: damper, corner, date, conditions."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime

from erdctl.core.errors import UsageProblem
from erdctl.io.project.labels import OWN, Labels


def pattern_of(text: str) -> re.Pattern[str]:
    """The regular expression of `--label`; UsageProblem for one that names nothing."""
    try:
        found = re.compile(text)
    except re.error as error:
        raise UsageProblem(f"--label {text}: no regular expression ({error})") from None
    if not found.groupindex:
        raise UsageProblem(
            f"--label {text}: name what it finds, e.g. '(?P<damper>[^/]+)/(?P<date>[0-9-]+)'"
        )
    return found


def labels_of_path(path: str, pattern: re.Pattern[str]) -> Labels | None:
    """The labels that a path has where the pattern first matches; None where it does not.

    pattern : with named groups `damper`, `corner`, `date`; any other name is a condition
    Raises UsageProblem for a date that is none.
    Check: damper and day of one path; a month is its first day.
    >>> p = re.compile(r"(?P<damper>D[0-9]+)/(?P<date>[0-9-]+)_(?P<oil>[0-9]+C)")
    >>> labels_of_path("lab/D07/2024-05_40C.csv", p)
    Labels(damper='D07', corner=None, date='2024-05-01', conditions={'oil': '40C'})
    """
    match = pattern.search(path)
    if match is None:
        return None
    found = {name: text for name, text in match.groupdict().items() if text}
    own = {name: found.pop(name, None) for name in OWN}
    if own["date"] is not None:
        own["date"] = iso_date(own["date"], path)
    return Labels(**own, conditions=dict(sorted(found.items())))


def iso_date(text: str, path: str) -> str:
    """A date as ISO 8601, from the ways in which names of files write it.

    Raises UsageProblem for a date that is none, and for six digits that may be a year and a month
    or a day of a year of two digits: 240501 would be a day in the year 2405.
    """
    digits = text.replace("_", "-")
    if re.fullmatch(r"[0-9]{6}", digits) and _is_date(digits, "%y%m%d"):
        raise UsageProblem(
            f"the date '{text}' may be year and month or, with a year of two digits, a day; write"
            f" the year with four and the day, or say the form with labels.date in a project file,"
            f" in place of --label: {path}"
        )
    for form in (digits, f"{digits}-01", f"{digits}01"):
        try:
            datetime.fromisoformat(form)
        except ValueError:
            continue
        return form
    raise UsageProblem(
        f"the date '{text}' is none, e.g. 2024-05-01 or 20240501T1430: see --label {path}"
    )


def _is_date(text: str, form: str) -> bool:
    try:
        datetime.strptime(text, form)
    except ValueError:
        return False
    return True


def common(labels: Sequence[Labels]) -> Labels:
    """What several logs have in common."""

    def shared(name: str) -> str | None:
        values = {each.value(name) for each in labels}
        return values.pop() if len(values) == 1 else None

    conditions = sorted({name for each in labels for name in each.conditions})
    found = {name: shared(name) for name in (*OWN, *conditions)}
    return Labels(
        **{name: found[name] for name in OWN},
        conditions={name: v for name in conditions if (v := found[name]) is not None},
    )

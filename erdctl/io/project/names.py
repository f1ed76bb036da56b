"""What the names of files seem to say: proposed in a new project file, never taken unasked."""

from __future__ import annotations

import re
from collections.abc import Sequence

from erdctl.core.errors import InputProblem
from erdctl.core.messages import shown
from erdctl.io.project.labels import groups, labels_of_groups, relative

_DATES = (
    (r"\d{4}-\d{2}-\d{2}", None), (r"20\d{6}", "%Y%m%d"), (r"\d{2}\.\d{2}\.\d{4}", "%d.%m.%Y"),
)  # fmt: skip
_DAMPER = r"[A-Za-z]{1,6}-?\d{1,6}"
_NUMBER = r"-?\d+(?:\.\d+)?"
_CONDITIONS = {"degC": "temperature", "C": "temperature", "Hz": "frequency"}
_PLAIN = """
# How damper, corner, date and conditions are read: by named groups in the path of a log from here
# on, or from the log's columns.
[labels]
# path = '(?P<damper>[A-Z]\\d+)_(?P<date>\\d{8})_(?P<temperature>\\d+)C'
# date = "%Y%m%d"
# columns = { damper = "Specimen", temperature = "T_ambient" }"""


def label_lines(paths: Sequence[str], folder: str) -> list[str]:
    """The table [labels] for files like these: a proposal that all fit, or an example."""
    here = [relative(p, folder).rpartition("/")[2] for p in paths if p != "-"]
    pattern, form = _pattern(here[0]) if here else ("", None)
    found = re.compile(pattern)
    if not pattern or "'" in pattern or not all(found.search(name) for name in here):
        return _PLAIN.split("\n")
    try:
        said = [labels_of_groups(groups(found, name), form, name).texts() for name in here]
    except InputProblem:
        return _PLAIN.split("\n")
    example = ", ".join(f"{name} {text}" for name, text in said[0].items())
    return [
        "",
        "# How damper, corner, date and conditions are read from the path of a log. A proposal:",
        f"# {shown(here[0], 100)} would be {shown(example)}.",
        "[labels]",
        f"# path = '{pattern}'",
        *([f'# date = "{form}"'] if form else []),
        '# columns = { damper = "Specimen" }  # or from columns of the log',
    ]  # fmt: skip


def _pattern(name: str) -> tuple[str, str | None]:
    """A pattern by the parts of a file's name, and the format of its date.

    Check: damper and date, as far as each part is clear.
    >>> _pattern("A07_20240501_warm.csv")
    ('(?P<damper>[A-Za-z]{1,6}-?\\\\d{1,6})_(?P<date>20\\\\d{6})', '%Y%m%d')
    """
    stem = name.rpartition(".")[0] or name
    parts = re.split(r"([_ ]+)", stem)
    out, taken, last = list[str](), set[str](), 0
    form: str | None = None
    for part in parts:
        label, pattern, says = _part(part, taken)
        if label:
            taken.add(label)
            form = says or form
            last = len(out) + 1
        out.append(pattern)
    return "".join(out[:last]), form


def _part(part: str, taken: set[str]) -> tuple[str, str, str | None]:
    for date, form in _DATES:
        if "date" not in taken and re.fullmatch(date, part):
            return "date", f"(?P<date>{date})", form
    if "corner" not in taken and re.fullmatch("fl|fr|rl|rr", part, re.IGNORECASE):
        return "corner", "(?P<corner>[FRfr][LRlr])", None
    if "damper" not in taken and re.fullmatch(_DAMPER, part):
        return "damper", f"(?P<damper>{_DAMPER})", None
    for unit, label in _CONDITIONS.items():
        if label not in taken and re.fullmatch(_NUMBER + unit, part):
            return label, f"(?P<{label}>{_NUMBER}){unit}", None
    return "", re.escape(part) if re.fullmatch(r"[_ ]+", part) else "[^_ /]+", None

"""A project file: what is wrong is said with line and key; nothing else is ever raised."""

from __future__ import annotations

import json
import os
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from erdctl.core.errors import ExitCode, UsageProblem
from erdctl.io.project import find as finding
from erdctl.io.project.file import LARGEST, parse_project, read_project
from erdctl.io.project.labels import Labels
from erdctl.io.project.shape import json_schema

WHOLE = """
schema = "erdctl.project/1"
logs = ["raw/**/*.csv"]
[columns]
t = "Time[ms]"
x = "Defl FL[mm]"
[text]
decimal = "comma"
header = 3
[where]
damper = ["FL", "FR"]
[amplifier]
duty_max = 0.4
slew = 20
[rig]
max_temperature = 55
accept = ["speed_unit"]
[options]
robust = true
[options.diagnose]
jobs = 2
[labels]
path = '(?P<damper>[A-Z]\\d+)_(?P<date>\\d{8})'
date = "%Y%m%d"
columns = { rig = "Rig" }
[corner.fl.columns]
force = "F_fl[N]"
[damper.A07.amplifier]
duty_max = 0.3
[damper.A07.columns]
force = "-F[kN]"
"""

# A file, and what is said of it.
WRONG = {
    "x = [": ("not TOML",),
    "a = 1": ("line 1", "unknown key 'a'"),
    "[amplifier]\n\nduty-max = 0.4": ("line 3", "amplifier.duty-max", "did you mean 'duty_max'"),
    '[amplifier]\nduty_max = "a"': ("line 2", "amplifier.duty_max", "'float'", "'str'"),
    "[amplifier]\nduty_max = 2": ("amplifier", "in 0..1, not 2"),
    "[amplifier]\nslew = inf": ("line 2", "amplifier.slew", "inf"),
    "[amplifier]\nupdate_rate = nan": ("line 2", "amplifier.update_rate", "nan"),
    "[rig]\nmax_temperature = nan": ("line 2", "rig.max_temperature"),
    "[rig]\naccept = [1]": ("line 2", "rig.accept"),
    '[columns]\nxx = "a"': ("line 2", "columns.xx", "no column of erdctl's"),
    "[columns]\nx = 3": ("line 2", "columns.x"),
    '[columns]\nx = ""': ("line 2", "columns.x", "length >= 1"),
    '[columns]\nx = "x[mm]"': ("line 2", "columns.x", 'logs = ["raw/*.csv"]'),
    '[columns]\nforce = "x"': ("line 2", "columns.force", "in SI"),
    '[damper.A.columns]\nx = "a"\n[damper.B.columns]\nforce = 3': (
        "line 4", "damper.B.columns.force",
    ),
    "[damper.B]\nfoo = 1": ("line 2", "damper.B.foo", "unknown key"),
    '[corner.xx]\ntext.decimal = "comma"': ("corner", "'xx'", "fl, fr, rl, rr"),
    '[text]\ndecimal = "x"': ("text", "point, comma"),
    '[text]\ncolour = "red"': ("text", "colour"),
    '[labels]\npath = "a\\d"': ("line 2", "single quotes"),
    "[labels]\npath = '('": ("line 2", "labels.path", "regular expression"),
    "[labels]\npath = 'a'": ("line 2", "labels.path", "no named group"),
    '[labels]\ndate = "heute"': ("line 2", "labels.date", "%Y%m%d"),
    '[labels]\ndate = "%"': ("line 2", "labels.date"),
    '[labels.columns]\n"a b" = "x"': ("labels.columns", "condition"),
    "[options.diagnose]\njobs = { a = 1 }": ("line 2", "options.diagnose.jobs"),
    "[options]\nnoise = inf": ("line 2", "options.noise"),
    "[options]\ndate = 2024-05-01": ("line 2", "options.date", "date"),
    'schema = "erdctl.project/9"': ("line 1", "schema", "erdctl.project/1"),
    'logs = ["[z-a]"]': ("line 1", "logs"),
    "a = " + "[" * 5000: ("brackets",),
}  # fmt: skip


def parsed(text: str | bytes, folder: Path = Path("/lab")) -> Any:
    data = text.encode() if isinstance(text, str) else text
    return parse_project(data, str(folder / "erdctl.toml"))


def test_all_of_it_is_read() -> None:
    project = parsed(WHOLE)
    a, other = Labels(damper="A07", corner="fl"), Labels(damper="B1")
    assert project.mapping(other) == ("t=Time[ms]", "x=Defl FL[mm]")
    assert project.mapping(Labels(corner="fl"))[2:] == ("force=F_fl[N]",)
    # Of a damper wins over of a corner, and that over the rest.
    assert project.mapping(a)[2:] == ("force=-F[kN]",)
    assert {k: s.value for k, s in project.limits(a).items()} == {
        "amplifier.duty_max": 0.3, "amplifier.slew": 20.0, "rig.max_temperature": 55.0,
        "rig.accept": ["speed_unit"],
    }  # fmt: skip
    assert project.limits(a)["amplifier.duty_max"].at == ("damper", "A07")
    assert project.limits(other)["amplifier.duty_max"].value == 0.4
    said = project.options("diagnose", other)
    assert {k: s.value for k, s in said.items()} == {"robust": True, "jobs": 2}
    assert [s.key(k) for k, s in said.items()] == ["options.robust", "options.diagnose.jobs"]
    assert set(project.options("identify", other)) == {"robust"}
    assert project.where(other)["damper"].value == ["FL", "FR"]
    assert project.with_limits_of_their_own() == [("damper", "A07")]
    jsonschema.validate(tomllib.loads(WHOLE), json_schema())


def test_of_one_command_wins_and_of_a_damper_over_it() -> None:
    project = parsed(
        "[options]\nseed = 1\n[options.diagnose]\nseed = 2\n[damper.A.options]\nseed = 3\n"
    )
    assert project.options("diagnose", Labels())["seed"].value == 2
    assert project.options("prove", Labels())["seed"].value == 1
    assert project.options("diagnose", Labels(damper="A"))["seed"].value == 3


@pytest.mark.parametrize("text", WRONG, ids=lambda t: t[:40])
def test_what_is_wrong_is_said_with_its_place(text: str) -> None:
    with pytest.raises(UsageProblem) as error:
        parsed(text)
    message = str(error.value)
    assert error.value.exit_code is ExitCode.USAGE
    assert message.startswith("/lab/erdctl.toml: ")
    assert "\n" not in message
    assert [word for word in WRONG[text] if word not in message] == []


def test_bytes_that_are_no_text() -> None:
    with pytest.raises(UsageProblem, match=r"line 2: not UTF-8"):
        parsed(b"[rig]\n# D\xe4mpfer\n")
    with pytest.raises(UsageProblem, match="1 MB"):
        parsed(b"#" * (LARGEST + 1))
    assert parsed(b"\xef\xbb\xbf[rig]\r\nstrict = true\r\n").content.rig.strict
    assert parsed(b"").mapping(Labels()) == ()


def test_a_file_that_is_none(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "no.toml"):
        with pytest.raises(UsageProblem, match="cannot read the project file"):
            read_project(str(path))


START = "/lab/erdctl.toml: "
LETTERS = "aZ0\u00e4\u20ac\\\"'%[]{}()?<>=#.\n\t\x7f"
KEYS = [
    "columns", "text", "where", "amplifier", "rig", "options", "labels", "corner", "damper", "logs",
    "schema", "fl", "A07", "x", "duty_max", "accept", "path", "date", "a b", "",
]  # fmt: skip
VALUES = st.recursive(
    st.one_of(
        st.booleans(), st.integers(), st.floats(), st.text(LETTERS, max_size=8), st.dates(),
        st.datetimes(),
        st.sampled_from(["(?P<a>", "%", "[mm]", "x[mm]", "-", "0", "\x1b[2J", "\u202e"]),
    ),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(st.sampled_from(KEYS), inner, max_size=4),
    max_leaves=12,
)  # fmt: skip


def toml(value: Any) -> str:
    """A value as TOML writes it, in one line."""
    if isinstance(value, dict):
        inner = ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items())
        return f"{{ {inner} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml, value))}]"
    if isinstance(value, str):
        return json.dumps(value).replace("\x7f", "\\u007f")
    if isinstance(value, bool | float):
        return str(value).lower()
    return value.isoformat() if hasattr(value, "isoformat") else str(value)


@settings(max_examples=50, deadline=None)
@given(st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=6))
def test_any_values_are_read_or_refused(raw: dict[str, Any]) -> None:
    text = "\n".join(f"{json.dumps(k)} = {toml(v)}" for k, v in raw.items())
    try:
        project = parsed(text)
    except UsageProblem as error:
        said = str(error)
    else:
        said = START
        jsonschema.validate(tomllib.loads(text), json_schema())
        assert isinstance(project.mapping(Labels("A07", "fl")), tuple)
    assert said.startswith(START)


@settings(max_examples=50, deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    try:
        parsed(data)
    except UsageProblem as error:
        said = str(error)
    else:
        said = START
    assert said.startswith(START)


def test_the_nearest_file_upward_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = tmp_path / "home"
    deep = home / "lab" / "raw" / "may"
    deep.mkdir(parents=True)
    monkeypatch.setenv("HOME", str(home))
    (tmp_path / finding.FILE).write_text("")  # above home: never asked for below it
    assert finding.find(str(deep)) is None
    (home / finding.FILE).write_text("")
    assert finding.find(str(deep)) == str(home / finding.FILE)
    (home / "lab" / finding.FILE).write_text("")
    assert finding.find(str(deep)) == str(home / "lab" / finding.FILE)
    (deep / finding.FILE).mkdir()  # a folder of that name is none
    assert finding.find(str(deep)) == str(home / "lab" / finding.FILE)
    # Not below home: up to the root.
    other = tmp_path / "mnt" / "bench"
    other.mkdir(parents=True)
    assert finding.find(str(other)) == str(tmp_path / finding.FILE)


def test_a_stranger_s_file_in_a_folder_for_all_is_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    shared = tmp_path / "shared"
    shared.mkdir()
    (shared / finding.FILE).write_text("")
    shared.chmod(0o1777)
    assert finding.find(str(shared)) == str(shared / finding.FILE)  # one's own
    own = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: own + 1)
    if (shared / finding.FILE).stat().st_uid != 0:
        assert finding.find(str(shared)) is None

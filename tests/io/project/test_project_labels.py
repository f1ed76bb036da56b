"""Damper, corner, date and conditions out of paths; which logs a project is for."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from erdctl.core.errors import InputProblem
from erdctl.io.project.file import parse_project
from erdctl.io.project.labels import Labels, labels_of_groups
from erdctl.io.project.patterns import pattern_of
from erdctl.io.project.project import Project

PATTERN = r"(?P<damper>[A-Z]\d+)_(?P<date>\d{8})_(?P<temperature>\d+)C(_(?P<corner>\w\w))?"


def project(labels: str = f"path = '{PATTERN}'\ndate = '%Y%m%d'", top: str = "") -> Project:
    return parse_project(f"{top}\n[labels]\n{labels}\n".encode(), "/lab/erdctl.toml")


def test_labels_of_a_path() -> None:
    p = project()
    assert p.labels("/lab/raw/A07_20240501_25C.csv") == Labels(
        "A07", None, "2024-05-01", {"temperature": "25"}
    )
    assert p.labels("/lab/A07_20240501_25C_FL.csv").corner == "fl"
    # A path that does not fit, and standard input, say nothing.
    assert p.labels("/lab/other.csv") == p.labels("-") == Labels()


def test_folders_below_the_project_count_and_those_above_do_not() -> None:
    p = project(r"path = '^(?P<damper>\w+)/(?P<date>\d{4}-\d{2}-\d{2})'")
    assert p.labels("/lab/A07/2024-05-01.csv") == Labels("A07", date="2024-05-01")
    assert p.labels("/lab/x/A07/2024-05-01.csv") == Labels()


def test_a_damper_of_all_logs_that_name_none() -> None:
    p = project(f"path = '{PATTERN}'\ndamper = 'B1'")
    assert [p.labels(q).damper for q in ("-", "x.csv", "A07_20240501_25C.csv")] == [
        "B1", "B1", "A07",
    ]  # fmt: skip


def test_a_column_wins_over_the_path() -> None:
    p = project()
    found = p.labels("/lab/A07_20240501_25C.csv", {"damper": "B2", "rig": "3"})
    assert found == Labels("B2", None, "2024-05-01", {"temperature": "25", "rig": "3"})
    assert found.texts() == {
        "damper": "B2", "date": "2024-05-01", "conditions": "temperature 25, rig 3",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("/lab/A07_20241399_25C.csv", "date is '20241399'"),
        ("/lab/A07_20240501_25C_XX.csv", "corner is 'XX'"),
    ],
)
def test_labels_that_are_none_are_refused(path: str, words: str) -> None:
    with pytest.raises(InputProblem, match=words) as error:
        project().labels(path)
    assert path in str(error.value)


def test_a_date_keeps_its_time_of_day() -> None:
    assert labels_of_groups({"date": "2024-05-01 14:30"}, None, "a").date == "2024-05-01T14:30:00"
    assert labels_of_groups({"date": "1.5.2024"}, "%d.%m.%Y", "a").date == "2024-05-01"


TEXTS = st.text("aF l0-2.:\u00e4\x1b\u202e", max_size=250) | st.sampled_from(["FL", "2024-05-01"])


@given(st.dictionaries(st.sampled_from(["damper", "corner", "date", "a"]), TEXTS))
def test_any_text_is_a_label_or_refused(found: dict[str, str]) -> None:
    try:
        texts = labels_of_groups(found, None, "a.csv").texts()
    except InputProblem as error:
        texts, said = {}, str(error)
    else:
        said = "a.csv: "
    assert said.startswith("a.csv: ")
    assert all(text.isprintable() and text.strip() for text in texts.values())


@pytest.mark.parametrize(
    ("glob", "path", "fits"),
    [
        ("raw/*.csv", "raw/a.csv", True),
        ("raw/*.csv", "raw/b/a.csv", False),
        ("raw/**/*.csv", "raw/b/c/a.csv", True),
        ("**/*.csv", "a.csv", True),
        ("raw/**", "raw/b/a.txt", True),
        ("a?.csv", "ab.csv", True),
        ("a?.csv", "a/.csv", False),
        ("[ab].csv", "b.csv", True),
        ("[!ab].csv", "b.csv", False),
        ("a+(b).csv", "a+(b).csv", True),
        ("./raw/*", "raw/x", True),
    ],
)
def test_patterns_of_paths(glob: str, path: str, *, fits: bool) -> None:
    assert bool(pattern_of(glob).fullmatch(path)) is fits


def test_which_logs_a_project_is_for() -> None:
    assert project().reads("/anywhere/a.csv")
    only = project(top='logs = ["raw/*.csv"]')
    assert only.reads("/lab/raw/a.csv")
    assert not only.reads("/lab/a.csv")
    assert not only.reads("-")

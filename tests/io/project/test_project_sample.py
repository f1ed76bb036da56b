"""`project init`: the file out of a sample log gives the same reading as the log without it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lab_files import ALL, LabFile
from places import FIXTURES

from erdctl.core.errors import ErdctlError
from erdctl.io.convert import read_converted
from erdctl.io.logs import read_logs
from erdctl.io.project.file import parse_project
from erdctl.io.project.labels import Labels
from erdctl.io.project.project import Project
from erdctl.io.project.reading import ProjectReading
from erdctl.io.project.sample import project_text

N = 50
T = np.arange(N) * 0.01


def initialised(path: Path, *, text: tuple[str, ...] = ()) -> Project:
    """The project that a sample gives, read back."""
    found = project_text([str(path)], str(path.parent), text=text, say=lambda line: None)
    return parse_project(found.encode(), str(path.parent / "erdctl.toml"))


def table(path: Path, project: Project | None, **options: Any) -> pa.Table:
    by = None if project is None else ProjectReading(project)
    return read_converted(str(path), project=by, say=lambda line: None, **options)


def same(one: pa.Table, other: pa.Table) -> bool:
    return bool(one.equals(other, check_metadata=True))


@pytest.mark.parametrize("make", ALL, ids=lambda make: make.__name__)
def test_files_of_labs(make: Any, tmp_path: Path) -> None:
    lab: LabFile = make()
    path = tmp_path / lab.name
    path.write_bytes(lab.data)
    # What lab files need besides is said here as there; a column that has no unit is a comment.
    spec = tuple(o for k, o in zip(lab.options, lab.options[1:], strict=False) if k == "--text")
    project = initialised(path, text=spec)
    assert same(table(path, None, text=spec), table(path, project))
    if not lab.options:
        read = read_logs([str(path)], need_force=True, report=lambda line: None).recording
        again = read_logs(
            [str(path)], need_force=True, report=lambda line: None, project=ProjectReading(project)
        ).recording
        assert np.array_equal(read.force, again.force)
        assert np.array_equal(read.xdot, again.xdot)


@pytest.mark.parametrize("name", ["foreign.csv", "schedule_60s.csv", "healthy_campaign.parquet"])
def test_fixtures(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes((FIXTURES / name).read_bytes())
    assert same(table(path, None), table(path, initialised(path)))


NAMES = st.text("tx F[]()'\"\\=#-.%mNs\u00e4\u2028", min_size=1, max_size=12) | st.sampled_from([
    "Time (ms)", "Time [s]", "time", "Displacement [mm]", "Weg (Zoll)", "Force [Newton]", "Load/kN",
    "Duty [%]", "x [mm]", "x", "t", "force", "F [N]", "F_fl [N]", "F_fr [N]", "x_fl [mm]", "PWM_rl",
    "record", "velocity, mm/s", "Kraft (kN)", "temperature [K]", " x ", "-x", "0",
])  # fmt: skip


@settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(names=st.lists(NAMES, min_size=1, max_size=6, unique=True))
def test_any_names_of_columns(names: list[str], tmp_path: Path) -> None:
    """What is written is TOML, is accepted, and changes no number."""
    path = tmp_path / "log.parquet"
    pq.write_table(pa.table({name: T + i for i, name in enumerate(names)}), path)
    try:
        plain = table(path, None)
    except ErdctlError:
        return  # a unit that does not fit is refused with and without a project
    project = initialised(path)
    if not project.content.corner:
        assert same(plain, table(path, project))


def test_a_car_has_a_table_for_each_corner(tmp_path: Path) -> None:
    path = tmp_path / "car.parquet"
    columns = {"Time [s]": T, "PWM": T}
    for i, corner in enumerate(("FL", "FR", "RL", "RR")):
        columns |= {f"Defl {corner} [mm]": T + i, f"F_{corner} [kN]": T - i, f"n_{corner}": T}
    pq.write_table(pa.table(columns), path)
    project = initialised(path)
    assert project.mapping(Labels()) == ("t=Time [s]",)
    assert list(project.content.corner) == ["fl", "fr", "rl", "rr"]
    assert project.mapping(Labels(corner="rl"))[1:] == ("x=Defl RL [mm]", "force=F_RL [kN]")
    by = ProjectReading(project, corner="rr")
    given = {"maps": ["duty=PWM"], "need_force": True, "report": lambda line: None}
    read = read_logs([str(path)], project=by, **given).recording
    assert np.allclose(read.force, 1e3 * (T - 3))
    assert np.allclose(read.x, 1e-3 * (T + 3))


def test_what_is_not_clear_is_a_comment(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    pq.write_table(pa.table({"Time": T, "Force 1 [N]": T, "Force 2 [N]": T, "Weg [mm]": T}), path)
    text = project_text([str(path)], str(tmp_path), text=None, say=lambda line: None)
    assert '# t = "Time[s]"  # its unit is not stated; complete it' in text
    assert '# force = "Force 1 [N]"' in text
    assert '\nx = "Weg [mm]"' in text
    assert '# duty = "NAME[UNIT]"  # not found' in text


def test_names_of_files_are_a_proposal_that_fits(tmp_path: Path) -> None:
    paths = [tmp_path / "raw" / f"A0{i}_2024050{i}_fl_25C.csv" for i in (1, 2)]
    paths[0].parent.mkdir()
    for path in paths:
        path.write_bytes((FIXTURES / "foreign.csv").read_bytes())
    text = project_text(list(map(str, paths)), str(tmp_path), text=None, say=lambda line: None)
    assert "would be damper A01, corner fl, date 2024-05-01, conditions temperature 25." in text
    taken = text.replace("# path = ", "path = ").replace('# date = "', 'date = "')
    project = parse_project(taken.encode(), str(tmp_path / "erdctl.toml"))
    assert [project.labels(str(p)) for p in paths] == [
        Labels(f"A0{i}", "fl", f"2024-05-0{i}", {"temperature": "25"}) for i in (1, 2)
    ]
    # Names that have nothing in common propose nothing.
    other = tmp_path / "b.csv"
    other.write_bytes(paths[0].read_bytes())
    both = project_text([str(paths[0]), str(other)], str(tmp_path), text=None, say=print)
    assert "A proposal" not in both


def test_other_samples_are_compared(tmp_path: Path) -> None:
    one, two = tmp_path / "a.parquet", tmp_path / "b.parquet"
    pq.write_table(pa.table({"t": T, "x": T, "Oil [degC]": T}), one)
    pq.write_table(pa.table({"t": T, "x": T}), two)
    said: list[str] = []
    project_text([str(one), str(two)], str(tmp_path), text=None, say=said.append)
    assert any("b.parquet: without Oil [degC]" in line for line in said)

"""Damper property files, read back by a parser that knows only the format's description.

Blocks in [brackets], sub-blocks in (parentheses), tables in {braces} with their columns' names;
KEY = value; texts in single quotes; lines that begin with $ or ! are comments.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from dampers import damper
from scipy.interpolate import Akima1DInterpolator

from erdctl.core.errors import UsageProblem
from erdctl.export.origin import Origin
from erdctl.export.tables.files import write_table
from erdctl.export.tables.grid import Asked, grid
from erdctl.export.tables.peak_map import peak_map

ORIGIN = Origin(name="damper.json", sha256="0" * 64)
TO_SI = {"mm": 1e-3, "m": 1.0, "meter": 1.0, "newton": 1.0, "second": 1.0, "sec": 1.0}


@dataclass
class OrbitBlock:
    keys: dict[str, str | float] = field(default_factory=dict)
    columns: list[str] = field(default_factory=list)
    rows: list[list[float]] = field(default_factory=list)


def read(text: str) -> tuple[dict[str, OrbitBlock], list[str]]:
    """Blocks by name, and comments."""
    blocks: dict[str, OrbitBlock] = {}
    comments: list[str] = []
    block: OrbitBlock | None = None
    for number, line in enumerate(text.split("\n"), start=1):
        assert len(line) <= 80, f"line {number} is cut by readers of punched-card width"
        word = line.strip()
        if not word:
            continue
        if word[0] in "$!":
            comments.append(word[1:].strip())
        elif word[0] == "[":
            assert word[-1] == "]"
            block = blocks.setdefault(word[1:-1], OrbitBlock())
        elif word[0] == "{":
            assert block is not None
            assert word[-1] == "}"
            block.columns = word[1:-1].split()
        elif "=" in word:
            assert block is not None
            key, value = (part.strip() for part in word.split("=", 1))
            quoted = value[0] == value[-1] == "'"
            block.keys[key] = value[1:-1] if quoted else float(value)
        else:
            assert block is not None
            block.rows.append([float(number) for number in word.split()])
            assert len(block.rows[-1]) == len(block.columns)
    return blocks, comments


def written(path: Path, parameters: Any, **asked: Any) -> str:
    write_table(parameters, str(path), Asked(**asked), ORIGIN)
    text = path.read_bytes().decode("ascii")
    assert text.endswith("\n")
    assert "\r" not in text
    return text


def curve(text: str) -> tuple[np.ndarray, np.ndarray]:
    """Speed [m/s] and force [N] as the file counts them."""
    blocks, _ = read(text)
    units = blocks["UNITS"].keys
    v, force = np.array(blocks["CURVE"].rows).T
    length, time = (TO_SI[str(units[k])] for k in ("LENGTH", "TIME"))
    return v * length / time, force * TO_SI[str(units["FORCE"])]


def test_the_file_is_one_that_the_format_describes(tmp_path: Path) -> None:
    blocks, comments = read(written(tmp_path / "d.dpr", damper(errors=0.01), duty=(0.3,)))
    assert list(blocks) == ["MDI_HEADER", "UNITS", "CURVE"]
    assert blocks["MDI_HEADER"].keys == {
        "FILE_TYPE": "dpr", "FILE_VERSION": 4.0, "FILE_FORMAT": "ASCII",
    }  # fmt: skip
    assert set(blocks["UNITS"].keys) == {"LENGTH", "ANGLE", "FORCE", "MASS", "TIME"}
    assert blocks["CURVE"].columns == ["vel", "force"]
    assert len(blocks["CURVE"].rows) == 40
    said = " ".join(comments)
    for word in ("duty 0.3", "0" * 64, "extension", "NRMSE", "hold the gas spring", "stderr [N]"):
        assert word in said, word


def test_the_curve_is_the_map_with_both_signs_turned(tmp_path: Path) -> None:
    p = damper()
    table = peak_map(p, grid(p, Asked(duty=(0.3,))))
    v, force = curve(written(tmp_path / "d.dpr", p, duty=(0.3,)))
    assert (np.diff(v) > 0).all()
    assert -v[::-1] == pytest.approx(table.grid.speed, rel=1e-8)
    assert -force[::-1] == pytest.approx(table.force[:, 0], rel=1e-8)
    # Extension is positive, so the larger speed of compression is at the negative end.
    assert (v[0], v[-1]) == pytest.approx((-0.2, 0.15))
    # A damper gives nothing back: first and third quadrant.
    assert (force * v > 0).all()
    other, same = curve(written(tmp_path / "d.dpr", p, duty=(0.3,), extension=False))
    assert other == pytest.approx(table.grid.speed, rel=1e-8)
    assert same == pytest.approx(table.force[:, 0], rel=1e-8)


def test_errors_stand_in_the_comments(tmp_path: Path) -> None:
    p = damper(errors=0.02)
    table = peak_map(p, grid(p, Asked(points=4, duty=(0.3,))))
    _, comments = read(written(tmp_path / "d.dpr", p, points=4, duty=(0.3,)))
    start = next(i for i, c in enumerate(comments) if c.startswith("vel [mm/s]"))
    rows = np.array([[float(n) for n in c.split()] for c in comments[start + 1 : start + 9]])
    assert -1e-3 * rows[::-1, 0] == pytest.approx(table.grid.speed, rel=1e-5)
    assert rows[::-1, 2] == pytest.approx(table.stderr[:, 0], rel=1e-2)


def test_a_spline_through_the_curve_does_not_overshoot_the_jump(tmp_path: Path) -> None:
    """Vehicle programs read it with Akima splines; a row at 0 could make them overshoot."""
    v, force = curve(written(tmp_path / "d.dpr", damper(), duty=(0.4,)))
    low, high = v[v < 0].max(), v[v > 0].min()
    fine = np.linspace(v[0], v[-1], 20001)
    inner = (fine > low) & (fine < high)
    found, straight = Akima1DInterpolator(v, force)(fine), np.interp(fine, v, force)
    size = np.ptp(force)
    assert np.abs(found - straight)[~inner].max() < 2e-3 * size
    ends = np.interp([low, high], v, force)
    assert ends[0] - 1e-3 * size < found[inner].min()
    assert found[inner].max() < ends[1] + 1e-3 * size
    # With a row at 0, on the line, it would.
    at, middle = np.searchsorted(v, 0.0), np.interp(0.0, v, force)
    kinked = Akima1DInterpolator(np.insert(v, at, 0.0), np.insert(force, at, middle))(fine)
    assert np.abs(kinked - straight)[~inner].max() > 0.05 * size


def test_no_field_is_the_default_and_one_duty_the_most(tmp_path: Path) -> None:
    p = damper()
    free, held = (written(tmp_path / "d.dpr", p, **a) for a in ({}, {"duty": (0.0,)}))
    assert free == held
    with pytest.raises(UsageProblem, match="one curve"):
        written(tmp_path / "d.dpr", p, duty=(0.1, 0.2))


@pytest.mark.parametrize(("duty", "jumps"), [(0.0, False), (0.3, True)])
def test_a_jump_at_rest_is_said_of_a_curve_that_has_one(
    duty: float, jumps: bool, tmp_path: Path
) -> None:
    """Without field the force is k_nom x + c_vis xdot, a line through 0."""
    p = damper()
    text = written(tmp_path / "d.dpr", p, duty=(duty,))
    said = " ".join(read(text)[1])
    assert ("jumps" in said) is jumps
    assert "between 0.375 mm/s in release and 0.5 mm/s in compression is a" in said
    # With rubbing seals it has one without field, too.
    rubbing = read(written(tmp_path / "d.dpr", damper("coulomb_friction", F_c=2.0)))[1]
    assert "jumps" in " ".join(rubbing)


def test_a_name_in_the_parameters_cannot_leave_its_comment(tmp_path: Path) -> None:
    p = damper()
    evil = {"logs": [{"name": "a\n[CURVE]\n1 2\u00e9", "sha256": "x\r\n[UNITS]"}]}
    changed = type(p)(model=p.model, estimates=p.estimates, provenance=evil)
    blocks, comments = read(written(tmp_path / "d.dpr", changed))
    assert list(blocks) == ["MDI_HEADER", "UNITS", "CURVE"]
    assert len(blocks["CURVE"].rows) == 40
    assert any(r"\n[CURVE]" in c for c in comments)

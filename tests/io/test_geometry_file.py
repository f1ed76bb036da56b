"""The geometry file: units, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from places import FIXTURES

from erdctl.core.errors import InputProblem
from erdctl.io.geometry import read_geometry

INOVE = json.loads((FIXTURES / "geometry_inove.json").read_text())


def written(folder: Path, **changed: object) -> str:
    file = folder / "g.json"
    file.write_text(json.dumps({**INOVE, **changed}))
    return str(file)


@pytest.mark.parametrize("unit", ["kPa", "Pa (mm/V)^beta", "mm"])
def test_a_yield_stress_in_a_unit_that_is_not_converted_is_refused(
    unit: str, tmp_path: Path
) -> None:
    file = written(tmp_path, alpha={"value": 5.0, "unit": unit})
    with pytest.raises(InputProblem, match=r"alpha is given in .*; expected Pa \(m/V\)\^beta"):
        read_geometry(file)


def test_a_yield_stress_may_say_its_own_unit(tmp_path: Path) -> None:
    file = written(tmp_path, alpha={"value": 5.0, "unit": "Pa (m/V)^beta"})
    assert read_geometry(file).alpha == 5.0

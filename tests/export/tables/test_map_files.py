"""CSV and MAT of a map, read back, and what a table costs."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from dampers import damper
from scipy.io import loadmat

from erdctl.export.origin import Origin
from erdctl.export.tables.files import write_table
from erdctl.export.tables.grid import Asked, grid
from erdctl.export.tables.peak_map import peak_map
from erdctl.export.tables.static_cost import static_cost
from erdctl.model.parameters import Parameters

ORIGIN = Origin(name="damper.json", sha256="0" * 64)
ASKED = Asked(points=3, duty=(0.0, 0.1, 0.3))


@pytest.fixture(scope="module")
def parameters() -> Parameters:
    return damper("force_drift", errors=0.01)


def test_csv_reads_back_exactly(parameters: Parameters, tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    remarks = write_table(parameters, str(path), ASKED, ORIGIN)
    text = path.read_text(encoding="ascii")
    head = [line for line in text.splitlines() if line.startswith("#")]
    frame = pd.read_csv(io.StringIO(text), comment="#")
    p = damper(errors=0.01)
    table = peak_map(p, grid(p, ASKED))
    assert list(frame.columns) == ["xdot", "duty", "force", "stderr"]
    for name in ("force", "stderr"):
        pivot = frame.pivot(index="xdot", columns="duty", values=name)
        assert (pivot.to_numpy() == getattr(table, name)).all()
        assert (pivot.index == table.grid.speed).all()
    assert "positive in compression" in head[0]
    said = "\n".join(head)
    for word in ("NRMSE", "cannot hold", "force_drift", "0" * 64, "duty [1]"):
        assert word in said, word
    assert any("force_drift" in r for r in remarks)


def test_mat_has_matrices_units_and_words(parameters: Parameters, tmp_path: Path) -> None:
    path = tmp_path / "map.mat"
    write_table(parameters, str(path), ASKED, ORIGIN)
    found = loadmat(path, squeeze_me=False)
    assert found["force"].shape == found["stderr"].shape == (6, 3)
    assert found["xdot"].shape == (6, 1)
    assert found["duty"].tolist() == [[0.0, 0.1, 0.3]]
    p = damper(errors=0.01)
    table = peak_map(p, grid(p, ASKED))
    assert (found["force"] == table.force).all()
    assert str(found["units"]["force"][0, 0][0]) == "N"
    notes = [str(n[0][0]) for n in found["notes"]]
    assert any("cannot hold" in n for n in notes)
    assert float(found["nrmse"].item()) == pytest.approx(static_cost(p, table).held)


def test_the_cost_is_that_of_gas_lag_and_loop() -> None:
    """Without gas and lag a fine table costs nothing while the duty is held."""
    from dataclasses import replace

    p = damper()
    gone = {f"{d}.{s}": replace(p.estimates[f"{d}.{s}"], value=0.0)
            for d in ("compression", "release") for s in ("k_nom", "T_d")}  # fmt: skip
    plain = replace(p, estimates={**p.estimates, **gone})
    asked = Asked(points=40, duty=(0.0, 0.3))
    without = static_cost(plain, peak_map(plain, grid(plain, asked)))
    assert without.held < 5e-3  # what is left is the line over the jump
    assert without.stepping is not None
    assert without.stepping < 5e-3
    gas = replace(p, estimates={**p.estimates, **{k: gone[k] for k in gone if "T_d" in k}})
    springy = static_cost(gas, peak_map(gas, grid(gas, asked)))
    k = [p.values[f"{d}.k_nom"] for d in ("compression", "release")]
    assert springy.spring == pytest.approx(np.mean(k), rel=0.02)
    assert springy.beside < 0.5 * springy.held
    lag = static_cost(p, peak_map(p, grid(p, asked)))
    assert lag.stepping is not None
    assert lag.stepping > 1.2 * lag.held > 0.01


def test_one_level_of_duty_has_no_steps() -> None:
    p = damper()
    found = static_cost(p, peak_map(p, grid(p, Asked(duty=(0.2,), points=4))))
    assert found.stepping is None
    assert 0.0 < found.held < 0.2

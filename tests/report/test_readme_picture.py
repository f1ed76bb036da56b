"""The README's picture: its command still makes it, and what it shows is so."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import oracle
import pytest
import trajectories
from drawing import labels, line, panels, run, units
from matplotlib.figure import Figure
from PIL import Image
from places import FIXTURES, ROOT
from scipy.spatial import cKDTree

from erdctl.io.logs import read_logs


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Figure, Path]:
    text = (ROOT / "README.md").read_text()
    assert "](fixtures/worn_joint.png)" in text
    (command,) = re.findall(r"`(erdctl diagnose fixtures/worn_joint[^`]*)`", text)
    # CI runs it with the whole catalogue, which leaves nothing else in the picture.
    command = command.replace("diagnose ", "diagnose --effects backlash,coulomb_friction ")
    folder = tmp_path_factory.mktemp("readme")
    with pytest.MonkeyPatch.context() as patch:
        (figure,) = run(command, patch, folder)
    return figure, folder


def rod_and_force(record: str, duty: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, xdot [mm, mm/s] of the rod and the exact force [N] behind 2 mm of play, finely sampled."""
    log = read_logs([str(FIXTURES / "worn_joint.parquet")], need_force=True, report=str).recording
    part = log.slices[log.names.index(record)]
    t = np.arange(0.0, log.t[part][-1], 1e-4)
    w = 2 * np.pi * float(re.findall(r"_([\d.]+)Hz", record)[0])
    a, b = np.linalg.lstsq(
        np.column_stack([np.sin(w * log.t[part]), np.cos(w * log.t[part])]), log.x[part], rcond=None
    )[0]
    x, xdot = a * np.sin(w * t) + b * np.cos(w * t), w * (a * np.cos(w * t) - b * np.sin(w * t))
    piston = trajectories.play(x, 2e-3)
    moved = np.append(np.diff(piston) != 0, False)
    force = oracle.respond(t, piston, np.where(moved, xdot, 0.0), np.full_like(t, duty)).force
    return 1e3 * x, 1e3 * xdot, force


def test_the_corrected_loops_are_the_true_ones(made: tuple[Figure, Path]) -> None:
    figure, folder = made
    document = json.loads((folder / "diagnosis.json").read_text())
    assert document["verdict"] == "explained"
    assert [f["effect"] for f in document["findings"]] == ["backlash"]
    assert document["findings"][0]["parameters"]["g"]["value"] == pytest.approx(2e-3, rel=0.02)
    assert all("[" in text for text in units(figure))
    axes = panels(figure)
    assert labels(axes[0]) == {f"{n} {d} %" for n in ("measured", "paper's model")
                               for d in (0, 15, 30)}  # fmt: skip
    for column, name in ((0, "paper's model"), (1, "with backlash")):
        figures = axes[column].get_title(loc="left").split("NRMSE ")[1]
        before = document["baseline" if column == 0 else "corrected"]["nrmse"]
        assert figures.startswith(f"{before:.4f}")
        for level, record in ((30, "sine_0.73Hz_pwm30"), (0, "sine_0.73Hz_pwm0")):
            x, y = line(axes[column], f"{name} {level} %")
            rod, _, force = rod_and_force(record, level / 100)
            far = (np.abs(x) > 10.5) & (np.abs(x) < 17.5)  # where only this record goes
            assert np.count_nonzero(far) > 50
            curve = cKDTree(np.column_stack([rod / 36, force / 35]))
            away, _ = curve.query(np.column_stack([x[far] / 36, y[far] / 35]))
            # Parts of the panel: hair's breadth after, plainly off it before.
            if column:
                assert np.quantile(away, 0.95) < 0.012
            else:
                assert np.quantile(away, 0.5) > 0.02


def test_the_committed_picture_is_that_one(made: tuple[Figure, Path]) -> None:
    kept = FIXTURES / "worn_joint.png"
    assert kept.stat().st_size < 150_000
    new, old = (Image.open(p).convert("L") for p in (made[1] / "worn_joint.png", kept))
    assert new.size == old.size
    # Coarsely: fonts differ a little from version to version.
    a, b = (np.asarray(image.resize((75, 54)), float) for image in (new, old))
    assert np.abs(a - b).mean() < 4.0

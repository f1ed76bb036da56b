"""The files that examples in the help texts and the README name: the one place to add another.

Each is made in the folder in which an example runs, and only if the example names it.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli.app import build

Make = Callable[[Path], None]


def copy(name: str) -> Make:
    """A fixture under another name."""
    return lambda path: shutil.copyfile(FIXTURES / name, path) and None


def bench(*records: str) -> Make:
    """Records of the campaign at 125 Hz, as CSV or Parquet; with a lab's own names, too."""

    def make(path: Path) -> None:
        log = pd.read_parquet(FIXTURES / "healthy_campaign.parquet")
        log = log[log["record"].isin(records)].iloc[::4]
        log = log.assign(**{"F_fl": log["force"], "Defl FL": 1e3 * log["x"]})
        if path.suffix == ".parquet":
            log.to_parquet(path, index=False)
        else:
            log.to_csv(path, index=False)

    return make


def converted(path: Path) -> None:
    """The bench log in the format that the suffix says."""
    source = path.with_suffix(".original.parquet")
    FILES["bench.parquet"](source)
    done = CliRunner().invoke(build(["convert"]), ["convert", str(source), str(path)])
    assert done.exit_code == 0, done.stderr


def lab_text(path: Path) -> None:
    """A text as a lab writes it: tabs, decimal commas, units in names, a line above."""
    log = pd.read_csv(FIXTURES / "foreign.csv")
    log = log[["Time", "Defl FL", "F_fl", "PWM"]]
    log.columns = ["Time (ms)", "Deflection (mm)", "Load (N)", "PWM (%)"]
    table = log.to_csv(index=False, sep="\t", decimal=",", lineterminator="\r\n")
    path.write_text("Bench 3\r\n" + table, encoding="utf-16", newline="")


def lab_tdms(path: Path) -> None:
    """A TDMS file as a lab writes it: own names, deflection in mm, force in kN."""
    nptdms = pytest.importorskip("nptdms")
    log = pd.read_csv(FIXTURES / "foreign.csv")
    columns = {
        "t": (1e-3 * log["Time"], "s"), "Defl FL": (log["Defl FL"], "mm"),
        "F_fl": (1e-3 * log["F_fl"], "kN"), "duty": (0.01 * log["PWM"], "1"),
    }  # fmt: skip
    with nptdms.TdmsWriter(str(path)) as file:
        file.write_segment([
            nptdms.ChannelObject("bench", name, values.to_numpy(), {"unit_string": unit})
            for name, (values, unit) in columns.items()
        ])  # fmt: skip


def learned(path: Path) -> None:
    """Parameters with a law that was learned: less viscosity with each pass over a place."""
    document = json.loads((FIXTURES / "table_2.json").read_text())
    law = {
        "slot": "viscous", "coordinates": [{"name": "passes"}], "form": "saturation",
        "knots": [0.0, 9.0],
    }  # fmt: skip
    sizes = {"a": {"value": -0.3, "unit": "1"}, "w": {"value": 4.0, "unit": "1"}}
    document["effects"] = [{"effect": "learned", "law": law, "parameters": sizes}]
    path.write_text(json.dumps(document))


def in_mm(path: Path) -> None:
    """A log as a lab names it, in a folder of its own: units in names, percent and mm."""
    path.parent.mkdir(exist_ok=True)
    log = pd.read_csv(FIXTURES / "foreign.csv")[["Time", "Defl FL", "F_fl", "PWM"]]
    log.columns = ["Time (ms)", "Deflection (mm)", "Load (N)", "PWM (%)"]
    log.to_csv(path, index=False)


def car(path: Path) -> None:
    """A log of four dampers beside one another."""
    log = pd.read_parquet(FIXTURES / "healthy_campaign.parquet")
    log = log[log["record"].isin(["sine_2Hz_11mm_pwm0", "steps_1", "steps_3"])].iloc[::4]
    columns = {"Time [s]": log["t"], "record": log["record"]}
    for corner in ("fl", "fr", "rl", "rr"):
        columns |= {f"x_{corner} [mm]": 1e3 * log["x"], f"F_{corner} [N]": log["force"]}
        columns[f"duty_{corner} [%]"] = 100 * log["duty"]
    pd.DataFrame(columns).to_parquet(path, index=False)


def campaign_table(path: Path) -> None:
    """Four dampers over forty months, three of which wear."""
    import pyarrow.parquet as pq
    from fleets import draw

    pq.write_table(draw(3, dampers=4, months=40)[0], path)


def bands(path: Path) -> None:
    """Tolerances that all these dampers hold."""
    path.write_text("c_vis = { low = 10, high = 90 }\nsigma = { low = 1 }\n")


def a_lab(path: Path) -> None:
    """Logs of two dampers in folders of their own."""
    for name in ("D01/2024-05.csv", "D02/2024-05.csv"):
        log = path / name
        log.parent.mkdir(parents=True)
        bench("sine_2Hz_11mm_pwm0", "steps_1")(log)


FILES: dict[str, Make] = {
    "raw/A07_20240501_25C.csv": in_mm,
    "car.parquet": car,
    "results.parquet": campaign_table,
    "limits.toml": bands,
    "bench.csv": bench("sine_2Hz_11mm_pwm0", "steps_1", "steps_3"),
    "bench.parquet": bench("sine_2Hz_11mm_pwm0", "steps_1", "steps_3"),
    "bench.mf4": converted,
    "bench.tdms": lab_tdms,
    "a.csv": bench("sine_2Hz_11mm_pwm0", "steps_1"),
    "b.csv": bench("steps_2", "steps_3"),
    "later.csv": bench("sine_0.5Hz_20mm_pwm0", "steps_2"),
    "other.csv": bench("steps_2", "random_2"),
    "new.csv": bench("steps_4", "random_2"),
    "lab.csv": copy("foreign.csv"),
    "lab.txt": lab_text,
    "drive.csv": copy("schedule_60s.csv"),
    "dyno.csv": bench("sine_2Hz_11mm_pwm0", "sine_0.5Hz_20mm_pwm0", "steps_1"),
    "damper.json": copy("table_2.json"),
    "old.json": copy("table_2.json"),
    "new.json": copy("table_2.json"),
    "geometry.json": copy("geometry_inove.json"),
    "learned.json": learned,
    "lab": a_lab,
}


def place(folder: Path, command: str) -> None:
    """Put the files that a command names into the folder in which it runs."""
    words = command.replace("=", " ").replace(":", " ").split()
    for name, make in FILES.items():
        if name in words and not (folder / name).exists():
            make(folder / name)

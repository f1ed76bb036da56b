"""What looks like a temperature, and what does not; what the guard of mimic makes of it."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from places import FIXTURES
from typer.testing import CliRunner

import erdctl
from erdctl.cli.app import build
from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.stored import with_units
from erdctl.io.tables import write_table
from erdctl.io.temperature import looks_like_temperatures

TABLE_2 = FIXTURES / "table_2.json"
LOOK = (
    "Temperature", "TEMPERATURE", "temp", "Temp. FL", "temp_1", "TEMP1", "tmp_oil", "OilTemp",
    "oiltemp", "oilTempFL", "oil_temp", "tempC", "tempsensor", "temperature_fl", "Temperatur_FL",
    "Öltemperatur", "température huile", "temps_oil", "温度", "Oil [degC]", "Oil [°C]", "Oil [K]",
    "Oil (°F)", "Oil (C)", "Temp (°C)", "Fluid [Kelvin]", "CH5 [deg C]", "AI3 (℃)", "Oil °C",
    "oil_degC", "TempFL[degF]", "T", "T1", "T_oil", "T_fl", "Toil", "Tamb", "t_oil", "oil_C",
    "Pt100", "TC1", "Temp [deg]", "Temp [V]",
)  # fmt: skip
NOT = (
    "t", "time", "Time (s)", "t_ms", "t_rel", "t0", "t_fl", "T_d", "T_s", "T [Nm]", "T1 [ms]",
    "template", "attempt", "tempo", "tempo_ms", "temporary", "tempered", "contempt", "temps",
    "Temps [s]", "timestamp", "stamp", "tester", "total", "Force (F)", "Kraft (F)", "F_fl[N]",
    "force", "gain [K]", "rate [K/s]", "x_c", "Defl FL[mm]", "angle [deg]", "p [bar]", "Trigger",
    "duty_fl", "out_of_reach", "force_healthy", "K", "C", "event",
)  # fmt: skip


@pytest.mark.parametrize("name", LOOK)
def test_looks_like_a_temperature(name: str) -> None:
    assert looks_like_temperatures([name], {})


@pytest.mark.parametrize("name", NOT)
def test_does_not(name: str) -> None:
    assert looks_like_temperatures([name], {}) == []


@pytest.mark.parametrize("unit", ["degC", "°C", "C", "K", "kelvin", "°F", "deg C", "Cel"])
def test_a_unit_that_the_file_states_is_enough(unit: str) -> None:
    assert [f.column for f in looks_like_temperatures(["AI3", "t"], {"AI3": unit})] == ["AI3"]


@pytest.mark.parametrize("unit", ["V", "N", "1", "K/min", "deg", "mm", "1/degC"])
def test_other_units_are_not(unit: str) -> None:
    assert looks_like_temperatures(["AI3"], {"AI3": unit}) == []


def log(name: str, values: float | np.ndarray = 25.0) -> pd.DataFrame:
    t = np.arange(200) * 0.005
    x, xdot = 0.01 * np.sin(9 * t), 0.09 * np.cos(9 * t)
    return pd.DataFrame({"t": t, "x": x, "xdot": xdot, "duty": 0.3, name: values})


@pytest.mark.parametrize("name", LOOK)
def test_what_the_message_tells_to_type_does_it(name: str, tmp_path: Path) -> None:
    """Stopped with a usage error; mapped as told, or declined, it goes on and says which."""
    path, out = tmp_path / "log.csv", tmp_path / "pwm.csv"
    log(name, 300.0 if "K" in name else 30.0).to_csv(path, index=False)
    call = ["mimic", str(TABLE_2), str(path), "--fault", "oil=0.5", "-o", str(out)]
    run = CliRunner().invoke(build(["mimic"]), call)
    assert run.exit_code == 2
    message = run.stderr
    assert f"'{name}'" in message
    assert not out.exists()
    if name != "Temp [V]":
        told = shlex.split(message.partition("give ")[2].partition(", ")[0])
        told = [word.replace("[UNIT]", "[degC]") for word in told]
        assert told[0] == "--map"
        assert CliRunner().invoke(build(["mimic"]), [*call, *told]).exit_code == 0
        guard = manifest(out)["temperature"]
        assert guard["guard"] == "read"
        assert guard["column"] == name
        assert guard["unit"] in ("degC", "degF", "K")
        assert guard["hottest"]["value"] < 31.0
    for declining in (["--ignore-temperature"], ["--max-temperature", "inf"]):
        assert CliRunner().invoke(build(["mimic"]), [*call, *declining]).exit_code == 0
        guard = manifest(out)["temperature"]
        assert guard["guard"] == "declined"
        assert guard["not_read"] == [name]
        assert guard["limit"] is None


def manifest(out: Path) -> dict:
    import json

    found: dict = json.loads(Path(f"{out}.manifest.json").read_text())
    return found


def test_a_hot_damper_under_another_name_is_refused() -> None:
    for name, values in (("Oil[K]", 350.0), ("Oil [degF]", 180.0), ("Oil [degC]", 70.0)):
        given = erdctl.read(log(name, values), map=[f"temperature={name}"])
        with pytest.raises(InputProblem, match="above the limit of 60 degC"):
            erdctl.mimic(TABLE_2, given, "oil=0.5")


def test_python_does_the_same() -> None:
    with pytest.raises(UsageProblem, match=r"erdctl\.read\(\.\.\., map=\[\"temperature=Oil"):
        erdctl.mimic(TABLE_2, log("Oil [degC]"), "oil=0.5")
    for declining in ({"ignore_temperature": True}, {"max_temperature": None}):
        found = erdctl.mimic(TABLE_2, log("Oil [degC]", 99.0), "oil=0.5", **declining)
        assert found.to_dict()["temperature"]["guard"] == "declined"
        assert any("as asked for" in line for line in found.remarks)
    found = erdctl.mimic(TABLE_2, log("pressure"), "oil=0.5")
    assert found.to_dict()["temperature"] == {
        "guard": "none", "column": None, "unit": None, "hottest": None,
        "limit": {"value": 60.0, "unit": "degC"}, "not_read": [],
    }  # fmt: skip


@pytest.mark.parametrize(("name", "code"), [("temperature", 3), ("Oil [degC]", 2)])
def test_a_log_on_stdin_is_called_so(name: str, code: int) -> None:
    call = ["mimic", str(TABLE_2), "-", "--fault", "oil=0.5"]
    run = CliRunner().invoke(build(["mimic"]), call, input=log(name, 90.0).to_csv(index=False))
    assert run.exit_code == code
    assert run.stderr.startswith("erdctl: error: stdin: ")


@pytest.mark.parametrize("limit", [float("nan"), -300.0, float("-inf")])
@pytest.mark.parametrize("name", ["temperature", "pressure"])
def test_a_limit_that_is_no_temperature_is_refused(name: str, limit: float) -> None:
    """Also where the log has none: the manifest would state it."""
    with pytest.raises(UsageProblem, match="the highest temperature is in degC"):
        erdctl.mimic(TABLE_2, log(name), "oil=0.5", max_temperature=limit)


def test_one_of_several_is_enough_and_the_others_are_named() -> None:
    given = log("temperature").assign(**{"Oil RL [degC]": 90.0})
    found = erdctl.mimic(TABLE_2, given, "oil=0.5")
    guard = found.to_dict()["temperature"]
    assert (guard["guard"], guard["not_read"]) == ("read", ["Oil RL [degC]"])
    assert any("not from 'Oil RL [degC]'" in line for line in found.remarks)


def test_a_temperature_in_some_logs_only_stops(tmp_path: Path) -> None:
    one, two = tmp_path / "a.csv", tmp_path / "b.csv"
    log("temperature").to_csv(one, index=False)
    log("pressure").to_csv(two, index=False)
    with pytest.raises(UsageProblem, match="only some of the logs"):
        erdctl.mimic(TABLE_2, [one, two], "oil=0.5")


@pytest.mark.parametrize("suffix", ["parquet", "arrow", "mat", "mf4", "tdms"])
def test_units_that_a_file_keeps_for_a_channel(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"log.{suffix}"
    table = pa.Table.from_pandas(log("AI3", 30.0), preserve_index=False)
    units = {"t": "s", "x": "m", "xdot": "m/s", "duty": "1", "AI3": "degC"}
    write_table(with_units(table, units), str(path))
    with pytest.raises(UsageProblem, match="AI3"):
        erdctl.mimic(TABLE_2, path, "oil=0.5")
    given = erdctl.read(path, map={"temperature": "AI3[degC]"})
    guard = erdctl.mimic(TABLE_2, given, "oil=0.5").to_dict()["temperature"]
    assert (guard["column"], guard["unit"]) == ("AI3", "degC")

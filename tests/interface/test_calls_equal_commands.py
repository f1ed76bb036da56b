"""A call and the command of its name give the same documents, tables and refusals."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest
from interface.calls import CAMPAIGN, FOREIGN, LAB, LATE, MAPS, SCHEDULE, TABLE_2, command, refusal
from places import FIXTURES

import erdctl

FEW = ["input_delay", "supply_slew"]
FAULTS = ["oil=0.5@15:31", "electrical=0.8@31:46,channel=rl"]


@pytest.fixture(scope="module")
def damper() -> erdctl.interface.identify.Identified:
    return erdctl.identify(erdctl.read(FOREIGN, map=LAB))


@pytest.fixture(scope="module")
def found() -> erdctl.interface.diagnose.Diagnosed:
    return erdctl.diagnose(LATE, effects=FEW)


@pytest.mark.parametrize("method", ["joint", "two-step"])
def test_identify(method: str, tmp_path: Path) -> None:
    called = erdctl.identify(SCHEDULE if method == "joint" else CAMPAIGN, method=method)
    log = called.log.recording.sources[0].name
    assert called.to_dict() == command("identify", log, "--method", method)
    command("identify", log, "--method", method, "-o", str(tmp_path / "command.json"))
    called.write(tmp_path / "called.json")
    assert (tmp_path / "called.json").read_bytes() == (tmp_path / "command.json").read_bytes()


def test_identify_a_mapped_log_robustly() -> None:
    called = erdctl.identify(erdctl.read(FOREIGN, map=LAB), robust=True)
    assert called.to_dict() == command("identify", FOREIGN, *MAPS, "--robust")


@pytest.mark.parametrize("normalise", ["range", "std"])
def test_validate(normalise: str) -> None:
    called = erdctl.validate(TABLE_2, SCHEDULE, normalise=normalise)
    assert called.to_dict() == command(
        "validate", TABLE_2, SCHEDULE, "--json", "--normalise", normalise
    )


def test_validate_takes_what_simulate_gives(tmp_path: Path) -> None:
    simulated = erdctl.simulate(TABLE_2, SCHEDULE)
    command("simulate", TABLE_2, SCHEDULE, "-o", str(tmp_path / "out.parquet"))
    expected = command("validate", str(tmp_path / "out.parquet"), "--json")
    expected["nrmse_by_record"][0]["record"] = "schedule_60s"
    assert erdctl.validate(None, simulated).to_dict() == expected
    assert erdctl.validate(None, tmp_path / "out.parquet").nrmse == expected["nrmse"]
    frame = erdctl.validate(None, simulated.table())
    assert frame.nrmse == pytest.approx(expected["nrmse"])


@pytest.mark.parametrize("fault", [[], ["oil=0.5@15:31"]])
def test_simulate(fault: list[str], tmp_path: Path) -> None:
    called = erdctl.simulate(TABLE_2, SCHEDULE, faults=fault)
    words = [w for f in fault for w in ("--fault", f)]
    command("simulate", TABLE_2, SCHEDULE, *words, "-o", str(tmp_path / "out.parquet"))
    pd.testing.assert_frame_equal(called.table(), pd.read_parquet(tmp_path / "out.parquet"))
    called.write(tmp_path / "called.csv")
    command("simulate", TABLE_2, SCHEDULE, *words, "-o", str(tmp_path / "command.csv"))
    # A force that the command passes by as text may have its digits otherwise, and is the same.
    called_file, written = (pd.read_csv(tmp_path / f"{n}.csv") for n in ("called", "command"))
    pd.testing.assert_frame_equal(called_file, written, check_exact=True)
    assert called.to_dict()["force_model"] == called.force.tolist()


def test_simulate_a_described_drive(tmp_path: Path) -> None:
    drive = "sine:freq=1,amp=0.01,duty=0.2,duration=2"
    command("simulate", TABLE_2, "--drive", drive, "-o", str(tmp_path / "out.parquet"))
    called = erdctl.simulate(TABLE_2, drive=drive)
    pd.testing.assert_frame_equal(called.table(), pd.read_parquet(tmp_path / "out.parquet"))
    with pytest.raises(erdctl.ErdctlError, match="either a log or a drive"):
        erdctl.simulate(TABLE_2)


@pytest.mark.parametrize("log", [SCHEDULE, CAMPAIGN])
def test_inspect(log: str) -> None:
    assert erdctl.inspect(log).to_dict() == command("inspect", log, "--json")
    assert erdctl.read(log).to_dict() == command("inspect", log, "--json")


def test_inspect_several_mapped_logs() -> None:
    several = [str(FIXTURES / "bad" / "good.csv"), SCHEDULE]
    assert erdctl.inspect(several).to_dict() == command("inspect", *several, "--json")
    mapped = erdctl.inspect(erdctl.read(FOREIGN, map=LAB))
    assert mapped.to_dict() == command("inspect", FOREIGN, *MAPS, "--json")


@pytest.mark.parametrize("options", [{}, {"duty_max": 0.4, "update_rate": 200.0, "slew": 5.0}])
def test_mimic(options: dict[str, float], tmp_path: Path) -> None:
    called = erdctl.mimic(TABLE_2, SCHEDULE, FAULTS, **options)
    words = [w for f in FAULTS for w in ("--fault", f)]
    words += [w for k, v in options.items() for w in (f"--{k.replace('_', '-')}", str(v))]
    for name in ("out.parquet", "out.mat"):
        command("mimic", TABLE_2, SCHEDULE, *words, "-o", str(tmp_path / name))
    manifest = json.loads((tmp_path / "out.parquet.manifest.json").read_text())
    assert called.to_dict() == manifest
    pd.testing.assert_frame_equal(called.table(), pd.read_parquet(tmp_path / "out.parquet"))
    called.write(tmp_path / "called.mat")
    # 116 bytes of text at the head of a MAT file hold the time of writing.
    assert (tmp_path / "called.mat").read_bytes()[116:] == (tmp_path / "out.mat").read_bytes()[116:]
    assert json.loads((tmp_path / "called.mat.manifest.json").read_text()) == manifest


@pytest.mark.few(1)
def test_diagnose(found: erdctl.interface.diagnose.Diagnosed, tmp_path: Path) -> None:
    expected = command("diagnose", LATE, "--effects", ",".join(FEW), "--jobs", "1")
    assert found.to_dict() == expected
    assert found.verdict == "explained"
    assert found.effects == ("input_delay",)
    found.write(tmp_path / "diagnosis.json")
    assert json.loads((tmp_path / "diagnosis.json").read_text()) == expected


@pytest.mark.long
def test_diagnose_given_parameters_with_free_records(tmp_path: Path) -> None:
    log, late = str(tmp_path / "log.parquet"), pd.read_parquet(LATE)
    late[late["record"].str.startswith("sine")].iloc[::4].to_parquet(log, index=False)
    called = erdctl.diagnose(
        log, parameters=TABLE_2, effects="input_delay", record_gains=True, seed=3
    )
    expected = command(
        "diagnose", log, "--params", TABLE_2, "--effects", "input_delay", "--record-gains",
        "--seed", "3", "--jobs", "1",
    )  # fmt: skip
    assert called.to_dict() == expected


def test_results_are_parameters(
    found: erdctl.interface.diagnose.Diagnosed,
    damper: erdctl.interface.identify.Identified,
    tmp_path: Path,
) -> None:
    """As the object, as its dict and as its file, with one hash for object and file."""
    damper.write(tmp_path / "damper.json")
    ways = [damper, damper.to_dict(), tmp_path / "damper.json", str(tmp_path / "damper.json")]
    scores = [erdctl.validate(w, SCHEDULE).to_dict() for w in ways]
    assert scores == [scores[0]] * 4
    hashes = {
        erdctl.mimic(w, SCHEDULE, "oil=0.5").to_dict()["parameters"]["sha256"]
        for w in (damper, tmp_path / "damper.json")
    }
    assert len(hashes) == 1
    corrected = found.to_dict()["corrected"]
    assert erdctl.validate(found, LATE).nrmse == pytest.approx(corrected["nrmse"])
    again = erdctl.validate(corrected["params"], LATE)
    assert again.to_dict() == erdctl.validate(found, LATE).to_dict()


@pytest.mark.parametrize("name", [None, "backlash"])
def test_effects(name: str | None) -> None:
    words = [] if name is None else [name]
    assert erdctl.effects(name).to_dict() == command("effects", *words, "--json")


def test_refusals_are_the_commands() -> None:
    bad = str(FIXTURES / "bad" / "missing_force.csv")
    cases = [
        (lambda: erdctl.identify(bad), ["identify", bad]),
        (lambda: erdctl.read("nowhere.csv"), ["inspect", "nowhere.csv"]),
        (lambda: erdctl.identify(FIXTURES / "bad" / "nan.csv"),
         ["identify", str(FIXTURES / "bad" / "nan.csv")]),
        (lambda: erdctl.simulate("nowhere.json", SCHEDULE), ["simulate", "nowhere.json", SCHEDULE]),
        (lambda: erdctl.effects("rust"), ["effects", "rust"]),
        (lambda: erdctl.diagnose(LATE, effects="rust"), ["diagnose", LATE, "--effects", "rust"]),
        (lambda: erdctl.mimic(TABLE_2, SCHEDULE, "oil"),
         ["mimic", TABLE_2, SCHEDULE, "--fault", "oil"]),
        (lambda: erdctl.simulate(TABLE_2, SCHEDULE).plot("cake"),
         ["plot", SCHEDULE, "--kind", "cake", "-o", "cake.png"]),
    ]  # fmt: skip
    for call, words in cases:
        with pytest.raises(erdctl.ErdctlError) as refused:
            call()
        assert str(refused.value) == refusal(*words)


def test_a_log_without_a_force_says_so() -> None:
    log = erdctl.read(FIXTURES / "bad" / "missing_force.csv")
    for call in (erdctl.identify, erdctl.diagnose, lambda g: erdctl.validate(TABLE_2, g)):
        with pytest.raises(erdctl.ErdctlError, match="no column 'force'"):
            call(log)
    assert len(erdctl.simulate(TABLE_2, log).force) == len(log)


def test_wrong_options_and_things_are_refused() -> None:
    log = erdctl.read(SCHEDULE)
    for call in (
        lambda: erdctl.identify(log, method="guess"),
        lambda: erdctl.validate(TABLE_2, log, normalise="peak"),
        lambda: erdctl.diagnose(log, max_effects=0),
        lambda: erdctl.mimic(TABLE_2, log, []),
        lambda: erdctl.mimic(TABLE_2, log, "oil=0.5", duty=2.0),
        lambda: erdctl.inspect(log).table("all"),
        lambda: log.plot("time", span=(2.0, 1.0)),
        lambda: log.plot(records="another"),
    ):
        with pytest.raises(erdctl.ErdctlError):
            call()
    with pytest.raises(TypeError, match="not BenchLog"):
        erdctl.simulate(log, TABLE_2)
    with pytest.raises(TypeError):
        erdctl.identify(erdctl.effects())


def test_a_hot_log_is_refused() -> None:
    hot = FIXTURES / "schedule_hot.csv"
    said = r"schedule_hot.csv: .* above the limit of 60 degC; max_temperature"
    with pytest.raises(erdctl.ErdctlError, match=said):
        erdctl.mimic(TABLE_2, hot, "oil=0.5@1:5")
    assert erdctl.mimic(TABLE_2, hot, "oil=0.5@1:5", max_temperature=None).to_dict()

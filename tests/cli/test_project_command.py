"""erdctl.toml in commands: what wins, what is said, what is refused, and limits that hold."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import jsonschema
import pandas as pd
import pytest
import typer
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli import project_options
from erdctl.cli.app import build
from erdctl.core.errors import UsageProblem
from erdctl.io.project.file import read_project

TABLE_2 = str(FIXTURES / "table_2.json")
ERDCTL = [sys.executable, "-m", "erdctl"]
COLUMNS = '[columns]\nt = "Time"\nx = "Defl FL[mm]"\nduty = "PWM[%]"\nforce = "F_fl[N]"\n'
BY_MAP = ["--map", "t=Time", "--map", "x=Defl FL[mm]", "--map", "duty=PWM[%]",
          "--map", "force=F_fl[N]"]  # fmt: skip
ALL: dict[str, Any] = typer.main.get_command(build()).commands  # type: ignore[attr-defined]  # a group


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a log as a lab writes it; what lies above it is no concern of the tests."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("ERDCTL_PROJECT", raising=False)
    monkeypatch.chdir(tmp_path)
    log = pd.read_csv(FIXTURES / "schedule_60s.csv").iloc[:2500]
    own = pd.DataFrame(
        {"Time": log.t, "Defl FL": 1e3 * log.x, "PWM": 100 * log.duty, "F_fl": log.force}
    )
    own.to_csv("A07_20240501.csv", index=False)
    return tmp_path


def erdctl(*words: str, code: int = 0) -> Any:
    done = CliRunner().invoke(build([words[0]]), list(words))
    assert done.exit_code == code, done.stderr
    return done


def project(text: str, folder: str = ".") -> None:
    Path(folder, "erdctl.toml").write_text(text)


def scores(*words: str) -> tuple[dict[str, Any], str]:
    done = erdctl("validate", TABLE_2, "A07_20240501.csv", "--json", *words)
    return json.loads(done.stdout), done.stderr


def test_columns_reach_a_command_and_one_line_says_so(lab: Path) -> None:
    by_map, _ = scores(*BY_MAP)
    project(COLUMNS)
    found, said = scores()
    assert said.count("by erdctl.toml: ") == 1
    assert "by erdctl.toml: columns t, x, duty, force\n" in said
    origin = found.pop("provenance")
    assert origin["project"].startswith("erdctl.toml, SHA-256 ")
    assert origin["project"].endswith(": columns t, x, duty, force")
    assert found == by_map
    assert "by erdctl.toml" not in scores("--quiet")[1]
    # The command line wins, column by column.
    assert scores("--map", "force=-F_fl[N]")[0]["nrmse"] > 2 * found["nrmse"]


def test_what_it_does_not_change_is_as_without_it(lab: Path) -> None:
    """Also bit for bit: the hash of a file that nothing was taken from is nowhere."""
    drive = str(FIXTURES / "schedule_hot.csv")
    plain = erdctl("inspect", drive, "--json")
    project(COLUMNS)
    again = erdctl("inspect", drive, "--json")
    assert again.stdout == plain.stdout
    assert again.stderr == plain.stderr


def test_pipes(lab: Path) -> None:
    """Columns on the way are erdctl's, in SI: a project's unit must not be applied twice."""
    project(COLUMNS)
    simulated = erdctl("simulate", TABLE_2, "A07_20240501.csv").stdout_bytes
    run = subprocess.run(
        [*ERDCTL, "validate", "-", "--json"], input=simulated, capture_output=True, check=True
    )
    direct, _ = scores()
    direct.pop("provenance")
    piped = json.loads(run.stdout)
    assert piped["nrmse"] == pytest.approx(direct["nrmse"], rel=1e-6)
    assert b"by erdctl.toml" not in run.stderr
    assert "provenance" not in piped


def test_the_nearest_file_above_and_other_ways_to_choose(
    lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    project(COLUMNS)
    (lab / "deep" / "er").mkdir(parents=True)
    other = lab / "other.toml"
    other.write_text('[options]\noperator = "other"\n' + COLUMNS)
    monkeypatch.chdir(lab / "deep" / "er")
    words = ["inspect", str(lab / "A07_20240501.csv"), "--json"]
    assert "by ../../erdctl.toml: columns" in erdctl(*words).stderr
    project('[options]\noperator = "near"\n' + COLUMNS, "..")
    assert json.loads(erdctl(*words).stdout)["provenance"]["operator"] == "near"
    monkeypatch.setenv("ERDCTL_PROJECT", str(other))
    assert json.loads(erdctl(*words).stdout)["provenance"]["operator"] == "other"
    chosen = erdctl(*words, "--project", str(lab / "erdctl.toml"))
    assert "operator" not in json.loads(chosen.stdout)["provenance"]
    erdctl(*words, "--no-project", code=3)  # columns that nobody explains
    monkeypatch.setenv("ERDCTL_PROJECT", "")
    erdctl(*words, code=3)
    both = erdctl(*words, "--no-project", "--project", "x", code=2)
    assert "give one of the two" in both.stderr
    missing = erdctl(*words, "--project", "no.toml", code=2)
    assert "cannot read the project file 'no.toml'" in missing.stderr


def test_command_line_over_damper_over_general(lab: Path) -> None:
    project(
        COLUMNS + '[options]\noperator = "general"\n[options.inspect]\noperator = "of inspect"\n'
        "[labels]\npath = '(?P<damper>[A-Z]\\d+)_(?P<date>\\d{8})'\n"
        '[damper.A07.options]\noperator = "of A07"\n'
    )

    def origin(*words: str) -> dict[str, str]:
        found = erdctl("inspect", "A07_20240501.csv", "--json", *words).stdout
        return dict(json.loads(found)["provenance"])

    said = origin()
    assert (said["operator"], said["damper"], said["date"]) == ("of A07", "A07", "2024-05-01")
    assert origin("--damper", "B1")["operator"] == "of inspect"
    assert origin("--damper", "B1")["damper"] == "B1"
    assert origin("--operator", "me")["operator"] == "me"
    assert origin("--date", "2020-01-01")["date"] == "2020-01-01"


def test_provenance_of_a_parameter_file(lab: Path) -> None:
    project(COLUMNS + "[options]\nrobust = true\n")
    erdctl("identify", "A07_20240501.csv", "-o", "p.json")
    said = json.loads(Path("p.json").read_text())["provenance"]["project"]
    assert "robust True" in said
    assert "columns t, x, duty, force" in said
    erdctl("validate", "p.json", "A07_20240501.csv")


def test_a_corner(lab: Path) -> None:
    log = pd.read_csv("A07_20240501.csv")
    log.rename(columns={"Defl FL": "x_fl", "PWM": "PWM", "F_fl": "F_fl"}).assign(
        x_rr=log["Defl FL"], F_rr=2 * log["F_fl"]
    ).to_parquet("car.parquet")
    corner = '[corner.{0}.columns]\nx = "x_{0}[mm]"\nforce = "F_{0}[N]"\n'
    project('[columns]\nt = "Time"\nduty = "PWM[%]"\n' + corner.format("fl") + corner.format("rr"))
    assert "--corner fl" in erdctl("inspect", "car.parquet", code=3).stderr
    one, other = (
        json.loads(erdctl("inspect", "car.parquet", "--json", "--corner", c).stdout)
        for c in ("fl", "RR")
    )
    assert other["provenance"]["corner"] == "rr"
    top = [max(r["records"][0]["force"]) for r in (one, other)]
    assert top[1] == pytest.approx(2 * top[0])
    assert "--corner takes fl" in erdctl("inspect", "car.parquet", "--corner", "x", code=2).stderr


LIMITS = "[amplifier]\nduty_max = 0.2\nslew = 5.0\nresolution = 0.01\n[rig]\nmax_temperature = 50\n"
MIMIC = ["mimic", TABLE_2, str(FIXTURES / "schedule_60s.csv"), "--fault", "oil=0.5", "-o", "p.csv"]


def manifest() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(Path("p.csv.manifest.json").read_text())
    return found


def test_limits_hold_in_mimic(lab: Path) -> None:
    project(LIMITS)
    said = erdctl(*MIMIC).stderr
    assert "by erdctl.toml: duty_max 0.2; resolution 0.01; slew 5; max_temperature 50" in said
    assert pd.read_csv("p.csv")["duty"].max() == pytest.approx(0.2)
    assert "warning: --" not in said
    hot = [*MIMIC[:2], str(FIXTURES / "schedule_hot.csv"), *MIMIC[3:]]
    error = erdctl(*hot, code=3).stderr
    assert "limit of 50 degC" in error
    assert f"erdctl: error: {hot[2]}: the damper reached" in error  # not the parameter file too


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--duty-max", "0.4"], "--duty-max 0.4 is beyond amplifier.duty_max = 0.2"),
        (["--slew", "9"], "--slew 9 is beyond amplifier.slew = 5"),
        (["--resolution", "0"], "--resolution 0 is beyond amplifier.resolution = 0.01"),
        (["--resolution", "0.015"], "--resolution 0.015 is no multiple of amplifier.resolution"),
        (["--max-temperature", "60"], "--max-temperature 60 is beyond rig.max_temperature = 50"),
        (["--ignore-temperature"], "--ignore-temperature sets rig.max_temperature = 50"),
        (["--no-project"], "no project file is used, nor the limits in"),
    ],
    ids=lambda v: v[0] if isinstance(v, list) else "",
)
def test_a_limit_is_never_loosened_in_silence(lab: Path, words: list[str], said: str) -> None:
    """Not even by --quiet: it is a warning."""
    project(LIMITS)
    assert f"erdctl: warning: {said}" in erdctl(*MIMIC, *words, "--quiet").stderr
    # What is tighter needs no word.
    tight = ["--duty-max", "0.1", "--slew", "1", "--resolution", "0.03"]
    assert "warning: --" not in erdctl(*MIMIC, *tight, "--quiet").stderr


def test_limits_of_a_damper(lab: Path) -> None:
    project(
        LIMITS + "[damper.A.amplifier]\nduty_max = 0.15\n[damper.B.amplifier]\nduty_max = 0.3\n"
        "[labels]\npath = '(?P<damper>[AB])_drive'\n"
    )
    assert "limits of damper A, damper B in erdctl.toml are left aside" in erdctl(*MIMIC).stderr
    said = erdctl(*MIMIC, "--damper", "A").stderr
    assert "duty_max 0.15" in said
    assert "left aside" not in said
    wide = erdctl(*MIMIC, "--damper", "B").stderr
    assert "damper.B.amplifier.duty_max = 0.3 of erdctl.toml is beyond amplifier.duty_max" in wide
    # Of files of several dampers the tightest.
    drive = Path(MIMIC[2]).read_bytes()
    Path("B_drive.csv").write_bytes(drive)
    Path("A_drive.json").write_bytes(Path(TABLE_2).read_bytes())
    both = erdctl("mimic", "A_drive.json", "B_drive.csv", *MIMIC[3:])
    assert "duty_max 0.15" in both.stderr


def test_limits_of_an_exported_emulator(lab: Path) -> None:
    project(LIMITS)
    said = erdctl("export", TABLE_2, "-o", "e.c", "--emulate", "oil").stderr
    assert "by erdctl.toml: duty_max 0.2" in said
    source = Path("e.c").read_text() + Path("e.h").read_text()
    assert "0.2" in source
    over = erdctl("export", TABLE_2, "-o", "e.c", "--emulate", "oil", "--slew", "8").stderr
    assert "warning: --slew 8 is beyond amplifier.slew = 5 of erdctl.toml" in over
    # They mean nothing for the damper itself, and for a table.
    for name in ("d.c", "d.csv"):
        assert "erdctl.toml" not in erdctl("export", TABLE_2, "-o", name).stderr


def allowed() -> list[tuple[str, str, Any]]:
    """Every option of every command that may stand in a project file: command, name, option."""
    out = []
    for command, c in ALL.items():
        for p in c.params:
            for name in project_options.option_names(p):
                if p.name not in project_options.OF_ONE_RUN | project_options.ELSEWHERE.keys():
                    out.append((command, name, p))
    return out


def value_of(p: Any) -> Any:
    known = {"int": 3, "float": 0.5, "bool": True}
    return next((v for k, v in known.items() if p.type.name.startswith(k)), "a")


def toml(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else json.dumps(value)


@pytest.mark.parametrize(("command", "name", "option"), allowed(), ids=lambda v: str(v)[:20])
def test_every_option_is_taken_by_its_name(lab: Path, command: str, name: str, option: Any) -> None:
    for table in ("[options]", f"[options.{command}]"):
        project(f"{table}\n{name} = {toml(value_of(option))}\n")
        project_options.check(read_project("erdctl.toml"), lambda: ALL)
    wrong: Any = 3 if value_of(option) == "a" else "three"
    project(f"[options.{command}]\n{name} = {toml(wrong)}\n")
    with pytest.raises(UsageProblem, match=rf"line 2: options.{command}.{name}: is .*expected"):
        project_options.check(read_project("erdctl.toml"), lambda: ALL)


def test_the_rest_is_refused_with_its_reason(lab: Path) -> None:
    known, seen = {n for _, n, _ in allowed()}, 0
    refused = {
        name: p for c in ALL.values() for p in c.params
        for name in project_options.option_names(p) if name not in known
    }  # fmt: skip
    for name, p in refused.items():
        seen += 1
        project(f"[options]\n{name} = {toml(value_of(p))}\n")
        with pytest.raises(UsageProblem, match=r"of one run|belongs to the table"):
            project_options.check(read_project("erdctl.toml"), lambda: ALL)
    assert seen > 20


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[options]\nmax_efects = 2", ("line 2", "did you mean 'max_effects'")),
        ("[options.diagnos]\njobs = 2", ("options.diagnos", "did you mean 'diagnose'")),
        ("[options.diagnose]\nfault = 'oil=1'", ("options.diagnose.fault", "no option")),
        ("[options.inspect]\nnoise = -1.0", ("line 2", "options.inspect.noise", "-1.0")),
        ("[options.validate]\nnormalise = 3", ("options.validate.normalise", "a text")),
        ("[amplifier]\nduty_max = 'a'", ("line 2", "amplifier.duty_max")),
        ("x = [", ("not TOML",)),
    ],
)
def test_a_wrong_file_ends_a_command_before_it_begins(
    lab: Path, text: str, words: tuple[str, ...]
) -> None:
    project(text)
    done = erdctl("inspect", "A07_20240501.csv", *BY_MAP, "--forecast", "--params", TABLE_2, code=2)
    assert done.stderr.startswith("erdctl: error: erdctl.toml: ")
    assert [w for w in words if w not in done.stderr] == []
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1


def test_options_that_mean_nothing_in_a_call_are_left_out(lab: Path) -> None:
    project(
        COLUMNS + "[options.inspect]\nnoise = 0.2\n[options.export]\nfmi = '3'\npoints = 7\n"
        "[options.simulate]\ndrive = ['sine:freq=1']\n"
    )
    assert "noise 0.2" not in erdctl("inspect", "A07_20240501.csv").stderr
    assert "points" not in erdctl("export", TABLE_2, "-o", "d.c").stderr
    assert "by erdctl.toml: points 7" in erdctl("export", TABLE_2, "-o", "d.csv").stderr
    assert "drive" not in erdctl("simulate", TABLE_2, "A07_20240501.csv", "-o", "s.csv").stderr
    assert "drive sine:freq=1" in erdctl("simulate", TABLE_2, "-o", "s.csv").stderr


def test_the_project_file_is_not_written_over(lab: Path) -> None:
    project(COLUMNS)
    before = Path("erdctl.toml").read_bytes()
    done = erdctl("identify", "A07_20240501.csv", "-o", "erdctl.toml", code=2)
    assert "would be written over the project file" in done.stderr
    assert Path("erdctl.toml").read_bytes() == before


def test_init_and_show(lab: Path) -> None:
    log = pd.read_csv("A07_20240501.csv")
    log.columns = ["Time (s)", "Deflection (mm)", "PWM (%)", "Load (N)"]
    log.to_csv("A08_20240601.csv", index=False)
    plain = json.loads(erdctl("inspect", "A08_20240601.csv", "--json").stdout)
    erdctl("project", "init", "A08_20240601.csv")
    again = json.loads(erdctl("inspect", "A08_20240601.csv", "--json").stdout)
    again.pop("provenance")
    assert again == plain
    assert "is there already" in erdctl("project", "init", "A08_20240601.csv", code=2).stderr
    shown = json.loads(erdctl("project", "show", "--json").stdout)
    assert shown["file"] == "erdctl.toml"
    values = {v["name"]: v for v in shown["logs"][0]["values"]}
    assert values["columns.x"]["value"] == "Deflection (mm)"
    line = Path("erdctl.toml").read_text().splitlines()[values["columns.x"]["line"] - 1]
    assert line == 'x = "Deflection (mm)"'
    text = erdctl("project", "show").stdout
    assert 'columns.x = "Deflection (mm)"  (columns.x, line' in text
    erdctl("project", "init", "A08_20240601.csv", "-o", "-")


def test_show_of_logs_and_of_nothing(lab: Path) -> None:
    assert "no project file applies here" in erdctl("project", "show").stdout
    assert json.loads(erdctl("project", "show", "--json").stdout)["file"] is None
    project(
        LIMITS + "[labels]\npath = '(?P<damper>[A-Z]\\d+)_(?P<date>\\d{8})'\n"
        "[damper.'A07'.amplifier]\nduty_max = 0.15\n[damper.'A.7'.options.diagnose]\njobs = 2\n"
    )
    found = json.loads(erdctl("project", "show", "A07_20240501.csv", "--json").stdout)
    (one,) = found["logs"]
    assert one["labels"] == {"damper": "A07", "date": "2024-05-01"}
    values = {v["name"]: (v["value"], v["key"], v["line"]) for v in one["values"]}
    assert values["amplifier.duty_max"] == (0.15, "damper.A07.amplifier.duty_max", 10)
    other = json.loads(erdctl("project", "show", "--damper", "A.7", "--json").stdout)
    jobs = other["logs"][0]["values"][-1]
    assert (jobs["name"], jobs["key"]) == (
        "options.diagnose.jobs",
        "damper.A.7.options.diagnose.jobs",
    )
    assert jobs["line"] == 12
    project("[options]\nfoo = 1\n")
    assert "options.foo" in erdctl("project", "show", code=2).stderr


def test_the_schema_is_published(lab: Path) -> None:
    schema = json.loads(erdctl("schema", "project").stdout)
    jsonschema.validate({"columns": {"x": "a"}, "amplifier": {"duty_max": 0.4}}, schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"amplifier": {"dutymax": 0.4}}, schema)


def test_help_and_completion(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for words in (["project", "--help"], ["project", "init", "-h"], ["project", "show", "--help"]):
        text = erdctl(*words).stdout
        assert "Examples:" in text
        assert "Exit codes" in text
    done = subprocess.run(
        ERDCTL, capture_output=True, text=True,
        env={
            "_ERDCTL_COMPLETE": "complete_bash", "COMP_WORDS": "erdctl project ",
            "COMP_CWORD": "2", "PYTHONPATH": ":".join(sys.path), "HOME": str(lab),
        },
    )  # fmt: skip
    assert {"init", "show"} <= set(done.stdout.split())


def test_nothing_is_imported_where_no_project_is(lab: Path) -> None:
    """The project's room is read where a file lies only."""
    code = (
        "import sys; from erdctl.cli.app import run; run(['derive', sys.argv[1], '-o', 'p.json']);"
        "print('erdctl.io.project.file' in sys.modules)"
    )

    def imported() -> str:
        words = [sys.executable, "-c", code, str(FIXTURES / "geometry_inove.json")]
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout

    assert imported() == "False\n"
    project("")
    assert imported() == "True\n"

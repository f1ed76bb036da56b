"""`erdctl plot` and `--plot`: what they refuse, what they write, and what they agree on."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import oracle
import pandas as pd
import pytest
from drawing import caught, labels, line, panels, run, units
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.bench.drive import drives
from erdctl.cli.app import build
from erdctl.report import pictures, style
from erdctl.report.picture import figure
from erdctl.report.subject import Subject
from erdctl.report.subjects import located

CAMPAIGN = FIXTURES / "healthy_campaign.parquet"
SCHEDULE = FIXTURES / "schedule_60s.csv"
TABLE_2 = FIXTURES / "table_2.json"
HEADS = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}


def erdctl(*arguments: object, code: int = 0) -> str:
    """What one command says on stderr, run in this process."""
    result = CliRunner().invoke(build([str(arguments[0])]), list(map(str, arguments)))
    assert result.exit_code == code, result.output
    return result.stderr


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("suffix", HEADS)
def test_the_suffix_chooses_the_format(folder: Path, suffix: str) -> None:
    out = folder / f"a.{suffix}"
    erdctl("plot", SCHEDULE, "--span", "0:2", "-o", out)
    first = out.read_bytes()
    assert first.startswith(HEADS[suffix])
    erdctl("plot", SCHEDULE, "--span", "0:2", "-o", out)
    assert out.read_bytes() == first  # the same picture has the same bytes


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("plot", SCHEDULE, "-o", "a.jpg"), ".png, .svg, .pdf"),
        (("plot", SCHEDULE, "-o", "a"), ".png, .svg, .pdf"),
        (("plot", SCHEDULE, "-o", "a.png", "--kind", "pie"), "unknown picture 'pie'"),
        (("plot", SCHEDULE, "-o", "a.png", "--kind", "static"), "needs a parameter file"),
        (("plot", SCHEDULE, "-o", "a.png", "--kind", "time"), "needs a modelled force"),
        (("plot", SCHEDULE, "-o", "a.png", "--kind", "duty"), "duty_healthy"),
        (("plot", SCHEDULE, "-o", "a.png", "--fault", "oil=0.5"), "--fault needs --params"),
        (("plot", SCHEDULE, "-o", "a.png", "--span", "5"), "--span is START:END"),
        (("plot", SCHEDULE, "-o", "a.png", "--span", "3:2"), "--span is START:END"),
        (("plot", SCHEDULE, "-o", "a.png", "--span", "90:"), "fewer than two samples"),
        (("plot", SCHEDULE, "-o", "a.png", "--record", "x"), "no record 'x'"),
        (("plot", "-", "--params", "-", "-o", "a.png"), "only one of"),
        (("identify", SCHEDULE, "-o", "p.json", "--plot", "a.gif"), ".png, .svg, .pdf"),
        (("validate", TABLE_2, SCHEDULE, "--plot", "pie:a.png.x"), ".png, .svg, .pdf"),
        (("mimic", TABLE_2, SCHEDULE, "--fault", "oil=0.5", "-o", "p.csv", "--plot", "a"), ".svg"),
    ],
)
def test_wrong_usage_is_2_and_nothing_is_written(
    folder: Path, arguments: tuple[object, ...], says: str
) -> None:
    text = erdctl(*arguments, code=2)
    assert says in text
    assert text.startswith("erdctl: error: ")
    assert text.count("\n") == 1
    assert not list(folder.iterdir())


def test_a_log_that_cannot_show_it_is_3(folder: Path) -> None:
    text = erdctl("plot", SCHEDULE, "--kind", "slow", "-o", "a.png", code=3)
    assert "record a slow test" in text
    assert not list(folder.iterdir())


def test_a_drive_without_force(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    pd.read_csv(SCHEDULE).drop(columns="force").to_csv("drive.csv", index=False)
    (found,) = run("erdctl plot drive.csv --kind motion -o a.png", monkeypatch, folder)
    assert len(panels(found)) == 3
    assert "needs a measured force" in erdctl("plot", "drive.csv", "-o", "b.png", code=2)
    (found,) = run(f"erdctl plot drive.csv --params {TABLE_2} -o c.png", monkeypatch, folder)
    assert labels(panels(found)[0]) == {"model 30 %"}


def test_record_and_span(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """The force is that of the whole record: states do not restart at the window."""
    command = (
        f"erdctl plot {CAMPAIGN} --params {TABLE_2} --kind time --record steps_1 --record steps_3"
        " --span 1:2 -o a.svg"
    )
    (found,) = run(command, monkeypatch, folder)
    upper, lower = panels(found)
    assert lower.get_xlabel() == "time, 2 records end to end [s]"
    log = pd.read_parquet(CAMPAIGN)
    truth = []
    for name in ("steps_1", "steps_3"):
        one = log[log["record"] == name]
        whole = oracle.respond(*(one[c].to_numpy() for c in ("t", "x", "xdot", "duty"))).force
        truth.append(whole[one["t"].between(1.0, 2.0)])
    _, y = line(upper, "model")
    assert y == pytest.approx(np.concatenate(truth), abs=0.05)


def test_two_models_and_a_log_with_force_model(
    monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    erdctl("derive", FIXTURES / "geometry_inove.json", "-o", "derived.json")
    command = (
        f"erdctl plot {SCHEDULE} --params {TABLE_2} --before derived.json --kind before-after"
        " -o a.png"
    )
    (found,) = run(command, monkeypatch, folder)
    titles = [ax.get_title(loc="left") for ax in panels(found)[:2]]
    assert titles[0].startswith("model before\nNRMSE ")
    assert titles[1].startswith("model\nNRMSE 0.0096, 0.299 N rms")
    erdctl("simulate", TABLE_2, SCHEDULE, "-o", "out.parquet")
    (found,) = run("erdctl plot out.parquet --kind time -o b.png", monkeypatch, folder)
    assert labels(panels(found)[0]) == {"measured", "model"}


def test_a_written_sequence_is_drawn_again(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    command = f"erdctl mimic {TABLE_2} {SCHEDULE} --fault oil=0.2 -o pwm.csv --plot duty:a.png"
    (made,) = run(command, monkeypatch, folder)
    (again,) = run("erdctl plot pwm.csv --kind duty -o b.png", monkeypatch, folder)
    for name in ("sequence to push", "healthy duty"):
        a, b = (line(panels(f)[0], name)[1] for f in (made, again))
        assert a == pytest.approx(b)
    shares = [panels(f)[0].get_legend_handles_labels()[1][-1] for f in (made, again)]
    assert shares[0] == shares[1] == "out of reach (62.0 % of the time)"


def test_each_faulty_damper_has_its_picture(folder: Path) -> None:
    faults = ["--fault", "oil=0.5", "--fault", "oil=0.7,channel=rr"]
    erdctl("mimic", TABLE_2, SCHEDULE, *faults, "-o", "pwm.csv", "--plot", "f.png")
    assert {p.name for p in folder.glob("*.png")} == {"f-fl.png", "f-rr.png"}


@pytest.mark.parametrize("kind", ["peak-force", "average"])
def test_dyno_pictures(monkeypatch: pytest.MonkeyPatch, folder: Path, kind: str) -> None:
    """F = k x + c v at zero duty, and at the peak velocity of a sine x is 0."""
    command = f"erdctl plot {CAMPAIGN} --params {TABLE_2} --kind {kind} -o a.png"
    (found,) = run(command, monkeypatch, folder)
    (ax,) = panels(found)
    assert all("[" in text for text in units(found))
    v, force = line(ax, "measured 0 %")
    _, model = line(ax, "model 0 %")
    fast = np.abs(v) > 100.0
    law = v / 1e3 * np.where(v > 0, 64.6433, 68.8289)
    assert force[fast] == pytest.approx(law[fast], abs=0.3)
    assert force == pytest.approx(model, abs=0.35)


def test_slow_picture(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Table 2: gas (263.1 + 170.4) / 2 x, and half the gap of the two springs, at 1 mm/s."""
    drive = "triangle:speed=0.001,amp=0.01,duration=80,fs=50"
    command = f"erdctl simulate {TABLE_2} --drive {drive} -o a.csv --plot slow:a.png"
    (found,) = run(command, monkeypatch, folder)
    left, right = panels(found)
    x, gas = line(left, "gas force")
    assert gas == pytest.approx(x * 1e-3 * (263.1168 + 170.4045) / 2, abs=0.05)
    x, drag = line(right, "seal drag")
    flow = 1e-3 * (64.6433 + 68.8289) / 2
    assert drag == pytest.approx(x * 1e-3 * (263.1168 - 170.4045) / 2 + flow, abs=0.05)


def test_misfit_map_of_a_wrong_model(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """A viscosity 40 N s/m too high in compression leaves 40 v there, and noise in release."""
    wrong = TABLE_2.read_text().replace("64.6433", "104.6433")
    assert wrong != TABLE_2.read_text()
    Path("wrong.json").write_text(wrong)
    command = f"erdctl validate wrong.json {CAMPAIGN} --plot misfit:a.png"
    (found,) = run(command, monkeypatch, folder)
    left, right = panels(found)
    (mesh,) = left.collections
    rms = np.asarray(mesh.get_array(), float)
    edges = mesh.get_coordinates()[0, :, 0]
    v = 0.5e-3 * (edges[1:] + edges[:-1])
    duties = [float(t.get_text()) for t in left.get_yticklabels()]
    for duty in (0.0, 10.0, 30.0):
        row = rms[duties.index(duty)]
        assert row[v > 0.03] == pytest.approx(np.hypot(40.0 * v[v > 0.03], 0.3), rel=0.08)
        assert row[v < -0.02] == pytest.approx(np.full(np.sum(v < -0.02), 0.3), abs=0.06)
    assert right.get_xlabel() == "velocity, compression + [mm/s]"
    assert "in compression" in right.get_title(loc="left")


def test_the_help_lists_every_kind() -> None:
    text = CliRunner().invoke(build(["plot"]), ["plot", "--help"]).stdout
    for kind in pictures.names():
        assert f"  {kind} " in text
        assert pictures.get(kind).title


def test_kinds_cost_nothing_until_one_is_drawn() -> None:
    code = "import sys, erdctl.report.pictures as p; p.names(); print('numpy' in sys.modules)"
    run_ = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run_.stdout.strip() == "False"
    code = "import sys, erdctl.cli.identify, erdctl.io.logs; print('matplotlib' in sys.modules)"
    run_ = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run_.stdout.strip() == "False"


@pytest.mark.parametrize("count", [1, 2, 5, 9, 24])
def test_levels_keep_their_order_in_grey(count: int) -> None:
    grey = [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in style.shades(count)]
    assert grey == sorted(grey, reverse=True)
    assert len(set(grey)) == count
    assert max(grey) < 0.75  # seen on white


def test_series_differ_without_colour() -> None:
    assert len({str(ls) for _, ls in style.SERIES[1:]}) == len(style.SERIES) - 1


def test_a_picture_that_fails_leaves_the_old_one(
    monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    Path("a.png").write_bytes(b"old")
    with caught(monkeypatch):
        erdctl("plot", SCHEDULE, "--kind", "slow", "-o", "a.png", code=3)
    assert Path("a.png").read_bytes() == b"old"


def test_nothing_to_draw_is_said() -> None:
    from erdctl.bench.drive import drives
    from erdctl.core.errors import UsageProblem

    with pytest.raises(UsageProblem, match="needs a measured force"):
        figure("loops", Subject(recording=drives(["sine:duration=1"])))


FAST = "--drive sine:freq=2,amp=0.01,duration=6"
NOTHING = {
    "slow": ("plot fast.csv --kind slow", "no slow strokes"),
    "slow-under-field": ("plot field.csv --kind slow", "no slow strokes"),
    "peak-force": ("plot ramp.csv --kind peak-force", "no stroke goes from one reversal"),
    "yield-force": (f"plot fast.csv --params {TABLE_2} --kind yield-force", "the duty is 0"),
    "faults": (f"plot fast.csv --params {TABLE_2} --fault oil=0.5@100", "no fault acts"),
    "loops": ("plot hold.csv", "the piston never moves"),
    "average": ("plot hold.csv --kind average", "the piston never moves"),
    "before-after": (
        f"plot hold.csv --params {TABLE_2} --before {TABLE_2} --kind before-after",
        "the piston never moves",
    ),
    "duty": ("plot fast.csv --kind duty", "a mimic sequence"),
    "time": ("plot bare.csv --kind time", "a measured force"),
}


@pytest.mark.parametrize("kind", NOTHING)
def test_a_picture_of_nothing_is_refused(kind: str, folder: Path) -> None:
    t = np.arange(0.0, 6.0, 0.005)
    x = 0.01 * np.sin(4 * np.pi * t)
    logs = {
        "fast": (x, 0.0), "field": (0.01 * np.sin(0.1 * t), 0.3), "ramp": (1e-3 * t, 0.0),
        "hold": (0.0 * t, 0.0), "bare": (x, 0.0),
    }  # fmt: skip
    for name, (motion, duty) in logs.items():
        frame = pd.DataFrame({"t": t, "x": motion, "duty": duty, "force": 200.0 * motion})
        columns = ["t", "x", "duty"] if name == "bare" else list(frame)
        frame[columns].to_csv(f"{name}.csv", index=False)
    command, reason = NOTHING[kind]
    said = erdctl(*command.split(), "-o", "a.png", code=2 if kind in ("duty", "time") else 3)
    assert reason in said
    assert not Path("a.png").exists()


@pytest.mark.parametrize("noise", [0.0, 5e-4])
def test_slow_strokes_between_fast_ones_are_found(noise: float, folder: Path) -> None:
    """A fast part of the same log does not hide the slow test, nor does noise of the speed."""
    step = 0.005
    slow = 0.01 * np.concatenate([np.linspace(0, 1, 1000), np.linspace(1, -1, 2000),
                                  np.linspace(-1, 0, 1000)])  # fmt: skip
    fast = 0.01 * np.sin(2 * np.pi * 2.0 * np.arange(0.0, 5.0, step))
    x = np.concatenate([fast, slow, fast])
    rng = np.random.default_rng(0)
    xdot = np.gradient(x, step) + rng.normal(0.0, noise, len(x))
    t = step * np.arange(len(x))
    force = 200.0 * x + 3.0 * np.sign(np.gradient(x)) + 60.0 * np.gradient(x, step)
    pd.DataFrame({"t": t, "x": x, "xdot": xdot, "duty": 0.0, "force": force}).to_csv("a.csv")
    erdctl("plot", "a.csv", "--kind", "slow", "-o", "a.png")
    assert Path("a.png").exists()


def test_a_fault_is_drawn_where_it_acts(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Half the oil is half the force, Eq. 20; the cycle at hand was one from before the onset."""
    t = np.arange(0.0, 12.0, 0.005)
    w = 4.0 * np.pi
    late = pd.DataFrame({"t": t, "x": 0.01 * np.sin(w * t), "xdot": 0.01 * w * np.cos(w * t)})
    late.assign(duty=np.where(t < 6.0, 0.1, 0.2)).to_csv("late.csv", index=False)
    command = f"erdctl plot late.csv --params {TABLE_2} --fault oil=0.5@8 -o late.png"
    (figure,) = run(command, monkeypatch, folder)
    never, later = (ax for ax in panels(figure) if ax.get_title("left"))
    assert never.get_title("left") == "PWM duty 10 %, no fault acts"
    assert later.get_title("left") == "PWM duty 20 %"
    top = {line.get_label(): np.nanmax(line.get_ydata()) for line in later.get_lines()}
    assert top["oil=0.5@8"] == pytest.approx(0.5 * top["healthy"], rel=1e-6)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["healthy", "oil=0.5@8"]


def test_a_misfit_map_names_its_model_and_its_grey() -> None:
    """One model is no "model before"; a cell of 4 samples is grey, and in the log all the same."""
    r = drives(["sine:freq=1,amp=0.01,duty=0.1|0.2,hold=5,duration=20"])
    force = 100.0 * r.xdot + np.random.default_rng(0).normal(0.0, 0.1, len(r))
    r = replace(r, force=force)
    missed = force - 5.0 * (np.abs(r.xdot) < 0.01)
    subject = Subject(recording=r, modelled=missed, regions=located(r, missed))
    for given, said in ((subject, ["model"]), (replace(subject, before=force),
                        ["model before", "model"])):  # fmt: skip
        left, right = panels(figure("misfit", given))
        assert left.get_title("left") == "by velocity and PWM duty; grey: fewer than 5 samples"
        legend = right.get_legend()
        assert legend is not None
        assert [text.get_text() for text in legend.get_texts()] == said


def test_a_part_says_how_much_is_drawn(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """2 s of 60 s at 200 Hz, both ends in it."""
    for words, said in (
        ("", "schedule_60s.csv: 12,000 samples"),
        ("--span 2:4 ", "schedule_60s.csv: 12,000 samples; 401 drawn"),
    ):
        command = f"erdctl plot {SCHEDULE} {words}--kind motion -o a.png"
        (found,) = run(command, monkeypatch, folder)
        (corner,) = (t.get_text() for t in found.texts if "samples" in t.get_text())
        assert corner.endswith(said)

"""Every figure of the paper: its command from CONTRIBUTING, and what that draws.

The numbers drawn are compared with the fixtures' independent solution or plain formulas.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import oracle
import pandas as pd
import pytest
from drawing import command_of, labels, line, panels, run, units
from matplotlib.figure import Figure
from places import FIXTURES, ROOT
from scipy.spatial import cKDTree

CAMPAIGN = pd.read_parquet(FIXTURES / "healthy_campaign.parquet")
SCHEDULE = pd.read_csv(FIXTURES / "schedule_60s.csv")
UP, DOWN = oracle.TABLE_2.compression, oracle.TABLE_2.release
DRAWN: dict[str, list[Figure]] = {}


@pytest.fixture
def drawn(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Figures of a figure's command; each command runs once."""

    def of(figure: str) -> list[Figure]:
        command = command_of(figure)
        if command not in DRAWN:
            DRAWN[command] = run(command, monkeypatch, tmp_path)
        found = DRAWN[command]
        for each in found:
            assert all("[" in text for text in units(each)), units(each)
        return found

    return of


def exact(log: pd.DataFrame, velocity=None) -> np.ndarray:
    """The independent solution over a log of one record [N]."""
    signals = [log[c].to_numpy() for c in ("t", "x", "xdot", "duty")]
    return oracle.respond(*signals, velocity=velocity).force


def on_curve(x, y, curve_x, curve_y, scale_x: float, scale_y: float) -> float:
    """Largest distance of drawn points from a curve of samples, in parts of the panel."""
    return float(away(x, y, curve_x, curve_y, scale_x, scale_y).max())


def away(x, y, curve_x, curve_y, scale_x: float, scale_y: float) -> np.ndarray:
    """Distance of each drawn point from the nearest sample of a curve, in parts of the panel."""
    curve = cKDTree(np.column_stack([curve_x / scale_x, curve_y / scale_y]))
    found: np.ndarray = curve.query(np.column_stack([x / scale_x, y / scale_y]))[0]
    return found


@cache
def steady(level: int) -> tuple[pd.DataFrame, np.ndarray]:
    """The sines of the campaign at one PWM level [%], and their exact force [N]."""
    part = CAMPAIGN[CAMPAIGN["record"].str.fullmatch(f"sine_.*_pwm{level}")]
    return part, np.concatenate([exact(c) for _, c in part.groupby("record", sort=False)])


def test_fig_4_measured_loops(drawn) -> None:
    (figure,) = drawn("4")
    deflection, velocity = panels(figure)
    assert deflection.get_xlabel() == "deflection, compression + [mm]"
    assert velocity.get_xlabel() == "velocity, compression + [mm/s]"
    levels = CAMPAIGN.groupby((CAMPAIGN["duty"] * 100).round())
    for percent, part in levels:
        for ax, column in ((deflection, "x"), (velocity, "xdot")):
            x, y = line(ax, f"measured {percent:g} %")
            # Every dot is a sample, and none of the extremes is missing.
            samples = set(zip(part[column] * 1e3, part["force"], strict=True))
            assert set(zip(x, y, strict=True)) <= samples
            assert [x.min(), x.max()] == [part[column].min() * 1e3, part[column].max() * 1e3]
            assert [y.min(), y.max()] == [part["force"].min(), part["force"].max()]
    assert len(labels(deflection)) == len(levels) == 8


def test_fig_5_expected_characteristics(drawn) -> None:
    """At constant speed the loop is a parallelogram: k x + c v + sigma v^beta once settled."""
    (figure,) = drawn("5")
    x, y = line(panels(figure)[0], "model 30 %")
    fast = x[np.argmax(y)]
    expected = UP.k_nom * fast * 1e-3 + UP.c_vis * 0.02 + UP.sigma * 0.3**UP.beta
    assert y.max() == pytest.approx(expected, abs=0.05)
    velocity, _ = line(panels(figure)[1], "model 30 %")
    assert set(np.round(np.abs(velocity), 6)) == {20.0}


def test_fig_7_static_model(drawn) -> None:
    """Without a lag the yield force is sigma v^beta at once, Eq. 9."""
    (figure,) = drawn("7")
    static = panels(figure)[0]
    assert static.get_title(loc="left") == "static model, T_d = 0"
    steady = CAMPAIGN[CAMPAIGN["record"] == "sine_0.5Hz_20mm_pwm30"]
    v = steady["xdot"].to_numpy()
    force = np.where(
        v > 0,
        UP.k_nom * steady["x"] + UP.c_vis * v + UP.sigma * 0.3**UP.beta,
        DOWN.k_nom * steady["x"] + DOWN.c_vis * v - DOWN.sigma * 0.3**DOWN.beta,
    )
    x, y = line(static, "static model 30 %")
    wide = np.abs(x) > 18.2  # only this record goes so far at this level
    assert np.count_nonzero(wide) > 20
    assert on_curve(x[wide], y[wide], steady["x"] * 1e3, force, 40, 40) < 1e-6


def test_fig_8_static_and_dynamic(drawn) -> None:
    (figure,) = drawn("8")
    _, dynamic, below, lagging = panels(figure)
    assert dynamic.get_title(loc="left") == "dynamic model, T_d = 43 ms"
    steady = CAMPAIGN[CAMPAIGN["record"] == "sine_0.5Hz_20mm_pwm30"]
    x, y = line(dynamic, "dynamic model 30 %")
    wide = np.abs(x) > 18.2
    # Motion in the log is rounded to 0.1 um: reversals, and the force next to them, to 1e-4 s.
    assert on_curve(x[wide], y[wide], steady["x"] * 1e3, exact(steady), 40, 40) < 2e-3
    # The shared state makes the two differ after a reversal, and by no more than its two ends.
    (_, still), (_, moving) = line(below, "static model 30 %"), line(lagging, "dynamic model 30 %")
    ends = abs(UP.sigma * 0.3**UP.beta - DOWN.sigma * 0.3**DOWN.beta)
    assert 0.0 < abs(still.max() - moving.max()) <= ends + 1e-9


@pytest.mark.parametrize("number", ["9", "11"])
def test_figs_9_and_11_model_against_recording(drawn, number: str) -> None:
    (figure,) = drawn(number)
    for ax, column in zip(panels(figure), ("x", "xdot"), strict=True):
        measured = {name for name in labels(ax) if name.startswith("measured")}
        modelled = {name for name in labels(ax) if name.startswith("model")}
        assert len(measured) == len(modelled) == 8
        for level in (10, 15, 20, 25, 30):
            x, y = line(ax, f"model {level} %")
            part, force = steady(level)
            far = np.abs(y) > 12.0
            motion = 1e3 * part[column].to_numpy()
            # Most of what is drawn are the steady loops of that level.
            assert np.mean(away(x[far], y[far], motion, force, motion.max(), 20) < 0.01) > 0.5


def test_fig_10_yield_force(drawn) -> None:
    (figure,) = drawn("10")
    (ax,) = panels(figure)
    assert ax.get_ylabel() == "yield force [N]"
    bars = {c.get_label(): c for c in ax.containers}
    for direction, branch in (("compression", UP), ("release", DOWN)):
        duty, force = bars[f"measured, {direction}"].lines[0].get_data()
        law = branch.sigma * (duty / 100) ** branch.beta
        # The lag after a reversal mixes in the other direction's force; the noise is 0.3 N.
        assert np.abs(force - law).max() < 0.45
        name = next(n for n in labels(ax) if n.startswith(f"model, {direction}"))
        v, curve = line(ax, name)
        known = v >= 5.0  # the levels that the log holds
        expected = branch.sigma * (v[known] / 100) ** branch.beta
        assert curve[known] == pytest.approx(expected, rel=0.01)


def test_fig_12_force_over_time(drawn) -> None:
    (figure,) = drawn("12")
    upper, lower = panels(figure)
    truth = exact(SCHEDULE)
    t, measured = line(upper, "measured")
    rows = np.searchsorted(SCHEDULE["t"], t)
    assert measured.tolist() == SCHEDULE["force"].iloc[rows].tolist()
    assert [measured.min(), measured.max()] == [SCHEDULE["force"].min(), SCHEDULE["force"].max()]
    t, model = line(upper, "model")
    assert model == pytest.approx(truth[np.searchsorted(SCHEDULE["t"], t)], abs=0.02)
    _, difference = line(lower, "difference")
    rest = SCHEDULE["force"].to_numpy() - truth
    assert difference.max() == pytest.approx(rest.max(), abs=0.02)
    rms = float(lower.get_title(loc="left").split(": ")[1].split()[0])
    assert rms == pytest.approx(np.sqrt(np.mean(rest**2)), rel=0.01)
    assert lower.get_xlabel() == "time [s]"


def test_fig_13_damper_diagrams_on_bumps(drawn) -> None:
    (figure,) = drawn("13")
    truth = exact(SCHEDULE)
    for ax, column, top in zip(panels(figure), ("x", "xdot"), (10.0, 126.0), strict=True):
        x, y = line(ax, "model 30 %")
        assert on_curve(x, y, SCHEDULE[column] * 1e3, truth, top, 30) < 2e-3
        assert y.max() == pytest.approx(truth[200:].max(), abs=0.05)


FAULTS = {
    "oil=0.5": lambda gas, viscous, yield_: 0.5 * (gas + viscous + yield_),
    "electrical=0.5": lambda gas, viscous, yield_: gas + viscous + 0.5 * yield_,
    "deformation=0.5": lambda gas, viscous, yield_: gas + 0.5 * (viscous + yield_),
}


@pytest.mark.few(2)
@pytest.mark.parametrize(
    ("number", "faults"),
    [("14", ["oil=0.5"]), ("15", ["electrical=0.5"]), ("17", ["deformation=0.5"]),
     ("18", list(FAULTS))],
)  # fmt: skip
def test_figs_14_15_17_18_faults(drawn, number: str, faults: list[str]) -> None:
    """With no field at the left, with field at the right; deflection above velocity."""
    (figure,) = drawn(number)
    axes = panels(figure)
    assert [ax.get_title(loc="left") for ax in axes[:2]] == ["PWM duty 0 %", "PWM duty 30 %"]
    t = np.arange(3000) / 1000
    w = 2 * np.pi
    x, v = 0.01 * np.sin(w * t), 0.01 * w * np.cos(w * t)
    for column, duty in enumerate((0.0, 0.3)):
        r = oracle.respond(t, x, v, np.full_like(t, duty))
        shapes = {"healthy": r.force} | {f: FAULTS[f](r.gas, r.viscous, r.yield_) for f in faults}
        for ax, motion, top in ((axes[column], x, 10), (axes[2 + column], v, 63)):
            assert labels(ax) == set(shapes)
            for name, force in shapes.items():
                drawn_x, drawn_y = line(ax, name)
                assert on_curve(drawn_x, drawn_y, motion * 1e3, force, top, 15) < 2e-3
                assert drawn_y.max() == pytest.approx(force[500:].max(), abs=0.02)


def test_fig_19_bumps(drawn) -> None:
    (figure,) = drawn("19")
    t, x = line(panels(figure)[0], "deflection, compression +")
    on = np.mod(t, 1.0) < 0.5
    expected = np.where(on, 10.0 * np.sin(np.pi * np.mod(t, 1.0) / 0.5) ** 2, 0.0)
    assert x == pytest.approx(expected, abs=1e-9)
    assert x.max() == pytest.approx(10.0)


@pytest.mark.parametrize(("number", "panel", "column"), [("20", 0, "x"), ("21", 1, "xdot")])
def test_figs_20_and_21_motion(drawn, number: str, panel: int, column: str) -> None:
    (figure,) = drawn(number)
    ax = panels(figure)[panel]
    t, values = line(ax, ax.get_lines()[-1].get_label())
    rows = np.searchsorted(SCHEDULE["t"], t)
    assert values == pytest.approx(1e3 * SCHEDULE[column].iloc[rows].to_numpy())
    assert t.max() <= 5.0 < SCHEDULE["t"].max()


def parts() -> oracle.Response:
    return oracle.respond(*(SCHEDULE[c].to_numpy() for c in ("t", "x", "xdot", "duty")))


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("number", "fault"), [("22", "oil=0.5"), ("24", "electrical=0.5"), ("26", "deformation=0.5")]
)
def test_figs_22_24_26_duty_sequences(drawn, number: str, fault: str) -> None:
    figure = drawn(number)[0]
    (ax,) = panels(figure)
    assert ax.get_ylabel() == "duty cycle [%]"
    _, healthy = line(ax, "healthy duty")
    assert set(healthy) == {30.0}
    t, duty = line(ax, "sequence to push")
    assert duty.min() >= 0.0
    assert duty.max() <= 45.0 + 1e-9
    if fault == "electrical=0.5":
        # Eq. 31 where the lag has nothing to make up for: v f^(1/beta), in the middle of a stroke.
        settled = SCHEDULE["xdot"].abs().iloc[np.searchsorted(SCHEDULE["t"], t)] > 0.06
        levels = {30 * 0.5 ** (1 / b.beta) for b in (UP, DOWN)}
        miss = np.min([np.abs(duty[settled] - level) for level in levels], axis=0)
        assert np.median(miss) < 0.2
    r = parts()
    ideal = FAULTS[fault](r.gas, r.viscous, r.yield_)
    rest = ideal - r.gas - r.viscous
    unreachable = rest * np.sign(SCHEDULE["xdot"].to_numpy()) < 0.0
    (bars,) = [c for c in ax.collections if str(c.get_label()).startswith("out of reach")]
    share = 100 * float(np.mean(unreachable))
    assert f"({share:.1f} % of the time)" in str(bars.get_label())


@pytest.mark.parametrize(
    ("number", "fault"), [("23", "oil=0.5"), ("25", "electrical=0.5"), ("27", "deformation=0.5")]
)
def test_figs_23_25_27_faults_in_force_against_velocity(drawn, number: str, fault: str) -> None:
    figure = drawn(number)[1]
    (ax,) = panels(figure)
    assert ax.get_title(loc="left").startswith(fault)
    r = parts()
    ideal = FAULTS[fault](r.gas, r.viscous, r.yield_)
    speed = SCHEDULE["xdot"] * 1e3
    for name, force in (("healthy", r.force), ("ideal faulty force", ideal)):
        x, y = line(ax, name)
        rows = slice(0, len(x))
        assert x == pytest.approx(speed[rows].to_numpy())
        assert y == pytest.approx(force[rows], abs=0.03)
    _, made = line(ax, "force to expect")
    assert np.sqrt(np.mean((made - ideal[: len(made)]) ** 2)) < 0.05 * np.ptp(ideal)


WINDOWS = (("oil", 15, 31), ("electrical", 31, 46), ("deformation", 46, 1e9))


def sequence_forces() -> tuple[np.ndarray, np.ndarray]:
    r, t = parts(), SCHEDULE["t"].to_numpy()
    g = {k: np.ones_like(t) for k in ("gas", "viscous", "yield")}
    for (kind, start, end), f in zip(WINDOWS, (0.5, 0.8, 0.7), strict=True):
        at = (t >= start) & (t < end)
        for group in {"oil": g, "electrical": ["yield"], "deformation": ["viscous", "yield"]}[kind]:
            g[group][at] *= f
    return r.force, g["gas"] * r.gas + g["viscous"] * r.viscous + g["yield"] * r.yield_


def test_fig_28_sequence(drawn) -> None:
    ax = panels(drawn("28")[0])[0]
    marks = {text.get_text() for text in ax.texts}
    assert {m.split("=")[0] for m in marks} == {"oil", "electrical", "deformation"}
    t, duty = line(ax, "sequence to push")
    # Sec. 6.4: from 31 s the electrical fault holds v f^(1/beta) in either direction.
    at = (t > 32) & (t < 45)
    levels = [30 * 0.8 ** (1 / b.beta) for b in (UP, DOWN)]
    assert [duty[at].min(), duty[at].max()] == pytest.approx(sorted(levels), rel=0.02)


def test_fig_29_force_over_time(drawn) -> None:
    upper, lower = panels(drawn("29")[1])
    healthy, ideal = sequence_forces()
    for name, force in (("healthy", healthy), ("ideal faulty force", ideal)):
        t, y = line(upper, name)
        assert y == pytest.approx(force[np.searchsorted(SCHEDULE["t"], t)], abs=0.03)
    t, y = line(upper, "force to expect")
    quiet = t < 14.9
    assert np.abs(y[quiet] - healthy[np.searchsorted(SCHEDULE["t"], t[quiet])]).max() < 0.2
    assert "N rms" in lower.get_title(loc="left")


def test_fig_30_loops_of_the_sequence(drawn) -> None:
    axes = panels(drawn("30")[2])
    assert [ax.get_title(loc="left").split("=")[0] for ax in axes] == [
        name for name, _, _ in WINDOWS
    ]
    _, ideal = sequence_forces()
    for ax, (_, start, end) in zip(axes, WINDOWS, strict=True):
        at = ((SCHEDULE["t"] >= start) & (SCHEDULE["t"] < end)).to_numpy()
        x, y = line(ax, "ideal faulty force")
        assert x == pytest.approx(1e3 * SCHEDULE["xdot"][at].to_numpy()[: len(x)])
        assert y == pytest.approx(ideal[at][: len(y)], abs=0.03)


def test_every_figure_has_its_row_and_the_tests_that_it_names() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text()
    numbers: set[int] = set()
    for row in re.findall(r"^\| Figs?\. .*$", text, re.MULTILINE):
        first = row.split("|")[1]
        for part in re.findall(r"\d+(?:-\d+)?", first):
            low, _, high = part.partition("-")
            numbers |= set(range(int(low), int(high or low) + 1))
        if "test_paper_figures::" in row:
            assert set(re.findall(r"(test_figs?_\w+)", row)) <= set(globals())
    assert numbers == set(range(1, 31))

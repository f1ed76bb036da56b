"""Tables, texts, notebook displays and figures of results."""

from __future__ import annotations

from html.parser import HTMLParser
from typing import Any

import pandas as pd
import pytest
from interface.calls import CAMPAIGN, LATE, SCHEDULE, TABLE_2
from matplotlib.figure import Figure

import erdctl


class Tags(HTMLParser):
    """The tags of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.found.append(tag)


@pytest.fixture(scope="module")
def results() -> dict[str, Any]:
    log = pd.read_parquet(CAMPAIGN)
    few = [name for name in log["record"].unique() if "steps" in name][:2]
    log = log[log["record"].isin([*few, "sine_2Hz_11mm_pwm0"])].iloc[::4]
    log["record"] = log["record"].replace(few[0], "<b>loud</b>")
    read = erdctl.read(log)
    damper = erdctl.identify(read)
    return {
        "log": read,
        "inspected": erdctl.inspect(read),
        "damper": damper,
        "validated": erdctl.validate(damper, read),
        "simulated": erdctl.simulate(damper, read, faults="oil=0.5"),
        "mimicked": erdctl.mimic(damper, SCHEDULE, ["oil=0.5@15:31", "electrical=0.8,channel=rr"]),
        "diagnosed": erdctl.diagnose(LATE, effects="input_delay"),
        "effects": erdctl.effects(),
        "effect": erdctl.effects("input_delay"),
    }


NAMES = [
    "log", "inspected", "damper", "validated", "simulated", "mimicked", "diagnosed", "effects",
    "effect",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_gets_a_small_escaped_table(name: str, results: dict[str, Any]) -> None:
    page = results[name]._repr_html_()
    assert len(page) < 20_000
    allowed = {"div", "b", "table", "thead", "tbody", "tr", "th", "td", "ul", "li"}
    tags = Tags(page).found
    assert set(tags) <= allowed
    assert tags.count("b") == 1  # the title, and no record's name
    if name in ("log", "inspected", "validated", "simulated"):
        assert "&lt;b&gt;loud" in page


@pytest.mark.parametrize("name", NAMES)
def test_a_prompt_gets_lines(name: str, results: dict[str, Any]) -> None:
    shown = repr(results[name])
    assert shown.startswith(type(results[name]).__name__ + ": ")
    assert "object at 0x" not in shown
    assert "\n" in shown or name == "simulated"


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("log", [None, "motion", "peak-force"]),
        ("inspected", [None, "motion"]),
        ("damper", ["loops", "yield-force", "misfit", "static"]),
        ("validated", ["loops", "time", "misfit"]),
        ("simulated", [None, "time"]),
        ("mimicked", ["mimic", "duty"]),
        ("diagnosed", ["before-after", "misfit"]),
    ],
)
def test_figures_are_drawn(name: str, kinds: list[str | None], results: dict[str, Any]) -> None:
    for kind in kinds:
        figure = results[name].plot() if kind is None else results[name].plot(kind)
        assert isinstance(figure, Figure)
        assert any(ax.lines or ax.collections or ax.patches for ax in figure.axes)


def test_a_figure_shows_itself_in_a_notebook(results: dict[str, Any]) -> None:
    assert results["damper"].plot("yield-force")._repr_png_().startswith(b"\x89PNG")


def test_a_part_of_a_log_is_drawn(results: dict[str, Any]) -> None:
    figure = results["damper"].plot("time", records="<b>loud</b>", span=(1.0, 2.0))
    low, high = figure.axes[0].get_xlim()
    assert 0.8 < low <= 1.01
    assert 1.99 <= high < 2.2


def test_another_damper_is_drawn(results: dict[str, Any]) -> None:
    assert results["mimicked"].plot("duty", damper="rr").axes
    with pytest.raises(erdctl.ErdctlError, match="damper takes fl, rr, not 'rl'"):
        results["mimicked"].plot(damper="rl")


def test_tables_are_tidy_and_state_units(results: dict[str, Any]) -> None:
    damper = results["damper"].table()
    assert list(damper["unit"][:5]) == ["N/m", "N s/m", "s", "N", "1"]
    assert len(damper) == 10
    assert damper["value"].dtype == float
    scores = results["validated"].table()
    assert list(scores.columns) == ["by", "group", "samples", "rms [N]", "nrmse"]
    assert set(scores["by"]) == {"all", "duty", "direction", "record"}
    assert scores.loc[scores["by"] == "record", "samples"].sum() == len(results["log"])
    found = results["diagnosed"].table()
    assert list(found["effect"] + "." + found["parameter"] + found["unit"]) == ["input_delay.taus"]
    where = results["diagnosed"].table("mismatch")
    assert list(where["unit"]) == ["s"] * len(where)
    levels = results["diagnosed"].table("scores")
    assert list(levels["duty"]) == [0.0, 0.1, 0.2, 0.3, 0.45, "all"]
    assert results["diagnosed"].table("untestable").empty
    undetected = results["diagnosed"].table("undetected")
    assert set(undetected.columns) >= {"effect", "parameter", "size", "unit", "force_rms"}
    reach = results["mimicked"].table("reach")
    assert list(reach["damper"]) == ["fl", "rr"]
    assert {"missing rms [N]", "missing max [N]"} <= set(reach.columns)
    assert len(results["mimicked"].table()) == 12_000
    assert results["mimicked"].table().attrs["units"]["force_expected"] == "N"


def test_tables_of_an_inspection(results: dict[str, Any]) -> None:
    seen = results["inspected"]
    cover = seen.table()
    assert set(cover["kind"]) == {"parameter", "effect"}
    assert len(cover) == 10 + len(results["effects"])
    lacking = cover[~cover["identifiable"]]
    assert lacking[["reason", "drive"]].notna().all(axis=None)
    assert len(seen.table("records")) == 3
    assert {"rate [Hz]", "stroke [m]"} <= set(seen.table("records").columns)
    assert seen.table("duty")["time [s]"].sum() > 0
    assert set(seen.table("channels")["unit"]) >= {"s", "m", "N"}


def test_tables_of_the_catalogue(results: dict[str, Any]) -> None:
    table = results["effects"].table()
    assert len(table) == len(results["effects"])
    assert table["equation"].str.len().min() > 5
    one = results["effect"].table("parameters")
    assert list(one["symbol"]) == ["tau"]
    assert list(one["unit"]) == ["s"]


def test_a_verdict_without_findings_has_an_empty_table() -> None:
    log = pd.read_csv(SCHEDULE).iloc[::6]
    found = erdctl.diagnose(log, parameters=TABLE_2, effects="coulomb_friction")
    assert found.verdict == "adequate"
    assert found.table().empty
    assert "effect" in found.table().columns
    assert "adequate" in found._repr_html_()
    assert {"nrmse baseline", "nrmse refitted"} <= set(found.table("scores").columns)

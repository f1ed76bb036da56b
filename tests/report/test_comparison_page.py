"""The page of a fleet of 2,000 logs: small, self-contained, and used by keyboard alone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fleets import draw
from opened import Opened

from erdctl.compare.comparison import Compared, compare
from erdctl.io.campaign_in import histories
from erdctl.report.fleet_picture import fleet_figure
from erdctl.report.page.comparison import comparison_page
from erdctl.report.page.render import Run

EVIL = "</script><b onclick=alert(1)>"


@pytest.fixture(scope="module")
def fleet() -> Compared:
    table, _ = draw(4)
    found = compare(histories(table))
    assert found.logs > 1800
    return found


@pytest.fixture(scope="module")
def page(fleet: Compared, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "fleet.html"
    path.write_text(comparison_page(fleet, run=Run(words=["compare", EVIL])))
    return path


@pytest.fixture
def opened(browser: Any, page: Path) -> Iterator[Opened]:
    found = Opened(browser, page)
    yield found
    found.context.close()


def test_small_and_by_itself(opened: Opened, page: Path) -> None:
    assert page.stat().st_size < 5e6
    assert opened.requests == [page.as_uri()]
    assert opened.errors == []
    assert opened.page.evaluate("document.scrollingElement.scrollWidth") <= 1280


def test_what_needs_attention_comes_first(opened: Opened, fleet: Compared) -> None:
    names = opened.page.locator("#glance tbody th").all_inner_texts()
    assert names == [d.history.damper for d in fleet.dampers]
    rows = opened.page.locator("#glance tbody tr").all_inner_texts()
    assert [row.split("\t")[1] == "changed" for row in rows] == [True] * 3 + [False] * 17
    assert opened.page.locator("#details article").count() == 3


def test_by_keyboard(opened: Opened, fleet: Compared) -> None:
    """To the worst damper, into its figure, to the values of single logs, and back."""
    focus = "document.activeElement.closest('[id]')?.id"
    page = opened.page
    for _ in range(12):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.textContent") == fleet.dampers[0].history.damper:
            break
    page.keyboard.press("Enter")
    assert page.evaluate("location.hash") == "#damper-0"
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.tagName") == "FIGURE"
    assert page.evaluate(focus) == "damper-0"
    before = opened.view("damper-0-0")
    page.keyboard.press("+")
    assert opened.view("damper-0-0") != before
    page.keyboard.press(".")
    assert page.locator("figure[data-figure='damper-0-0'] .tip").inner_text().strip()
    assert opened.drawn("damper-0-0") > 50


def test_the_picture_shows_them(fleet: Compared) -> None:
    figure = fleet_figure(fleet)
    left, *panels = figure.get_axes()
    assert [t.get_text() for t in left.get_yticklabels()] == [
        d.history.damper for d in fleet.dampers
    ]
    titles = {ax.get_title(loc="left").split(":")[0] for ax in panels}
    assert {d.history.damper for d in fleet.dampers[:3]} <= titles

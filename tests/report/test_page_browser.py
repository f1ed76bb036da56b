"""Every page opened in a browser: what it shows, fetches, and lets one do."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from opened import Opened
from pages import CONCEALED, EVIL_FILE, EVIL_RECORD, HEALTHY, NAMES

Made = Callable[[str], Path]
ANSWERS = ("answer-model", "answer-where", "answer-why", "answer-better")
DIAGNOSED = (*HEALTHY, *CONCEALED, "rubbing")
SECONDS = 2.0  # within which a page must be there
READY = "performance.getEntriesByType('navigation')[0].loadEventEnd"


@pytest.mark.few(2)
@pytest.mark.parametrize("name", NAMES)
def test_opens_by_itself_and_at_once(window: Callable[..., Opened], made: Made, name: str) -> None:
    found = window(name)
    assert found.errors == []
    assert found.requests == [made(name).as_uri()]
    assert made(name).stat().st_size < 5e6
    # The best of a few: what is asked of the page, not of the load on the machine.
    ready = []
    for _ in range(5):
        ready.append(found.page.evaluate(READY))
        if 0 < ready[-1] < 1e3 * SECONDS:
            break
        found.page.reload()
    assert 0 < min(ready) < 1e3 * SECONDS


@pytest.mark.few(2)
@pytest.mark.parametrize("size", [(1280, 800), (360, 780)], ids=["desk", "narrow"])
@pytest.mark.parametrize("name", NAMES)
def test_the_first_screen_answers(
    looked: Callable[..., Opened], name: str, size: tuple[int, int]
) -> None:
    found = looked(name, viewport={"width": size[0], "height": size[1]})
    for answer in ANSWERS if name != "proof" else ("answer-model", "answer-where"):
        box = found.page.locator(f"#{answer}").bounding_box()
        assert box["y"] + box["height"] <= size[1], answer
        assert found.page.locator(f"#{answer} dd").inner_text().strip()
    assert found.page.locator("h1").bounding_box()["y"] < 200
    # Nothing wider than the screen: one scrolls down, not to the side.
    assert found.page.evaluate("document.scrollingElement.scrollWidth") <= size[0]


def test_what_a_diagnosis_says(looked: Callable[..., Opened], made: Made) -> None:
    found = looked("rubbing").page
    document = json.loads(made("rubbing").with_suffix(".out.json").read_text())
    assert found.locator("h1").inner_text() == (
        "The paper's model does not hold; coulomb friction explains what it misses."
    )
    held = document["heldout"]
    better = found.locator("#answer-better").inner_text()
    assert f"{held['before']['nrmse']:.4f} → {held['after']['nrmse']:.4f}" in better
    assert document["mismatch"][0]["text"][:10] in found.locator("#answer-where").inner_text()
    assert found.locator("#findings math msub").count() >= 1
    rows = found.locator("#heldout tbody tr")
    assert rows.count() == len(held["before"]["nrmse_by_duty"]) + 1
    origin = found.locator("#provenance").inner_text()
    assert document["provenance"]["logs"][0]["sha256"] in origin
    assert "--seed 3" in origin
    F_c = document["findings"][0]["parameters"]["F_c"]
    assert f"{F_c['value']:.4g}" in found.locator("#findings table").first.inner_text()


@pytest.mark.parametrize("name", CONCEALED)
def test_the_first_screen_names_what_was_hidden(
    looked: Callable[..., Opened], made: Made, name: str
) -> None:
    found = looked(name).page
    document = json.loads(made(name).with_suffix(".out.json").read_text())
    _, effect, words = CONCEALED[name]
    assert document["findings"][0]["effect"] == effect
    assert f"{words} explains what it misses" in found.locator("h1").inner_text()
    held = document["heldout"]
    assert held["after"]["nrmse"] < 0.6 * held["before"]["nrmse"]
    better = found.locator("#answer-better").inner_text()
    assert f"{held['before']['nrmse']:.4f} → {held['after']['nrmse']:.4f}" in better
    where = document["mismatch"][0]["text"] if document["mismatch"] else "Everywhere"
    assert where[:10] in found.locator("#answer-where").inner_text()


@pytest.mark.few(1)
@pytest.mark.parametrize("name", HEALTHY)
def test_a_healthy_damper_is_said_to_be(looked: Callable[..., Opened], name: str) -> None:
    found = looked(name).page
    assert "holds" in found.locator("h1").inner_text()
    assert "Yes" in found.locator("#answer-model").inner_text()


def test_a_sequence_says_what_is_out_of_reach(looked: Callable[..., Opened]) -> None:
    found = looked("mimic")
    assert "oil=0.2" in found.page.locator("h1").inner_text()
    assert "N are missing" in found.page.locator("#answer-where").inner_text()
    spec = found.page.evaluate("JSON.parse(document.getElementById('data').textContent).figures")
    bands = spec["duty-fl"]["bands"]
    assert [b["text"] for b in bands if not b.get("bad")] == ["oil", "electrical"]
    assert all(15.0 <= b["low"] <= b["high"] <= 31.0 for b in bands if b.get("bad"))


def test_names_of_logs_are_text(looked: Callable[..., Opened]) -> None:
    found = looked("rubbing")
    assert EVIL_FILE in found.page.locator(".kicker").inner_text()
    assert found.page.title().startswith("Diagnosis of")
    assert EVIL_RECORD in found.page.locator("#records").inner_text()
    assert found.page.locator("img").count() == 0


@pytest.mark.parametrize("name", DIAGNOSED)
def test_loops_show_every_level(looked: Callable[..., Opened], name: str) -> None:
    found = looked(name)
    levels = found.page.locator("button[data-level]").count()
    for figure in ("loop-xdot-before", "loop-x-before"):
        assert found.drawn(figure) > 500
        assert found.colours(figure) > levels
    assert found.colours("map-before") > 5
    label = found.figure("loop-xdot-before").locator("text.axis-label")
    assert label.all_text_contents() == ["Velocity [mm/s]", "Force [N]"]


def test_zoom_by_button_wheel_and_drag(window: Callable[..., Opened]) -> None:
    found = window("rubbing")
    name, other = "loop-xdot-before", "loop-xdot-after"
    start = found.view(name)
    found.figure(name).get_by_role("button", name=re.compile("Zoom in")).click()
    closer = found.view(name)
    assert start[0] < closer[0] < closer[1] < start[1]
    assert found.view(other) == pytest.approx(closer)  # side by side they go together
    found.figure(name).get_by_role("button", name=re.compile("Reset")).click()
    assert found.view(name) == pytest.approx(start)
    plot = found.figure(name).locator(".plot")
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    x, y = box["x"] + 0.6 * box["width"], box["y"] + 0.5 * box["height"]
    found.page.mouse.move(x, y)
    found.page.mouse.wheel(0, -300)  # not chosen yet: the page scrolls
    found.page.wait_for_timeout(200)
    assert found.view(name) == pytest.approx(start)
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    x, y = box["x"] + 0.6 * box["width"], box["y"] + 0.5 * box["height"]
    found.page.mouse.click(x, y)
    found.page.mouse.wheel(0, -300)
    found.page.wait_for_timeout(200)
    closer = found.view(name)
    assert closer[1] - closer[0] < start[1] - start[0]
    found.page.mouse.move(x, y)
    found.page.mouse.down()
    found.page.mouse.move(x + 30, y, steps=3)
    found.page.mouse.up()
    assert found.view(name)[0] < closer[0]
    found.page.mouse.dblclick(x, y)
    assert found.view(name) == pytest.approx(start)


@pytest.mark.parametrize(
    ("page", "name", "words"),
    [
        ("rubbing", "loop-xdot-after", "PWM"),
        ("rubbing", "map-before", "RMS misfit"),
        ("rubbing", "profile-xdot", "mm/s"),
        ("mimic", "duty-fl", "Time"),
        ("proof", "cases", "named: "),
    ],
)
def test_values_by_key_and_by_mouse(
    window: Callable[..., Opened], page: str, name: str, words: str
) -> None:
    found = window(page)
    figure = found.figure(name)
    figure.focus()
    found.page.keyboard.press(".")
    found.page.keyboard.press(".")
    tip = figure.locator(".tip")
    assert words in tip.inner_text()
    found.page.keyboard.press("Escape")
    assert tip.is_hidden()
    place = found.page.evaluate(
        """(name) => {
          const frame = erd.frames.find((f) => f.figure.dataset.figure === name);
          const next = (hit) => frame.kind.step(hit, 1, frame.x, frame.y, frame.inner);
          const hit = next(next(null));
          frame.place.scrollIntoView({ block: "center", behavior: "instant" });
          const box = frame.place.getBoundingClientRect();
          return [box.x + frame.x(hit.x), box.y + frame.y(hit.y), hit.text];
        }""",
        name,
    )
    found.page.mouse.move(place[0] + 1, place[1] + 1)
    tip.wait_for(state="visible", timeout=5_000)  # a move is told with the next frame
    assert words in tip.inner_text()
    box, screen = tip.bounding_box(), found.page.viewport_size
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= screen["width"]


def test_zoom_by_keys(window: Callable[..., Opened]) -> None:
    found = window("campaign")
    name = "loop-x-before"
    found.figure(name).focus()
    start = found.view(name)
    for key in ("+", "+", "ArrowRight", "ArrowUp"):
        found.page.keyboard.press(key)
    moved = found.view(name)
    assert moved[1] - moved[0] == pytest.approx((start[1] - start[0]) / 2.25)
    assert moved[0] + moved[1] > start[0] + start[1]
    found.page.keyboard.press("-")
    found.page.keyboard.press("0")
    assert found.view(name) == pytest.approx(start)


def test_the_keyboard_reaches_everything(window: Callable[..., Opened]) -> None:
    found = window("rubbing").page
    found.keyboard.press("Tab")
    assert found.evaluate("document.activeElement.className") == "skip"
    assert found.locator(".skip").bounding_box()["x"] >= 0
    found.keyboard.press("Enter")
    assert found.evaluate("document.activeElement.id") == "main"
    seen = set()
    for _ in range(80):
        found.keyboard.press("Tab")
        seen.add(found.evaluate("document.activeElement.dataset.figure || ''"))
        ring = found.evaluate("parseFloat(getComputedStyle(document.activeElement).outlineWidth)")
        assert ring >= 2
    figures = found.locator("main figure[data-figure]").evaluate_all(
        "all => all.map(f => f.dataset.figure)"
    )
    assert set(figures) <= seen


def test_levels_layers_and_records_are_chosen(window: Callable[..., Opened]) -> None:
    found = window("campaign")
    name = "loop-xdot-before"
    every = found.drawn(name)
    level = found.page.locator("button[data-level='0']")
    level.click()
    assert level.get_attribute("aria-pressed") == "false"
    assert 0 < found.drawn(name) < every
    level.click()
    assert found.drawn(name) == every
    colours = found.colours(name)
    found.page.locator("button[data-layer='modelled']").click()
    assert found.colours(name) != colours
    found.page.locator("#records").select_option(index=1)
    assert found.drawn(name) > every  # all records, not one for each level


@pytest.mark.parametrize("name", NAMES)
def test_tables_have_names_and_headings(looked: Callable[..., Opened], name: str) -> None:
    found = looked(name).page
    tables = found.locator("table").evaluate_all(
        """all => all.map(t => [
          t.caption && t.caption.textContent.trim() !== "",
          [...t.querySelectorAll("th")].every(h => h.scope),
          [...t.querySelectorAll("tbody tr")].every(r => r.querySelector("th[scope=row]")),
        ])"""
    )
    assert tables
    assert all(all(t) for t in tables)


def lightness(colour: str) -> float:
    return sum(map(float, re.findall(r"[\d.]+", colour)[:3])) / 3


def test_dark_where_the_system_is_dark_and_light_on_paper(
    window: Callable[..., Opened], tmp_path: Path
) -> None:
    found = window("rubbing", color_scheme="dark")
    style = "getComputedStyle(document.body)"
    assert lightness(found.page.evaluate(f"{style}.backgroundColor")) < 60
    assert lightness(found.page.evaluate(f"{style}.color")) > 200
    assert found.colours("loop-xdot-after") > 5
    dark = found.page.evaluate("erd.theme().ink")
    found.page.emulate_media(color_scheme="light")
    found.page.wait_for_timeout(50)
    assert lightness(found.page.evaluate(f"{style}.backgroundColor")) > 240
    assert found.page.evaluate("erd.theme().ink") != dark
    found.page.emulate_media(color_scheme="dark")
    found.page.evaluate("window.onafterprint = () => { window.printed = true; }")
    paper = tmp_path / "page.pdf"
    found.page.pdf(path=paper, format="A4", print_background=True)
    assert paper.read_bytes().startswith(b"%PDF")
    assert found.page.evaluate("window.printed") is True
    found.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert found.page.evaluate("erd.theme().dark") is False
    assert lightness(found.page.evaluate(f"{style}.backgroundColor")) > 240
    assert found.page.evaluate("erd.frames.every((f) => f.width === 400)")


def test_without_scripts_words_and_tables_remain(browser: Any, made: Made) -> None:
    context = browser.new_context(java_script_enabled=False)
    found = context.new_page()
    found.goto(made("rubbing").as_uri())
    assert "need JavaScript" in found.locator("noscript").inner_text()
    assert found.locator("#heldout tbody tr").count() > 1
    context.close()

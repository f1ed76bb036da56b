"""What a page looks like: the number first, colours as in pictures, narrow, dark and on paper."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from drawing import panels, run
from matplotlib.collections import QuadMesh
from matplotlib.colors import rgb_to_hsv, to_rgb
from opened import Opened
from pages import NAMES, TABLE_2, erdctl
from places import FIXTURES
from pypdf import PdfReader

from erdctl.effects import catalogue
from erdctl.model.corrected_equation import corrected_equation
from erdctl.report import style
from erdctl.report.page.mathml import flowing, prose
from erdctl.report.page.render import _asset
from erdctl.report.readable import headline

Made = Callable[[str], Path]
PHONE = {"width": 360, "height": 780}


def document(made: Made, name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(made(name).with_suffix(".out.json").read_text())
    return found


def test_the_first_screen_has_the_number(looked: Callable[..., Opened], made: Made) -> None:
    found = looked("worn").page
    g = document(made, "worn")["findings"][0]["parameters"]["g"]["value"]
    why = found.locator("#answer-why").inner_text()
    assert f"{1e3 * g:.3g} mm of free play" in why
    assert found.locator("#answer-why b").first.bounding_box()["y"] < 500


def test_errors_in_newton_and_of_the_peak_force(looked: Callable[..., Opened], made: Made) -> None:
    found, d = looked("worn").page, document(made, "worn")
    force = pd.read_parquet(FIXTURES / "worn_joint.parquet")["force"]
    better = found.locator("#answer-better").inner_text()
    for part in ("before", "after"):
        rms = d["heldout"][part]["rms"]
        percent = f"{100 * rms / force.abs().max():.3g} %"
        assert f"{rms:.3g} N rms ({percent})" in better
    assert f"{force.abs().max():.3g} N" in better
    rows = found.locator("#heldout tbody tr").all_inner_texts()
    for row, level in zip(rows, d["heldout"]["after"]["nrmse_by_duty"], strict=False):
        assert f"{level['nrmse']:.4f}" in row
        assert f"{level['rms']:.3g}" in row


def test_the_corrected_equation_is_on_the_first_screen(looked: Callable[..., Opened]) -> None:
    found = looked("worn").page
    box = found.locator("#answer-equation").bounding_box()
    assert box["y"] + box["height"] <= 800
    formulas = found.locator("#answer-equation math")
    alttext = " ".join(formulas.evaluate_all("all => all.map(m => m.getAttribute('alttext'))"))
    assert alttext.startswith("F = k_nom x_p + c_vis xdot_p + F_ER sign(xdot_p)")
    assert "x_p = x - q," in alttext
    # An index sits below the line, with and without a font made for formulas.
    for index in formulas.locator("msub").all()[:4]:
        letter, low = (index.locator(f":scope > :nth-child({i})").bounding_box() for i in (1, 2))
        assert low["y"] + low["height"] > letter["y"] + letter["height"]


def test_every_formula_fits_a_telephone(browser: Any, tmp_path: Path) -> None:
    """All that the catalogue can put on a page, at 360 pixels."""
    parts = [f"<!doctype html><meta charset=utf-8><style>{_asset('page.css')}</style><main>"]
    for e in catalogue():
        values: dict[str, float | None] = {q.symbol: 0.02 for q in e.quantities}
        pieces = [prose(e.title), flowing(e.equation), prose(headline(e, values))]
        pieces += [flowing(line) for line in corrected_equation([e])]
        parts += [f"<section id='{e.name}'>", *map(str, pieces), "</section>"]
    path = tmp_path / "catalogue.html"
    path.write_text("".join(parts))
    page = browser.new_page(viewport=PHONE)
    page.goto(path.as_uri())
    assert page.evaluate("document.scrollingElement.scrollWidth") <= PHONE["width"]
    assert page.locator("code.equation").count() == 0
    for fraction in page.locator("mfrac").all()[:60]:
        over, under = (fraction.locator(f":scope > :nth-child({i})").bounding_box() for i in (1, 2))
        assert over["y"] < under["y"]
    text = page.locator("main").inner_text()
    assert not re.search(r"\w_\w|xdot|\^", text)
    page.close()


@pytest.mark.few(5)
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_telephone_never_scrolls_sideways(
    window: Callable[..., Opened], name: str, scheme: str
) -> None:
    found = window(name, viewport=PHONE, color_scheme=scheme)
    assert found.errors == []
    assert found.page.evaluate("document.scrollingElement.scrollWidth") <= PHONE["width"]
    wide = found.page.evaluate(
        """[...document.querySelectorAll("body *")].filter((e) => {
             const box = e.getBoundingClientRect();
             const inside = e.closest(".scroll, .piece, .plot, .skip");
             return box.width && box.left >= 0 && box.right > 361 && !inside;
           }).map((e) => e.outerHTML.slice(0, 80))"""
    )
    assert wide == []


SWATCHES = (
    "JSON.stringify([...document.querySelectorAll('[data-swatch]')]"
    ".map(s => getComputedStyle(s).backgroundColor))"
)


def page_colours(found: Opened) -> dict[str, list[str]]:
    """The colours of the levels, as the swatches show them, for each scheme."""
    page, out = found.page, dict[str, str]()
    page.emulate_media(color_scheme="light")
    out["light"] = page.evaluate(SWATCHES)
    page.emulate_media(color_scheme="dark")
    # A page is painted again when its machine comes to it: 50 ms were too short for a busy one.
    page.wait_for_function(f"light => {SWATCHES} !== light", arg=out["light"])
    out["dark"] = page.evaluate(SWATCHES)
    return {k: [hexadecimal(c) for c in json.loads(v)] for k, v in out.items()}


def hexadecimal(css: str) -> str:
    return style.hexadecimal(tuple(int(v) / 255 for v in re.findall(r"\d+", css)[:3]))  # type: ignore[arg-type]  # three


def test_a_level_has_one_colour_in_pictures_and_pages(
    looked: Callable[..., Opened], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    shown = page_colours(looked("worn"))
    log = FIXTURES / "worn_joint.parquet"
    command = f"erdctl plot {log} --params {TABLE_2} -o a.png"
    (figure,) = run(command, monkeypatch, tmp_path)
    drawn = {
        str(a.get_label()): style.hexadecimal(to_rgb(a.get_color()))
        for a in panels(figure)[0].get_lines()
    }
    levels = ["0 %", "15 %", "30 %"]
    assert [drawn[f"model {level}"] for level in levels] == shown["light"]
    for light, dark in zip(shown["light"], shown["dark"], strict=True):
        hues = [rgb_to_hsv(to_rgb(c))[0] for c in (light, dark)]
        assert hues[0] == pytest.approx(hues[1], abs=0.02)
        assert style.luminance(to_rgb(dark)) >= 0.99 * style.LEAST_ON_DARK
    assert len(set(shown["dark"])) == len(levels)


def test_a_misfit_has_one_colour_in_pictures_and_pages(
    looked: Callable[..., Opened], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    colours = looked("worn").page.evaluate(
        "JSON.parse(document.getElementById('data').textContent).figures['map-before'].colours"
    )
    log = FIXTURES / "worn_joint.parquet"
    command = f"erdctl plot {log} --params {TABLE_2} --kind misfit -o a.png"
    (figure,) = run(command, monkeypatch, tmp_path)
    (mesh,) = [c for ax in figure.axes for c in ax.collections if isinstance(c, QuadMesh)][:1]
    even = mesh.get_cmap()(np.linspace(0.0, 1.0, len(colours)))
    for theirs, ours in zip(even, colours, strict=True):
        assert theirs[:3] == pytest.approx(to_rgb(ours), abs=2 / 255)


@pytest.mark.long
def test_a_printed_table_has_its_head_on_every_page(browser: Any, tmp_path: Path) -> None:
    """A table of 150 records over several sheets of paper."""
    rng = np.random.default_rng(1)
    t = np.arange(0.0, 1.0, 0.01)
    parts = []
    for i in range(150):
        x = 0.01 * np.sin(2 * np.pi * t)
        force = 300 * x + 3.77 * np.cos(2 * np.pi * t) + rng.normal(0, 0.3, len(t))
        parts.append(pd.DataFrame({"t": t, "x": x, "duty": 0.0, "force": force, "record": f"r{i}"}))
    log, page = tmp_path / "long.parquet", tmp_path / "long.html"
    pd.concat(parts).to_parquet(log)
    erdctl("validate", TABLE_2, str(log), "--report", str(page))
    row = re.compile(r"^r\d+ 100 ", re.MULTILINE)
    sheets = [text for text in printed(browser, page, tmp_path) if row.search(text)]
    assert len(sheets) > 2
    for text in sheets:
        head = row.split(text)[0]
        assert all(word in head for word in ("record", "samples", "RMSE [N]", "NRMSE")), head


@pytest.mark.few(1)
@pytest.mark.parametrize(
    "name",
    [
        "worn",
        "proof",
        *(pytest.param(n, marks=pytest.mark.long) for n in ("rubbing", "campaign", "mimic")),
    ],
)
def test_no_table_is_parted_from_its_head(
    browser: Any, made: Made, name: str, tmp_path: Path
) -> None:
    """A caption or a head is never the last thing on a sheet."""
    page = browser.new_page()
    page.goto(made(name).as_uri())
    captions = [c.strip() for c in page.locator("caption").all_inner_texts()]
    page.close()
    sheets = printed(browser, made(name), tmp_path)
    for text in sheets:
        end = text.strip().splitlines()[-1].strip() if text.strip() else ""
        assert end not in captions
        assert not re.fullmatch(
            r"(?:PWM level|parameter|what|effect)(?: .*)?(?:NRMSE|value).*", end
        )


def printed(browser: Any, path: Path, folder: Path) -> list[str]:
    """The words on each sheet of A4."""
    page = browser.new_page()
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]", state="attached")
    page.pdf(path=folder / "page.pdf", format="A4", print_background=True)
    page.close()
    return [sheet.extract_text() for sheet in PdfReader(folder / "page.pdf").pages]


def test_the_scale_is_viridis() -> None:
    even = np.linspace(0.0, 1.0, len(style.HEAT))
    for stop, rgb in zip(style.HEAT, mpl.colormaps["viridis_r"](even), strict=True):
        assert style.hexadecimal(tuple(rgb[:3])) == stop

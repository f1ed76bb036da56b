"""`--report` as an option: names, places, and what the numbers of a page come from."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import subprocess
from collections.abc import Callable
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from pages import ERDCTL, TABLE_2, concealed, erdctl, mapped
from places import FIXTURES

from erdctl.export.serves import ONLINE, SERVES
from erdctl.export.targets import TARGETS
from erdctl.model.effect import Variable
from erdctl.report.page.data import Levels, misfit_maps, profile, samples
from erdctl.report.page.render import Run, digits
from erdctl.report.page.words import joined

LOG = str(FIXTURES / "schedule_60s.csv")


@pytest.mark.parametrize(
    "words",
    [
        ["validate", TABLE_2, LOG],
        ["diagnose", LOG, "-o", "d.json"],
        ["mimic", TABLE_2, LOG, "--fault", "oil=0.5"],
        ["prove", "--cases", "1"],
    ],
    ids=lambda words: words[0],
)
@pytest.mark.parametrize("path", ["page.txt", "nowhere/page.html"])
def test_a_wrong_name_is_refused_before_the_work(words: list[str], path: str) -> None:
    message = erdctl(*words, "--report", path, code=2)
    assert path in message
    assert message.count("\n") == 1
    assert not Path("d.json").exists()


def test_the_limit_decides_and_the_page_is_there(tmp_path: Path) -> None:
    page = tmp_path / "v.html"
    erdctl("validate", TABLE_2, LOG, "--fail-above", "1e-4", "--report", str(page), code=1)
    assert "above the limit of 0.0001" in page.read_text()


def test_a_map_of_units_reaches_the_page(tmp_path: Path) -> None:
    page = tmp_path / "v.html"
    maps = ["t=Time[ms]", "x=Defl FL[mm]", "force=F_fl[N]", "duty=PWM[%]"]
    erdctl("validate", TABLE_2, str(FIXTURES / "foreign.csv"), *mapped(maps), "--report", str(page))
    assert "Force [N]" not in page.read_text()  # units come from the axes, with the figures
    assert '"unit": "mm/s"' in page.read_text()


def test_the_same_command_makes_the_same_page(tmp_path: Path) -> None:
    page = tmp_path / "v.html"
    words = ["validate", TABLE_2, LOG, "--report", str(page)]
    erdctl(*words)
    first = page.read_bytes()
    erdctl(*words)
    assert page.read_bytes() == first


def test_maps_hold_the_misfit_of_their_cells() -> None:
    r = concealed()
    assert r.force is not None
    levels = Levels.of(r)
    misfit = np.where(r.x > 0, 2.0, np.nan)  # half of the samples have weight zero
    found = misfit_maps(r, levels, {"a": misfit}, noise=0.3)["a"]
    values, counts = np.array(found["values"]), np.array(found["counts"])
    assert counts.sum() == np.isfinite(misfit).sum()
    assert np.all(values[counts > 0] == 2.0)
    assert values.shape == (len(levels.duty), 25)
    assert found["most"] == 2.0
    assert found["y"]["names"][0] == "0 %"


def numbers(coded: dict[str, str]) -> np.ndarray:
    ((kind, text),) = coded.items()
    return np.frombuffer(base64.b64decode(text), dtype=f"<{kind}")


def test_profiles_hold_the_misfit_of_their_bins() -> None:
    xdot = np.linspace(-0.1, 0.1, 60_000)
    misfit = np.where(np.abs(xdot) < 0.01, 3.0, 1.0)
    found = profile(
        Variable.XDOT, xdot, {"model": misfit}, noise=1.0, region=(-0.01, 0.01, "47 %")
    )  # fmt: skip
    x, y = numbers(found["x"]["values"]), numbers(found["series"][0]["y"])
    assert x[0] == pytest.approx(-100)  # mm/s
    assert y[np.abs(x) < 6] == pytest.approx(3.0)
    assert y[np.abs(x) > 14] == pytest.approx(1.0)
    assert found["bands"] == [{"low": -10.0, "high": 10.0, "text": "47 %"}]
    assert found["x"]["unit"] == "mm/s"


def test_a_profile_over_few_levels_has_a_bin_for_each() -> None:
    duty = np.repeat([0.0, 0.1, 0.3, 0.1 + 0.2], 100)  # the last two differ by rounding only
    found = profile(Variable.DUTY, duty, {"model": 10 * duty}, noise=None)
    assert numbers(found["x"]["values"]) == pytest.approx([-5, 5, 5, 20, 20, 35])
    assert numbers(found["series"][0]["y"]) == pytest.approx([0, 0, 1, 1, 3, 3])


def test_what_comes_after_an_event_has_a_logarithmic_axis() -> None:
    since = np.concatenate([[np.inf, 0.0], np.geomspace(1e-3, 1.0, 5_000)])
    found = profile(Variable.SINCE_REVERSAL, since, {"model": np.ones(5_002)}, noise=None)
    x = numbers(found["x"]["values"])
    assert found["x"]["log"] is True
    assert (x[0], x[-1]) == (pytest.approx(1.0), pytest.approx(1e3))  # ms


def test_loops_offer_records_with_the_worst_first() -> None:
    r = concealed()
    assert r.force is not None
    model = r.force.copy()
    part = r.slices[4]
    model[part] += 5.0
    choices = samples(r, Levels.of(r), {"before": model})["choices"]
    singles = [c for c in choices if c["records"] and len(c["records"]) == 1]
    assert singles[0]["records"] == [4]
    assert singles[0]["name"] == f"{r.names[4]}: 5 N rms"
    typical = next(c for c in choices if "each PWM level" in c["name"])
    assert all(np.ptp(r.duty[r.slices[i]]) == 0 for i in typical["records"])


def test_the_library_is_the_published_one() -> None:
    assets = resources.files("erdctl.report.page") / "assets"
    digest = hashlib.sha256((assets / "d3.min.js").read_bytes()).hexdigest()
    assert digest in (assets / "README.md").read_text()
    assert "Permission to use, copy" in (assets / "d3.LICENSE").read_text()


def test_words() -> None:
    assert joined(["a", "b", "c"]) == "a, b and c"
    assert [digits(v) for v in (0.25, 32659.0, -1.5, None)] == ["0.25", "32660", "−1.5", "–"]
    assert digits(-5.4e-8, 2) == "−5.4×10⁻⁸"
    assert Run(words=["validate", "a b.csv"]).command == "erdctl validate 'a b.csv'"
    assert json.dumps(Run(words=[]).rows[0]) == '["erdctl", "0.1.0"]'


def _one_line(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["worn", "validation"])
def test_where_an_export_goes_in_the_words_of_the_help(
    made: Callable[[str], Path], name: str
) -> None:
    page = html.unescape(made(name).read_text(encoding="utf-8"))
    section = page.partition('<section id="export"')[2].partition("</section>")[0]
    assert '<a href="#export">' in page
    words = [*ERDCTL, "export", "--help"]
    said = _one_line(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    assert SERVES.keys() == TARGETS.keys()
    for suffix, serves in SERVES.items():
        assert suffix in section
        assert f'<td class="words">{serves}</td>' in section
        assert serves in said
    assert ONLINE in section
    assert ONLINE in said
    for program in ("dSPACE", "Simulink", "multibody"):
        assert program in section

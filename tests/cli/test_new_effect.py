"""`erdctl effects new`: from a learned law to the file of an effect."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from rig import TRUTH, campaign, gas_that_warms, noisy
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.io.documents import encode
from erdctl.io.effect_file import LONGEST, effect_source
from erdctl.io.effect_test_file import motion
from erdctl.io.effect_test_file import test_source as effect_test_source
from erdctl.io.parameters import to_document
from erdctl.model.composed import Model, off_values
from erdctl.model.effect import Effect
from erdctl.model.learned.coordinates import KINDS
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.forms import FORMS
from erdctl.model.learned.law import Law, LawSlot
from erdctl.model.learned.surface import Surface
from erdctl.model.parameters import Estimate, Parameters

LOG = campaign(100.0, 4.0)
STIFFNESS, TAU = 500.0, 0.25
BORE = Law(LawSlot.VISCOUS, Curve("passes", (0.0, 9.0), "saturation"))
KNOTS = (-0.02, -0.01, 0.0, 0.01, 0.02)


def command(*words: str) -> tuple[int, str]:
    done = CliRunner().invoke(build(["effects"]), ["effects", *words])
    return done.exit_code, done.stderr


def parameters(*laws: Law) -> Parameters:
    """Table 2 with laws, each of their parameters off its start."""
    model = Model(tuple(law.effect for law in laws))
    values = {**TRUTH, **{e.key(q.symbol): 0.9 * q.start + 0.05 * (q.start == 0.0)
                          for e in model.effects for q in e.quantities}}  # fmt: skip
    estimates = {n: Estimate(value=values[n], unit=q.unit) for n, q in model.quantities.items()}
    return Parameters(model=model, estimates=estimates)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("bore.json").write_bytes(encode(to_document(parameters(BORE))))
    return tmp_path


@pytest.mark.few(40)
@pytest.mark.parametrize(
    "form", [None, *(pytest.param(f, marks=pytest.mark.untraced) for f in FORMS)]
)
@pytest.mark.parametrize("slot", LawSlot)
def test_the_file_acts_as_the_law(slot: LawSlot, form: str | None) -> None:
    """Over every coordinate: the same force, bit for bit, and exactly absent when off."""
    log = LOG.select([0, 4, 8])  # null control, a held level, steps: there are thousands of laws
    signals = Signals.of(replace(log, temperature=log.x + 0.01))
    for kind in KINDS:
        knots = KNOTS if form is None else (KNOTS[0], KNOTS[-1])
        law = Law(slot, Curve(kind, knots, form, zero_first=form is None and not slot.adds))
        given = parameters(law)
        text = effect_source("named", law.effect, given.values, "a log")
        assert max(map(len, text.splitlines())) <= 100
        names: dict[str, Any] = {}
        exec(compile(text, "named.py", "exec"), names)
        effect = names["EFFECT"]
        assert isinstance(effect, Effect)
        values = {n.replace(law.effect.name + ".", "named."): v for n, v in given.values.items()}
        model = Model((effect,))
        expected = Model((law.effect,)).force(signals, given.values)
        assert np.array_equal(model.force(signals, values), expected)
        off = model.force(signals, {**TRUTH, **off_values(model)})
        assert np.array_equal(off, Model().force(signals, TRUTH))


@pytest.mark.parametrize("slot", LawSlot)
def test_no_line_is_too_long_and_no_import_unused(slot: LawSlot) -> None:
    """With the longest name there may be, the most digits and the most words."""
    name, seconds = "n" * LONGEST, (1 / 3, 2 / 3, 4 / 3)
    across = Curve("field_travel", seconds)
    surface = Surface("ringing_field", (-1 / 3, 1 / 7, 2 / 3), zero_first=True, across=across)
    many = tuple(k / 7 for k in range(1, 9))
    for law in (Law(slot, surface), Law(slot, Curve("path_since_reversal", many, None, True))):
        given = parameters(law)
        text = effect_source(name, law.effect, given.values, "a log")
        for source in (text, effect_test_source(name, law.effect, given)):
            assert max(map(len, source.splitlines())) <= 100
            imported = re.findall(r"^from [\w.]+ import (.+)$", source, re.MULTILINE)
            for each in ", ".join(imported).split(", "):
                assert each == "annotations" or len(re.findall(rf"\b{each}\b", source)) > 1


@pytest.mark.parametrize("kind", [k for k in KINDS if not KINDS[k].sides])
def test_its_test_is_on_a_motion_on_which_it_acts(kind: str) -> None:
    """A time constant does nothing where a step of the motion is many of them."""
    low, high = (20.0, 60.0) if kind == "temperature" else (0.0, 0.5)
    law = Law(LawSlot.LAG, Curve(kind, (low, high), "line"))
    given = parameters(law)
    shown = motion(law.effect, given.values)
    force = Model((law.effect,)).force(shown, given.values)
    assert np.ptp(force - Model().force(shown, TRUTH)) > 1e-6 * np.ptp(force)


def test_from_parameters_or_from_a_diagnosis(folder: Path) -> None:
    code, said = command("new", "bore_wear", "--from", "bore.json")
    assert code == 0
    assert "wrote bore_wear.py and test_bore_wear.py" in said
    assert 'bore_wear = "bore_wear:EFFECT"' in said
    diagnosis = {"schema": "erdctl.diagnosis/1",
                 "corrected": {"params": json.loads(Path("bore.json").read_text())}}  # fmt: skip
    Path("d.json").write_text(json.dumps(diagnosis))
    there = Path("there")
    there.mkdir()
    assert command("new", "bore_wear", "--from", "d.json", "-o", "there/bore_wear.py")[0] == 0
    first, second = (p.read_text().replace("bore.json", "d.json").splitlines()
                     for p in (Path("bore_wear.py"), there / "bore_wear.py"))  # fmt: skip
    assert [a for a in first if "sha256" not in a] == [b for b in second if "sha256" not in b]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("new",), "write it as"),
        (("new", "bore_wear"), "write it as"),
        (("new", "bore_wear", "--from", "none.json"), "no such file"),
        (("new", "Bore", "--from", "bore.json"), "small letters"),
        (("new", "class", "--from", "bore.json"), "small letters"),
        (("new", "dict", "--from", "bore.json"), "Python has that name"),
        (("new", "annotations", "--from", "bore.json"), "Python has that name"),
        (("new", "array", "--from", "bore.json"), "would hide a module"),
        (("new", "numpy", "--from", "bore.json"), "would hide a module"),
        (("new", "test_bore", "--from", "bore.json"), "for a test"),
        (("new", 51 * "a", "--from", "bore.json"), "at most 50 characters, found 51"),
        (("new", "backlash", "--from", "bore.json"), "the catalogue has"),
        (("new", "bore_wear", "--from", "bore.json", "-o", "other.py"), "has its name"),
        (("new", "bore_wear", "--from", "bore.json", "--law", "2"), "has 1"),
        (("new", "bore_wear", "--from", "plain.json"), "no learned law"),
        (("new", "bore_wear", "--from", "two.json"), "choose one by --law"),
        (("new", "there", "--from", "bore.json"), "is there already"),
        (("backlash", "--from", "bore.json"), "go with"),
        (("backlash", "play"), "go with"),
    ],
)
def test_what_is_refused_writes_nothing(folder: Path, words: tuple[str, ...], says: str) -> None:
    other = Law(LawSlot.FORCE, Curve("x", KNOTS))
    Path("plain.json").write_bytes(encode(to_document(parameters())))
    Path("two.json").write_bytes(encode(to_document(parameters(BORE, other))))
    Path("test_there.py").write_text("mine")
    before = sorted(folder.iterdir())
    code, said = command(*words)
    assert code == 2
    assert says in said
    assert len(said.splitlines()) == 1
    assert sorted(folder.iterdir()) == before
    assert Path("test_there.py").read_text() == "mine"


def test_the_name_of_a_file_is_no_code(folder: Path) -> None:
    name = 'a""" + raise_() + """\\.json'
    Path("bore.json").rename(name)
    assert command("new", "bore_wear", "--from", name)[0] == 0
    names: dict[str, Any] = {}
    exec(compile(Path("bore_wear.py").read_text(), "bore_wear.py", "exec"), names)
    assert "Learned from a___ + raise_() + ____.json" in names["__doc__"]


def test_a_law_is_chosen(folder: Path) -> None:
    other = Law(LawSlot.FORCE, Curve("x", KNOTS))
    Path("two.json").write_bytes(encode(to_document(parameters(BORE, other))))
    assert command("new", "stop", "--from", "two.json", "--law", "2")[0] == 0
    assert 'Curve("x"' in Path("stop.py").read_text()


def log_of(r: Recording, path: Path) -> str:
    columns = {"t": r.t, "x": r.x, "xdot": r.xdot, "duty": r.duty, "force": r.force}
    table = pd.DataFrame(columns).assign(record=np.repeat(r.names, np.diff(r.starts)))
    table.to_parquet(path, index=False)
    return str(path)


@pytest.mark.long
def test_from_learned_to_named(tmp_path: Path) -> None:
    """A law learned in one log is written, declared by a package, and named in another log."""
    logs = [noisy(gas_that_warms(campaign(100.0, 5.0), STIFFNESS, TAU), seed=s) for s in (31, 32)]
    first, second = (log_of(r, tmp_path / f"{i}.parquet") for i, r in enumerate(logs))
    package = tmp_path / "package"
    about = package / "warm_gas-1.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: warm_gas\nVersion: 1\n")
    (about / "entry_points.txt").write_text("[erdctl.effects]\nwarm_gas = warm_gas:EFFECT\n")
    path = os.pathsep.join([str(package), *sys.path])

    def run(*words: str) -> str:
        done = subprocess.run(
            [sys.executable, *words], cwd=tmp_path, env={**os.environ, "PYTHONPATH": path},
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        return done.stderr

    few = "coulomb_friction,fluid_inertia"
    run("-m", "erdctl", "diagnose", first, "--effects", few, "-o", "d.json", "--jobs", "1")
    assert json.loads((tmp_path / "d.json").read_text())["verdict"] == "unexplained"
    # Before it is declared: a name of the catalogue is taken.
    (about / "entry_points.txt").rename(about / "later.txt")
    run("-m", "erdctl", "effects", "new", "warm_gas", "--from", "d.json",
        "-o", "package/warm_gas.py")  # fmt: skip
    (about / "later.txt").rename(about / "entry_points.txt")
    run("-m", "pytest", "-q", "-p", "no:cacheprovider", "--no-cov", "package/test_warm_gas.py")
    few += ",warm_gas"
    run("-m", "erdctl", "diagnose", second, "--effects", few, "-o", "e.json", "--jobs", "1")
    found = json.loads((tmp_path / "e.json").read_text())
    assert found["verdict"] == "explained"
    assert [f["effect"] for f in found["findings"]] == ["warm_gas"]
    tau = found["findings"][0]["parameters"]["tau"]["value"]
    assert tau == pytest.approx(TAU, rel=0.03)

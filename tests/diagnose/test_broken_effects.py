"""A broken effect ends a diagnosis with its file and a reason; it is never taken for absent."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from places import ROOT
from rig import campaign, noisy

from erdctl.io.tables import write_table

HEAD = '''"""An effect as a stranger may write it."""
import numpy as np
from erdctl.core.quantity import Quantity
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ControlSlot, ScaleSlot, TermSlot, YieldSlot

def effect(slot, **more):
    return Effect(
        name="broken", stage=Stage.FLUID, slot=slot, title="t", equation="e", source="s",
        validity="v", requires=(), shows=Variable.X,
        quantities=(Quantity(symbol="a", unit="1", title="a", low=0.0, high=9.0, start=1.0),),
        **more,
    )
'''
BROKEN = {
    "a wrong shape": (
        """
def law(s, p):
    return {"yield": np.ones(3)}
EFFECT = effect(ScaleSlot(law))
""",
        r"broken.py, line \d+, law: returned an array of shape \(3,\) for group yield, expected",
    ),
    "another group": (
        """
def law(s, p):
    return {"yields": np.ones(len(s))}
EFFECT = effect(ScaleSlot(law))
""",
        r"broken.py, line \d+, law: returned .* expected factors of some of gas, viscous, yield",
    ),
    "a failed linear solve": (
        """
def law(s, p):
    return np.linalg.solve(np.zeros((2, 2)), np.ones(2))
EFFECT = effect(ControlSlot(law))
""",
        r"broken.py, line \d+, law: LinAlgError: Singular matrix",
    ),
    "a plain error": (
        """
def law(force, s, p):
    raise ValueError("only one value at a time")
EFFECT = effect(YieldSlot(law))
""",
        r"broken.py, line \d+, law: ValueError: only one value at a time",
    ),
    "not finite": (
        """
def law(s, p):
    return s.duty / np.where(s.duty > 0, p["a"], np.nan)
EFFECT = effect(ControlSlot(law))
""",
        r"broken.py, line \d+, law: returned float64 values that are not all finite",
    ),
    "a function as a start": (
        """
def law(s, p):
    return {"yield": np.full(len(s), 1.0 + p["a"])}
def starts(s, rest):
    return [{"a": lambda: 1.0}]
EFFECT = effect(ScaleSlot(law), guesses=starts)
""",
        r"broken.py, line \d+, starts: gave function .* expected a finite number",
    ),
    "a function that no process can be sent": (
        """
EFFECT = effect(ScaleSlot(lambda s, p: {"yield": np.full(len(s), 1.0 / (1.0 + p["a"]))}))
""",
        r"effect broken: cannot be sent to a worker process .*top level of its file",
    ),
    "no effect": ("EFFECT = 3\n", r"broken.py: EFFECT is int, expected an Effect"),
    "a file that does not load": (
        "EFFECT = effect(ControlSlot(nothing))\n",
        r"broken.py: NameError: name 'nothing' is not defined",
    ),
}


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    import pyarrow as pa

    r = noisy(campaign(100.0, 6.0), seed=4)
    path = tmp_path_factory.mktemp("log") / "log.parquet"
    columns = {name: getattr(r, name) for name in ("t", "x", "xdot", "duty", "force")}
    write_table(pa.table(columns | {"record": np.repeat(r.names, np.diff(r.starts))}), str(path))
    return path


# In one process a function without a name works.
CASES = [(h, j) for h in BROKEN for j in ("1", "2") if not (j == "1" and "process" in h)]


@pytest.mark.few(4)
@pytest.mark.parametrize(("how", "jobs"), CASES)
def test_it_ends_with_its_file_and_a_reason(how: str, jobs: str, log: Path, tmp_path: Path) -> None:
    text, expected = BROKEN[how]
    (tmp_path / "broken.py").write_text(HEAD + text)
    info = tmp_path / "broken-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: broken\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[erdctl.effects]\nbroken = broken:EFFECT\n")
    done = subprocess.run(
        [sys.executable, "-m", "erdctl", "diagnose", str(log), "--jobs", jobs,
         "--effects", "broken,coulomb_friction"],
        capture_output=True, text=True, cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])},
    )  # fmt: skip
    assert done.returncode == 4, done.stderr
    assert done.stdout == ""
    line = done.stderr.strip().splitlines()[-1]
    assert re.search(expected, line), line
    assert "Traceback" not in done.stderr

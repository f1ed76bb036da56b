"""Dampers of the literature (`tests/literature_dampers.py`), diagnosed under one kind of drive and
asked for both kinds, other drives than those fitted; beside an expert's models and black boxes
(`tests/peers.py`), which are fitted to the same. By hand:

    PYTHONPATH=.:tests python tests/diagnose/measure_literature_dampers.py FIRST END [NAME ...]

With `measured` among the names logs have a deflection of 12 bits and no velocity.
NRMSE over the range of the force of the drive that is asked for, whose noise is in it, without the
first second of each record: what was before it no model knows.
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import literature_dampers
import numpy as np
import pandas as pd
from peers import black_boxes, expert, of_model

from erdctl.core.recording import Array, Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs


def read(table: pd.DataFrame) -> Recording:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "log.parquet"
        table.to_parquet(file)
        return read_logs([str(file)], need_force=True, report=lambda line: None).recording


def error(r: Recording, force: Array) -> float:
    assert r.force is not None
    later = r.t >= np.repeat(r.t[r.starts[:-1]], np.diff(r.starts)) + 1.0
    rms = float(np.sqrt(np.mean((r.force - force)[later] ** 2)))
    return rms / float(np.ptp(r.force))


def row(name: str, seed: int, *, random: bool, measured: bool = False) -> str:
    fitted = read(literature_dampers.log(name, seed, random=random, measured=measured))
    found = diagnose(fitted, catalogue(), limits=False)
    end = found.selection if found.learned is None else found.learned.selection
    laws = [law.law.name for law in found.learned.laws] if found.learned is not None else []
    said = "; ".join([", ".join(f.effect.name for f in found.findings), *laws])
    lines = [f"{name} {seed} {'rides' if random else 'sines'}: {found.verdict.value} [{said}]"]
    for other in (True, False):
        held = read(literature_dampers.log(name, seed, random=other, drive=1, measured=measured))
        by_hand, force = expert(fitted, held)
        boxes = black_boxes(fitted, held, found.selection.base).items()
        lines.append(
            f"  on {'rides' if other else 'sines'}:"
            f" paper's {error(held, of_model(found.selection.base, held)):.4f}"
            f"  diagnose {error(held, of_model(end.best, held)):.4f}"
            f"  expert {error(held, force):.4f} ({by_hand})  "
            + "  ".join(f"{n} {error(held, f):.4f}" for n, f in boxes)
        )
    return "\n".join(lines)


def main(first: int, end: int, *names: str) -> None:
    warnings.simplefilter("ignore")  # networks that have not converged
    measured = "measured" in names
    asked = [name for name in names if name != "measured"] or literature_dampers.DAMPERS
    for seed in range(first, end):
        for name in asked:
            for random in (True, False):
                print(row(name, seed, random=random, measured=measured), flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), *sys.argv[3:])

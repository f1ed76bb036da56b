"""Error removed on fresh records, all of them and those within the range of the log. By hand:

python tests/prove/measure_range.py DIR...

Fresh records go beyond the log: up to twice its deflection, speed and duty cycle. A curve through
knots is held at its end there, by design; a closed form goes on, as the hidden law does. DIR is
what `erdctl prove --keep DIR` left; of its cases those outside the catalogue are taken.
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import erdctl

BEYOND = 1.02  # of the largest value in the log, which noise alone exceeds a little
CHANNELS = ["x", "xdot", "duty"]


def case(folder: Path, result: dict[str, Any], work: Path) -> dict[str, Any]:
    """Shares of the rms error of the paper's model that the corrected one removes."""
    name = f"case-{result['number']:03d}"
    log, fresh = (pd.read_parquet(folder / part / f"{name}.parquet") for part in ("logs", "fresh"))
    document = json.loads((folder / "diagnoses" / f"{name}.json").read_text())
    missed = []
    for which in ("baseline", "corrected"):
        params = work / f"{which}.json"
        params.write_text(json.dumps(document[which]["params"]))
        force = erdctl.simulate(params, folder / "fresh" / f"{name}.parquet").force
        missed.append(np.asarray(force) - fresh["force"].to_numpy())
    most = fresh.groupby("record")[CHANNELS].agg(lambda v: v.abs().max())
    inside = most[(most <= BEYOND * log[CHANNELS].abs().max()).all(axis=1)].index
    rows = fresh["record"].isin(inside).to_numpy()
    return {
        "effect": result["hidden"][0]["effect"], "level": result["level"],
        "learned": bool(result["learned"]), "right": result["lies"],
        "all": removed(missed), "inside": removed([m[rows] for m in missed]) if any(rows) else None,
    }  # fmt: skip


def removed(missed: list[np.ndarray[Any, Any]]) -> float:
    before, after = (float(np.sqrt(np.mean(m**2))) for m in missed)
    return 1.0 - after / before


def line(what: str, cases: pd.DataFrame) -> str:
    inside, right = cases["inside"].dropna().astype(float), cases["right"].dropna()
    return (
        f"| {what} | {len(cases)} | {cases['learned'].sum()} | {sum(right)} of {len(right)}"
        f" | {100 * cases['all'].median():.0f} % | {100 * inside.median():.0f} % ({len(inside)})"
        f" | {(cases['all'] < -0.02).sum()}, {(inside < -0.02).sum()} |"
    )


def main(folders: list[str]) -> None:
    found = []
    with tempfile.TemporaryDirectory() as work:
        for folder in map(Path, folders):
            for path in sorted((folder / "results").glob("case-*.json")):
                result = json.loads(path.read_text())
                if result["kind"] == "unknown":
                    found.append(case(folder, result, Path(work)))
    cases = pd.DataFrame(found)
    print(
        "| misfit over noise | cases | learned | right slot and coordinate"
        " | error removed, median | within the range of the log (cases) | worse |"
    )
    print("|---|---|---|---|---|---|---|")
    for low, high in ((2.0, np.inf), (1.0, 2.0), (0.0, 1.0)):
        part = cases[(cases["level"] >= low) & (cases["level"] < high)]
        if len(part):
            print(line(f"{low:g} to {high:g}", part))
    if cases["learned"].any():
        print(line("with something learned", cases[cases["learned"]]))
    for effect, part in cases.groupby("effect"):
        print(line(str(effect), part))


if __name__ == "__main__":
    main(sys.argv[1:])

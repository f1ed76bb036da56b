"""Coverage of 95 % intervals, by hand, at a tenth of a second to two a reading:

    PYTHONPATH=. python tests/prove/measure_coverage.py run RESULTS EFFECTS FIRST:END [KIND=TIMES..]
    PYTHONPATH=. python tests/prove/measure_coverage.py table RESULTS...

EFFECTS are names with commas between, or `all`; `paper` is the paper's model alone. Each seed is a
damper, and the seed END is not drawn. RESULTS has one JSON object a reading in each line: further
runs add lines, and what is in it is not read again.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from erdctl.plant.noise import DISTURBANCES
from erdctl.plant.twins import every
from erdctl.prove.coverage import Held, conceal, read

PAPER = "paper"


def effects_of(given: str) -> list[str]:
    if given != "all":
        return given.split(",")
    return [PAPER, *(name for name, twin in every().items() if twin.law is not None)]


def run(results: str, effects: str, seeds: str, *kinds: str) -> None:
    times = {k: int(n) for k, _, n in (kind.partition("=") for kind in kinds)}
    times = times or dict.fromkeys(DISTURBANCES, 1)
    done = {key_of(row) for row in rows_of([results])} if Path(results).exists() else set()
    first, end = map(int, seeds.split(":"))
    with Path(results).open("a", encoding="utf-8") as file:
        for effect in effects_of(effects):
            for seed in range(first, end):
                asked = [(k, n) for k, count in times.items() for n in range(count)]
                asked = [(k, n) for k, n in asked if (effect, k, seed, n) not in done]
                if not asked:
                    continue
                damper = conceal("" if effect == PAPER else effect, seed)
                for kind, n in asked:
                    held = {h.parameter: entry(h) for h in read(damper, kind, n)}
                    row = {"effect": effect, "kind": kind, "seed": seed, "number": n, "held": held}
                    file.write(json.dumps(row) + "\n")
                    file.flush()
            print(
                line(effect, [r for r in rows_of([results]) if r["effect"] == effect]), flush=True
            )


def entry(h: Held) -> dict[str, Any]:
    e = h.estimate
    return {
        "truth": h.truth, "value": e.value, "stderr": e.stderr, "interval": e.interval,
        "bound": e.at_bound, "inside": h.inside,
    }  # fmt: skip


def key_of(row: dict[str, Any]) -> tuple[str, str, int, int]:
    return row["effect"], row["kind"], row["seed"], row["number"]


def rows_of(files: Iterable[str]) -> list[dict[str, Any]]:
    """Every reading once."""
    texts = (Path(f).read_text(encoding="utf-8").splitlines() for f in files)
    rows = [json.loads(text) for lines in texts for text in lines]
    return list({key_of(row): row for row in rows}.values())


def line(name: str, rows: list[dict[str, Any]], parameter: str | None = None) -> str:
    held = [h for r in rows for p, h in r["held"].items() if parameter in (None, p)]
    known = [h for h in held if h["inside"] is not None]
    off = [(h["value"] - h["truth"]) / h["stderr"] for h in known if h["stderr"]]
    share = f"{100 * np.mean([h['inside'] for h in known]):5.1f} %" if known else "   -   "
    more = f", {len(held) - len(known):3} without" if len(held) > len(known) else ""
    spread = f"; off by {np.mean(off):+.2f} +- {np.std(off):.2f}" if off else ""
    return f"{name:44} {share} of {len(known):4}{more}{spread}"


def table(*files: str) -> None:
    rows = rows_of(files)
    by: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for row in rows:
        by[row["effect"]].append(row)
    for effect, mine in by.items():
        print(line(effect, mine))
        for kind in DISTURBANCES:
            some = [r for r in mine if r["kind"] == kind]
            if some:
                print(line(f"  {kind}, {len(some)} readings", some))
        for parameter in dict.fromkeys(p for r in mine for p in r["held"]):
            if effect == PAPER or not parameter.startswith(("compression", "release")):
                print(line(f"    {parameter}", mine, parameter))
    for kind in DISTURBANCES:
        print(line(f"pooled, {kind}", [r for r in rows if r["kind"] == kind]))
    print(line(f"pooled, {len(rows)} readings", rows))


if __name__ == "__main__":
    {"run": run, "table": table}[sys.argv[1]](*sys.argv[2:])

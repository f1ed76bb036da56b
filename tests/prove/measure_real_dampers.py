"""Real dampers, fitted on some records and tested on others: what `diagnose` finds, what an expert
would write by hand, and what black boxes learn (`tests/peers.py`). By hand:

    PYTHONPATH=.:tests python tests/prove/measure_real_dampers.py ../shared/data LOG:TEXT ...

LOG:TEXT holds out the records with TEXT in their names, LOG: alone the last fifth of each record;
then also with a gain and a zero that each record had in its first four. NRMSE over the range of the
held-out force.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from peers import black_boxes, error, expert, of_model

from erdctl.core.blocks import thinned
from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs

MOST = 20_000  # samples of a diagnosis
FIFTH = 0.2


def load(path: Path) -> Recording:
    return read_logs([str(path)], need_force=True, report=lambda line: None).recording


def split(r: Recording, text: str) -> tuple[Recording, Recording]:
    """What is fitted and what is held out."""
    if text:
        held = [i for i, name in enumerate(r.names) if text in name]
        assert 0 < len(held) < len(r.names), f"{text!r} is in {len(held)} of {r.names}"
        return r.select([i for i in range(len(r.names)) if i not in held]), r.select(held)
    last = np.zeros(len(r), dtype=bool)
    for part in r.slices:
        last[part.stop - round(FIFTH * (part.stop - part.start)) : part.stop] = True
    rows = (np.flatnonzero(~last), np.flatnonzero(last))
    first, second = (r.take(k, np.searchsorted(k, r.starts), r.names) for k in rows)
    return first, second


def with_levels(best: Hypothesis, fitted: Recording, held: Recording) -> float:
    """Error of a model with the gain and the zero that each record had where it was fitted."""
    before, after = of_model(best, fitted), of_model(best, held)
    assert fitted.force is not None
    for one, other in zip(fitted.slices, held.slices, strict=True):
        line = np.polyfit(before[one], fitted.force[one], 1)
        after[other] = np.polyval(line, after[other])
    return error(held, after)


def row(folder: Path, log: str, text: str) -> str:
    fitted, held = split(load(folder / f"{log}.parquet"), text)
    found = diagnose(thinned(fitted, MOST), catalogue(), limits=False)
    end = found.selection if found.learned is None else found.learned.selection
    ours = error(held, of_model(end.best, held))
    name, by_hand = expert(fitted, held)
    boxes = {n: error(held, f) for n, f in black_boxes(fitted, held, found.selection.base).items()}
    paper = error(held, of_model(found.selection.base, held))
    known = "" if text else f" ({with_levels(end.best, fitted, held):.4f} with levels)"
    names = ", ".join(f.effect.name for f in found.findings)
    laws = found.learned.laws if found.learned is not None else ()
    said = "; ".join([names, *(law.law.name for law in laws)])
    others = "  ".join(f"{n} {e:.4f}" for n, e in boxes.items())
    return (
        f"{log} without {text or 'the last fifth of each record'}: paper's {paper:.4f}  "
        f"diagnose {ours:.4f}{known} [{said}; {found.verdict.value}]  "
        f"expert {error(held, by_hand):.4f} ({name})  {others}"
    )


def main(arguments: Sequence[str]) -> None:
    folder = Path(arguments[0])
    for given in arguments[1:]:
        log, _, text = given.partition(":")
        print(row(folder, log, text), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])

"""False alarms: plain dampers under many kinds of noise and rig error, in which nothing is hidden.

Each null also tells how far every statistic goes that decides, so that its threshold can be held
against what noise alone reaches.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.workers import pool
from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare, critical_of
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.findings import Finding
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.diagnose.sets_in_once import ratio_of_once
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs
from erdctl.prove.score import EXTRA

Table = tuple[str, Sequence[str], Sequence[Sequence[str]]]


@dataclass(frozen=True)
class NullResult:
    """One null.

    kind : of noise or rig error;  only_noise : whether a right model leaves only noise
    named : effects that are wrong for this kind;  rig : codes of what the rig checks said
    measures : the largest statistics, by the names of their thresholds
    learned : whether a law was learned of what is none
    """

    seed: int
    kind: str
    only_noise: bool
    verdict: str
    named: tuple[str, ...]
    rig: tuple[str, ...]
    measures: Mapping[str, float]
    learned: bool = False

    @property
    def adequate(self) -> bool:
        """Whether it was found that nothing is missing."""
        return self.verdict == Verdict.ADEQUATE.value

    @property
    def line(self) -> str:
        """The null in one line."""
        said = " + ".join((*self.named, *["a law"] * self.learned)) or "nothing"
        rig = f"  rig {', '.join(self.rig)}" if self.rig else ""
        return f"seed {self.seed}  {self.kind}  named {said}  {self.verdict}{rig}"


def examine(seed: int) -> NullResult:
    """Draw a null, write its log, and diagnose that file."""
    import pyarrow.parquet as pq

    from erdctl.plant.nulls import draw_null

    null = draw_null(seed)
    with TemporaryDirectory(prefix="erdctl-") as folder:
        path = Path(folder) / "log.parquet"
        pq.write_table(null.table, path)
        log = read_logs([os.fspath(path)], need_force=True, report=lambda line: None)
    run = partial(diagnose, candidates=catalogue(), limits=False)
    found = with_a_fault_once(run, log.recording)
    wrong = [f.effect.name for f in found.findings if not _is_right(f, null.kind.right)]
    wrong += [f"{found.once.effect.name} once"] if found.once else []
    return NullResult(
        seed,
        null.name,
        null.kind.only_noise,
        found.verdict.value,
        tuple(wrong),
        tuple(dict.fromkeys(f.code for f in found.rig.faults)),
        measures(found),
        found.learned is not None,
    )


def _is_right(finding: Finding, right: Sequence[str]) -> bool:
    """As in a proof: by its name, or as one of three look-alikes at most."""
    alike = finding.equivalent if len(finding.equivalent) <= EXTRA else ()
    return not {finding.effect.name, *alike}.isdisjoint(right)


def measures(found: Diagnosis) -> dict[str, float]:
    """The largest statistics of single effects over the model to answer for, and of the rest."""
    base, out = found.selection.base, dict(found.lack_of_fit.measures)
    # A log that was thinned for the search has no residuals to compare with these.
    singles = [h for h in found.selection.singles if len(h.residual) == len(base.residual)]
    compared = [compare(found.problem, base, h) for h in singles]
    worth = [c for c in compared if c.gain > thresholds.LEAST_GAIN]
    out["T_STRETCHES"] = max((c.t_stretches for c in worth), default=0.0)
    out["T_GROUPS"] = max((c.t_groups for c in worth), default=0.0)
    out["Z_ENERGY"] = max((c.energy.z for c in worth), default=0.0)
    out["T_PLACES"] = max((c.energy.groups.t for c in worth), default=0.0)
    out["LEAST_GAIN"] = max((c.gain for c in compared), default=0.0)
    out["ONCE_RATIO"] = ratio_of_once(found.selection.best, catalogue())
    out["critical"] = critical_of(found.problem, base, singles)
    return out


def nulls(
    seeds: Sequence[int], *, jobs: int, on_result: Callable[[NullResult], None]
) -> list[NullResult]:
    """The nulls of some seeds; `on_result` is called with each as it comes."""
    out: list[NullResult] = []
    with pool(jobs) as workers:
        for future in as_completed([workers.submit(examine, seed) for seed in seeds]):
            on_result(future.result())
            out.append(future.result())
    return sorted(out, key=lambda r: r.seed)


def tables(results: Sequence[NullResult]) -> Iterator[Table]:
    """By kind: how many named something wrong, and were not adequate; then the statistics."""
    kinds = list(dict.fromkeys(r.kind for r in results))
    rows = [_row(kind, [r for r in results if r.kind == kind]) for kind in kinds]
    noise = [r for r in results if r.only_noise]
    rows += [_row("all", results), _row("all that is only noise", noise)]
    yield "False alarms, by kind", ["", "nulls", "named", "learned", "not adequate", "seeds"], rows
    names = dict.fromkeys(n for r in noise for n in r.measures)
    yield (
        "Statistics of the best single effect and of the rest, over what is only noise",
        ["", "threshold", "median", "95 %", "largest", "beyond"],
        [_statistic(n, np.array([r.measures.get(n, 0.0) for r in noise])) for n in names],
    )


def _row(label: str, results: Sequence[NullResult]) -> list[str]:
    wrong = [r for r in results if r.named or r.learned or (r.only_noise and not r.adequate)]
    count = max(len(results), 1)
    named, learned = sum(bool(r.named) for r in results), sum(r.learned for r in results)
    off = sum(not r.adequate for r in results)
    share = [f"{n} ({100 * n / count:.1f} %)" for n in (named, learned, off)]
    return [label, str(len(results)), *share, " ".join(str(r.seed) for r in wrong)]


def _statistic(name: str, values: Array) -> list[str]:
    threshold = getattr(thresholds, name, None)
    figures = [f"{v:.3g}" for v in (np.median(values), np.quantile(values, 0.95), values.max())]
    if threshold is None:
        return [name, "-", *figures, "-"]
    return [name, f"{threshold:g}", *figures, str(int(np.sum(values > threshold)))]

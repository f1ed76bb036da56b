"""Campaigns by hand: how long they take, what they move, and that nothing disturbs their table.

    PYTHONPATH=. python tests/campaign/measure_campaign.py time 20 10       # 200 logs, 2 workers
    PYTHONPATH=. python tests/campaign/measure_campaign.py time 20 100      # 2,000 logs
    PYTHONPATH=. python tests/campaign/measure_campaign.py kill 20 10 50    # kill -9, 50 times
    PYTHONPATH=. python tests/campaign/measure_campaign.py cluster 20 10    # 3 workers, one killed

On a machine that does other things, too, the CPU times say more than the wall's.
"""

from __future__ import annotations

import json
import os
import random
import resource
import sys
import time
from collections import defaultdict
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

import fleet
from campaigns import begun, entries, rows, run
from dask_workers import DaskWorkers

ABOVE = "0.01"  # NRMSE: three times what a sound damper has
WORKERS = 2


def labs(folder: Path, dampers: int, months: int, names: tuple[str, ...]) -> list[Path]:
    """Folders with the same logs."""
    fleet.write(folder / "lab", dampers, months)
    out = []
    for name in names:
        (folder / name).mkdir()
        (folder / name / "lab").symlink_to(folder / "lab")
        out.append(folder / name)
    return out


def timed(where: Path) -> None:
    """Two workers against half the sum of the single runs, and the costs of each step."""
    before, at = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    run(where, "results.parquet", "--jobs", str(WORKERS), "--diagnose-above", ABOVE)
    wall, after = time.monotonic() - at, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    found = [json.loads(p.read_bytes()) for p in entries(where / "results")]
    steps: dict[str, list[float]] = defaultdict(list)
    sizes: dict[str, list[int]] = defaultdict(list)
    for entry in found:
        for step, seconds in entry["seconds"].items():
            steps[step].append(seconds)
        for command, name in entry["documents"].items():
            sizes[command].append((where / "results" / name).stat().st_size)
        sizes["log"].append((where / entry["log"]).stat().st_size)
    sizes["entry"] = [p.stat().st_size for p in entries(where / "results")]
    single = sum(sum(s) for s in steps.values())
    print(f"{len(found)} logs, {WORKERS} workers: {wall:.1f} s on the wall, {cpu:.1f} s of CPU;")
    print(f"single runs: {single:.1f} s of CPU, half of which is {single / WORKERS:.1f} s;")
    print(
        f"wall / half {wall / single * WORKERS:.2f}, CPU of all / CPU of the work {cpu / single:.2f}"
    )
    for step, seconds in steps.items():
        print(f"  {step:9} {len(seconds):5} times, median {median(seconds):8.4f} s of CPU")
    for what, counted in sizes.items():
        print(f"  {what:9} {len(counted):5} files, median {median(counted):8.0f} bytes")
    table = where / "results.parquet"
    print(f"  table: {table.stat().st_size} bytes, {len(rows(table))} rows")
    by_damper: dict[str, set[str]] = defaultdict(set)
    for row in rows(table):
        by_damper[row["damper"]] |= set(row["findings"] or ())
    print({damper: sorted(names) for damper, names in by_damper.items() if names})
    at = time.monotonic()
    run(where, "again.parquet", "--keep", "results", "--jobs", str(WORKERS),
        "--diagnose-above", ABOVE)  # fmt: skip
    print(f"nothing to do: {time.monotonic() - at:.1f} s")


def killed(sound: Path, where: Path, times: int) -> None:
    """The same table after a kill -9 at random moments, from before the first log to the table."""
    run(sound, "results.parquet", "--jobs", str(WORKERS))
    draw = random.Random(0)
    counts, early = [0], 0
    for _ in range(times):
        process = begun(where, "results.parquet", "--jobs", str(WORKERS))
        time.sleep(draw.uniform(0.0, 6.0))
        early += process.poll() is not None
        process.kill()
        process.communicate()
        counts.append(len(entries(where / "results")))
        assert counts[-1] >= counts[-2], "a log was lost"
    run(where, "results.parquet", "--jobs", str(WORKERS))
    print(f"after {times} kills ({early} came too late): logs done {counts}")
    same(sound, where)


def on_cluster(sound: Path, where: Path) -> None:
    """Three workers of a Dask cluster, one killed half-way."""
    run(sound, "results.parquet", "--jobs", str(WORKERS))
    workers = DaskWorkers(where, 3)
    try:
        process = begun(where, "results.parquet", "--cluster", str(workers.file))
        half = sum(1 for _ in (where / "lab").glob("*/*")) // 2
        while len(entries(where / "results")) < half and process.poll() is None:
            time.sleep(0.02)
        workers.workers[0].kill()
        said = process.communicate()[1]
        print(said, f"exit code {process.returncode}")
    finally:
        workers.end()
    same(sound, where)


def same(sound: Path, where: Path) -> None:
    a, b = ((w / "results.parquet").read_bytes() for w in (sound, where))
    print("the same table bit for bit" if a == b else "ANOTHER TABLE")


def main() -> None:
    what, dampers, months = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    os.nice(10)
    with TemporaryDirectory() as name:
        sound, where = labs(Path(name), dampers, months, ("sound", "where"))
        if what == "time":
            timed(where)
        elif what == "kill":
            killed(sound, where, int(sys.argv[4]))
        elif what == "cluster":
            on_cluster(sound, where)
        else:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()

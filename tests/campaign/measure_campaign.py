"""Campaigns by hand: how long they take, what they move, and that nothing disturbs their table.

    PYTHONPATH=. python tests/campaign/measure_campaign.py time 20 10  # 200 logs, 2 workers
    PYTHONPATH=. python tests/campaign/measure_campaign.py all 20 100  # 2,000, and a cluster
    PYTHONPATH=. python tests/campaign/measure_campaign.py kill 20 10 50  # kill -9, 50 times
    PYTHONPATH=. python tests/campaign/measure_campaign.py cluster 20 10  # 3 workers, one killed

On a machine that does other things, too, the CPU times say more than the wall's.
"""

from __future__ import annotations

import json
import os
import random
import resource
import signal
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

import fleet
import pyarrow.parquet as pq
from campaigns import ENV, AtOnce, begun, entries, rows, run
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
    print(f"wall / half {wall / single * WORKERS:.2f}, CPU of all / of the work {cpu / single:.2f}")
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
    """The same table after kill -9 at random moments, from before the first log to the table.

    The command runs in forks of this process, which has all libraries loaded: so most of the kills
    meet it at work. Whenever it is done, it begins again in a new folder.
    """
    from erdctl.campaign import run as room
    from erdctl.cli.app import run as command

    room.here = lambda jobs: room.Crew(AtOnce, lambda: 1)  # type: ignore[assignment]  # a stand-in

    def campaign(place: Path, number: int) -> int:
        os.chdir(place)
        words = ["campaign", "run", "lab", "-o", f"{number}.parquet", "--keep", f"r/{number}"]
        return command([*words, "--label", fleet.LABEL, "--quiet"])

    assert campaign(sound, 0) == 0  # in this process, so that forks find all compiled
    draw, number, kills, done, early = random.Random(0), 0, 0, 0, list[int]()
    while kills < times or not early:
        child = os.fork()
        if not child:
            os._exit(campaign(where, number))
        before = done
        wait(child, draw.uniform(0.0, 1.0) if kills < times else 600.0)
        os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
        done = len(entries(where / "r" / str(number)))
        assert done >= before, "a log was lost"
        if os.WIFSIGNALED(status):
            kills += 1
            continue
        assert os.waitstatus_to_exitcode(status) == 0
        same(sound / "0.parquet", where / f"{number}.parquet")
        number, done = number + 1, 0
        early.append(kills)
    print(f"{kills} kills; a campaign was complete after {early} of them")


def cpu_of(process: int) -> float:
    """CPU time of a process [s]."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def wait(child: int, seconds: float) -> None:
    """Until a child has ended, or has computed for so long."""
    while cpu_of(child) < seconds:
        if os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None:
            return
        time.sleep(0.005)


def on_cluster(sound: Path, where: Path, *more: str) -> None:
    """Three workers of a Dask cluster, one killed half-way."""
    at = time.monotonic()
    workers = DaskWorkers(where, 3)
    try:
        process = begun(where, "results.parquet", "--cluster", str(workers.file), *more)
        half = sum(1 for _ in (where / "lab").glob("*/*")) // 2
        while len(entries(where / "results")) < half and process.poll() is None:
            time.sleep(0.02)
        workers.workers[0].kill()
        said = process.communicate()[1]
        print(said, f"exit code {process.returncode}, {time.monotonic() - at:.1f} s on the wall")
    finally:
        workers.end()
    same(sound / "results.parquet", where / "results.parquet")
    found = [(r["log"], r["command"], r["parameter"]) for r in rows(where / "results.parquet")]
    print(f"{len(found)} rows, {len(found) - len({*found})} of them double, "
          f"{len({log for log, *_ in found})} logs")  # fmt: skip


def erdctl(where: Path, *words: str) -> str:
    """What another command prints of it."""
    done = subprocess.run(
        [sys.executable, "-m", "erdctl", *words], cwd=where, env=ENV, capture_output=True, text=True
    )
    return f"{done.stdout}{done.stderr}exit code {done.returncode}"


def same(sound: Path, other: Path) -> None:
    """Documents are named by their folder, which is all that tables may differ in."""
    a, b = (pq.read_table(path) for path in (sound, other))
    if sound.name == other.name:
        print("the same table bit for bit" if sound.read_bytes() == other.read_bytes() else "OTHER")
    else:
        print("the same rows" if a.drop_columns("documents").equals(b.drop_columns("documents"))
              else "OTHER ROWS")  # fmt: skip


def main() -> None:
    what, dampers, months = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    os.nice(10)
    with TemporaryDirectory() as name:
        sound, where = labs(Path(name), dampers, months, ("sound", "where"))
        if what == "time":
            timed(where)
        elif what == "all":
            timed(sound)
            on_cluster(sound, where, "--diagnose-above", ABOVE)
            print(erdctl(sound, "compare", "results.parquet"))
        elif what == "kill":
            killed(sound, where, int(sys.argv[4]))
        elif what == "cluster":
            run(sound, "results.parquet", "--jobs", str(WORKERS))
            on_cluster(sound, where)
        else:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()

"""Drawing a log of ten million rows against reading it with pyarrow in the same run.

    pytest -m benchmark -n 0 -s --no-cov tests/benchmarks/test_plot_speed.py

The log takes 260 MB in a temporary folder. As in `test_speed`, a test fails at twice its target.
"""

from __future__ import annotations

import shutil
import statistics
from collections.abc import Iterator
from pathlib import Path

import pytest
from test_speed import ERDCTL, PAIRS, PARAMS, SLACK, make_log, python, seconds

pytestmark = pytest.mark.benchmark

ROWS = 10_000_000
TARGET = 3.0
FEW = PAIRS if PAIRS > 3 else 2  # of which one takes half a minute for all kinds
ROOM = 2 * 2**30  # bytes free, of which the log takes an eighth
READ = "import pyarrow.parquet as pq, sys; pq.read_table(sys.argv[1])"
REPORT: list[tuple[str, float, float]] = []


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("plot")
    if shutil.disk_usage(folder).free < ROOM:
        pytest.skip(f"less than {ROOM >> 30} GiB are free in {folder}")
    path = make_log(folder / "long.parquet", ROWS)
    # What compiles and what finds fonts does so once, and the file is in memory.
    seconds([*ERDCTL, "plot", str(path), "--params", PARAMS, "-o", str(folder / "out.png")])
    return path


@pytest.fixture(scope="module", autouse=True)
def report() -> Iterator[None]:
    yield
    print(f"\n{f'{ROWS:,} rows, over pyarrow reading them':58}{'ratio':>8}{'target':>8}")
    for what, ratio, target in REPORT:
        print(f"{what:58}{ratio:8.2f}{target:8.1f}")


@pytest.mark.parametrize(
    "options",
    [
        pytest.param((), marks=pytest.mark.long),
        pytest.param(("--kind", "motion"), marks=pytest.mark.long),
        pytest.param(("--kind", "average"), marks=pytest.mark.long),
        # These simulate ten million rows as well.
        pytest.param(("--kind", "time", "--params", PARAMS), marks=pytest.mark.long),
        ("--params", PARAMS),
    ],
    ids=lambda options: " ".join(options[:2]),
)
def test_plot_long(log: Path, options: tuple[str, ...]) -> None:
    picture = log.with_name("out.png")
    ours = [*ERDCTL, "plot", str(log), *options, "-o", str(picture)]
    base = [*python(READ), str(log)]
    ratio = statistics.median(seconds(ours) / seconds(base) for _ in range(FEW))
    said = " ".join(o.rsplit("/", 1)[-1] for o in ("plot", *options))
    REPORT.append((said, ratio, TARGET))
    assert picture.stat().st_size < 2**20
    assert ratio < SLACK * TARGET

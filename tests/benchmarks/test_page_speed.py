"""A report page of a long log: its size, and its time against reading the file; prints both.

ERDCTL_BENCH_ROWS=10000000 pytest -m benchmark -n 0 -s --no-cov tests/benchmarks
"""

from __future__ import annotations

from pathlib import Path

import pytest
from test_speed import ERDCTL, PAIRS, PARAMS, ROWS, make_log, python, seconds

pytestmark = pytest.mark.benchmark

MOST = 5e6  # bytes


def test_page_of_a_long_log(tmp_path: Path) -> None:
    log, page = make_log(tmp_path / "long.parquet", ROWS), tmp_path / "page.html"
    read = [*python("import pyarrow.parquet as pq, sys; pq.read_table(sys.argv[1])"), str(log)]
    plain = [*ERDCTL, "validate", PARAMS, str(log)]
    paged = [*plain, "--report", str(page)]
    if PAIRS > 3:
        seconds(read), seconds(plain), seconds(paged)  # a median of three leaves out a first run
    rounds = [(seconds(paged), seconds(plain), seconds(read)) for _ in range(PAIRS)]
    columns = zip(*rounds, strict=True)
    page_time, plain_time, read_time = (sorted(times)[PAIRS // 2] for times in columns)
    size = page.stat().st_size
    print(f"\nvalidate --report, {ROWS:,} rows: page of {size / 1e6:.2f} MB (limit 5 MB)")
    print(f"  {page_time / read_time:.2f} times pyarrow reading the file")
    print(f"  {page_time / plain_time:.2f} times validate without a page")
    assert size < MOST

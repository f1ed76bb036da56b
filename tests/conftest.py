"""The fixtures' independent solution, and one thread for each test process."""

from __future__ import annotations

import os
import sys
from collections import defaultdict
from collections.abc import Generator
from functools import cache
from typing import Any
from zlib import crc32

import hypothesis
import pytest
import quick_approx
import typer.testing
from places import FIXTURES, ROOT, SHARED
from real_data import MARK, RealData

sys.path.insert(0, str(FIXTURES))  # the oracle is a script's module, not part of the package
# The processes are the parallelism.
for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(threads, "1")
quick_approx.install()
# How long an example takes is the machine's affair; and whether a change is accepted is that of the
# change, not of what was drawn this time. New draws: pytest --hypothesis-profile=random
hypothesis.settings.register_profile("random", deadline=None)
hypothesis.settings.register_profile("the same", deadline=None, derandomize=True)
hypothesis.settings.load_profile("the same")
# Typer makes Click's commands of an app anew at each call, which takes longer than most calls do.
typer.testing._get_command = cache(typer.testing._get_command)  # type: ignore[attr-defined]  # its own

# Tracing costs a test half as much again, up to as much; these reach next to nothing that others do
# not (see choose_untraced.py). Single tests of that kind have the mark `untraced`.
UNTRACED = frozenset((ROOT / "tests" / "untraced.txt").read_text().split())
TRACED: set[tuple[str, str]] = set()  # tests of which one set of parameters ran in this process


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(
    item: pytest.Item, nextitem: pytest.Item | None
) -> Generator[None, object, object]:
    """From the set-up on, where fixtures diagnose; pytest-cov's `no_cover` is of the call alone.

    Of a test with several sets of parameters the first is traced: tracing costs two thirds more.
    """
    plugin = item.config.pluginmanager.get_plugin("_cov")
    control = plugin.cov_controller if plugin is not None else None
    file, _, test = item.nodeid.partition("[")[0].partition("::")
    wanted = (
        (file, test) not in TRACED
        and file.removeprefix("tests/") not in UNTRACED
        and not item.get_closest_marker("untraced")
    )
    TRACED.add((file, test))
    _trace(control, wanted)
    try:
        return (yield)
    finally:
        if nextitem is None:  # it ends as it began
            _trace(control, True)


def _trace(control: Any, wanted: bool) -> None:
    """Only where it changes: to begin anew takes 50 ms, which most tests do not."""
    if control is not None and control.started != wanted:
        (control.resume if wanted else control.pause)()


@pytest.hookimpl(tryfirst=True)  # before tests are chosen by their marks
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Of a test with the mark `few(n)` so many sets of parameters run, the others with `-m long`.

    Which, a checksum of their names tells: the same ones in each process, and along no parameter.
    """
    sets: dict[str, list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.get_closest_marker("few") and not item.get_closest_marker("long"):
            sets[item.nodeid.partition("[")[0]].append(item)
    for of_one in sets.values():
        mark = of_one[0].get_closest_marker("few")
        assert mark is not None
        for item in sorted(of_one, key=lambda i: crc32(i.nodeid.encode()))[mark.args[0] :]:
            item.add_marker("long")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", f"{MARK}: reads real recordings, see tests/real_data.py")
    if not hasattr(config, "workerinput"):  # the first process of a session, which judges it
        config.pluginmanager.register(RealData(config, ROOT / "tests", SHARED), MARK)

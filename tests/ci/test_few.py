"""Of a test with the mark `few(n)` so many sets of parameters run in every session."""

from __future__ import annotations

from collections import Counter

import pytest


def test_no_test_runs_with_more_sets_than_its_mark_says(request: pytest.FixtureRequest) -> None:
    if "not long" not in request.config.option.markexpr:
        pytest.skip("all of them run with -m long")
    most: dict[str, int] = {}
    runs: Counter[str] = Counter()
    for item in request.session.items:
        if mark := item.get_closest_marker("few"):
            test = item.nodeid.partition("[")[0]
            most[test] = mark.args[0]
            runs[test] += 1
    assert {test: n for test, n in runs.items() if n > most[test]} == {}

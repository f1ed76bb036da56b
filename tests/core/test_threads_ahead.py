"""Threads that are ahead of whoever takes their results."""

from __future__ import annotations

from contextlib import closing
from time import sleep

import pytest

from erdctl.core.workers import ahead


@pytest.mark.parametrize("threads", [1, 3])
def test_threads_give_results_in_order(threads: int) -> None:
    def slow_first(number: int) -> int:
        sleep(0.05 if number == 0 else 0.0)
        return number * number

    assert list(ahead(slow_first, range(7), threads)) == [n * n for n in range(7)]


def test_one_thread_begins_what_is_asked_for() -> None:
    begun: list[int] = []
    results = ahead(begun.append, range(5), 1)
    next(results)
    next(results)
    results.close()
    assert begun == [0, 1]


def test_what_nobody_takes_is_dropped() -> None:
    begun: list[int] = []

    def slow(number: int) -> None:
        begun.append(number)
        sleep(0.02)

    with closing(ahead(slow, range(200), 2)) as results:
        next(results)
    count = len(begun)
    assert count < 10
    sleep(0.1)
    assert len(begun) == count


def test_what_fails_fails_where_it_is_taken() -> None:
    def fails(number: int) -> int:
        return 1 // number

    results = ahead(fails, [1, 0, 1], 2)
    assert next(results) == 1
    with pytest.raises(ZeroDivisionError):
        next(results)

"""Pages made once, and a browser to open them in."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pages
import pytest
from opened import Opened

sys.path.insert(0, str(Path(__file__).parents[1] / "prove"))  # the proof's made-up results

FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """A page by name, from a folder that all test processes share."""
    folder = tmp_path_factory.getbasetemp()
    if os.environ.get("PYTEST_XDIST_WORKER"):
        folder = folder.parent
    shared = folder / "pages"
    shared.mkdir(exist_ok=True)
    return lambda name: pages.page(name, shared)


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium as the system has it; a test without one is skipped, but not in .ci/run."""
    path = shutil.which("chromium") or shutil.which("chromium-browser")
    if path is None:
        missing = "no chromium on this machine (Debian: apt-get install chromium)"
        if os.environ.get("ERDCTL_BROWSER") == "required":
            pytest.fail(missing)
        pytest.skip(missing)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=path, args=FLAGS)
        yield found
        found.close()


@pytest.fixture
def window(browser: Any, made: Callable[[str], Path]) -> Iterator[Callable[..., Opened]]:
    opened: list[Opened] = []

    def one(name: str, **options: Any) -> Opened:
        opened.append(Opened(browser, made(name), **options))
        return opened[-1]

    yield one
    for each in opened:
        each.context.close()


@pytest.fixture(scope="session")
def looked(browser: Any, made: Callable[[str], Path]) -> Iterator[Callable[..., Opened]]:
    """A page as `window` opens it, once for all tests that only look at it."""
    opened: dict[str, Opened] = {}

    def one(name: str, **options: Any) -> Opened:
        key = f"{name} {options}"
        if key not in opened:
            opened[key] = Opened(browser, made(name), **options)
        return opened[key]

    yield one
    for each in opened.values():
        each.context.close()

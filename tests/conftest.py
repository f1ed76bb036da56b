"""The fixtures' independent solution, and one linear algebra thread for each test process."""

from __future__ import annotations

import os
import sys

import pytest
from places import FIXTURES, ROOT, SHARED
from real_data import MARK, RealData

sys.path.insert(0, str(FIXTURES))  # the oracle is a script's module, not part of the package
# The processes are the parallelism.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", f"{MARK}: reads real recordings, see tests/real_data.py")
    if not hasattr(config, "workerinput"):  # the first process of a session, which judges it
        config.pluginmanager.register(RealData(config, ROOT / "tests", SHARED), MARK)

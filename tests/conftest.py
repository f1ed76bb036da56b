"""Paths and independent solutions that several tests share."""

from __future__ import annotations

import os
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
FIXTURES = ROOT / "fixtures"
SHARED = ROOT.parent / "shared" / "data"  # real recordings, where they are at hand

sys.path.insert(0, str(FIXTURES))  # the oracle is a script's module, not part of the package
# One linear algebra thread for each test process: the processes are the parallelism.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

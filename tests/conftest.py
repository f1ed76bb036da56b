"""The fixtures' independent solution, and one linear algebra thread for each test process."""

from __future__ import annotations

import os
import sys

from places import FIXTURES

sys.path.insert(0, str(FIXTURES))  # the oracle is a script's module, not part of the package
# The processes are the parallelism.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

"""The diagnosis of a table of samples, as the command line makes it of a file."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd

from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs


def diagnosed(table: pd.DataFrame) -> Diagnosis:
    """The diagnosis against the whole catalogue, in one process; of limits none."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "log.parquet"
        table.to_parquet(file)
        log = read_logs([str(file)], need_force=True, report=lambda line: None)
    return with_a_fault_once(
        partial(diagnose, candidates=catalogue(), jobs=1, limits=False), log.recording
    )

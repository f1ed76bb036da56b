"""What was done of a campaign, on disk: one small file a log, written when all of the log is.

    FOLDER/3f/fl_2024-05-3fa9c1d2e0b4.identify.json     a document of each command
    FOLDER/3f/3fa9c1d2e0b4....json                      the entry, last of all: the log is done

The entry is named by the hash of what was asked. A campaign that is killed anywhere has lost what
it was working on and nothing else, and finds by the entries what need not be done again.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import msgspec

from erdctl.core.errors import UsageProblem
from erdctl.io.atomic import output, together

SCHEMA = "erdctl.campaign-log/1"
LOCK = ".campaign"


class ParameterEntry(msgspec.Struct, frozen=True):
    """One parameter in SI; low, high : ends of its 95 % interval."""

    command: str
    parameter: str
    unit: str | None
    value: float | None
    stderr: float | None
    low: float | None
    high: float | None
    identified: bool


class Entry(msgspec.Struct, kw_only=True):
    """What came of one log, or of one group of logs; see `io.campaign_table` for the fields.

    key : hash of what was asked;  documents : command -> file in the folder
    seconds : that each step took, for whoever counts costs: in no table
    by_project : what a project file changed in reading the logs: in no table
    """

    schema: str = SCHEMA
    key: str
    log: str
    logs: list[str]
    hash: str | None = None
    version: str
    damper: str | None = None
    corner: str | None = None
    date: str | None = None
    conditions: dict[str, str] = {}
    parameters: list[ParameterEntry] = []
    verdict: str | None = None
    findings: list[str] | None = None
    rig: list[str] | None = None
    nrmse: float | None = None
    nrmse_worst: float | None = None
    noise_rms: float | None = None
    documents: dict[str, str] = {}
    remarks: list[str] = []
    exit_code: int = 0
    error: str | None = None
    seconds: dict[str, float] = {}
    by_project: list[str] = []


@dataclass(frozen=True)
class Journal:
    """The entries in a folder; see `journal`."""

    folder: Path

    def read(self, key: str) -> Entry | None:
        """The entry of what was asked; None if it is not done, or its documents are gone."""
        try:
            found = msgspec.json.decode(self._entry(key).read_bytes(), type=Entry)
        except (FileNotFoundError, msgspec.DecodeError):
            return None  # not done, or of another erdctl: anew
        whole = found.schema == SCHEMA and found.key == key
        there = all((self.folder / name).is_file() for name in found.documents.values())
        return found if whole and there else None

    def write(self, entry: Entry, documents: Mapping[str, bytes]) -> None:
        """Keep what came of a log; the entry takes its place after the documents.

        documents : file in the folder -> its bytes
        """
        place = self._entry(entry.key)
        place.parent.mkdir(exist_ok=True)
        # A run of its own: what is done stays done, however the command ends.
        with together():
            for name, data in documents.items():
                with output(os.fspath(self.folder / name)) as stream:
                    stream.write(data)
            with output(os.fspath(place)) as stream:
                stream.write(msgspec.json.encode(entry))

    def _entry(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key}.json"


@contextmanager
def journal(folder: str) -> Iterator[Journal]:
    """The journal in a folder, which is made where it is not there; for one campaign at a time.

    Raises UsageProblem if another one is at work there, or the folder cannot be made.
    """
    path = Path(folder)
    try:
        path.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        raise UsageProblem(f"--keep {folder}: {(error.strerror or str(error)).lower()}") from None
    try:
        _claim(descriptor, folder)
        for left in path.glob("*/.erdctl-*.tmp"):  # of a campaign that was killed
            left.unlink(missing_ok=True)
        yield Journal(path)
    finally:
        os.close(descriptor)


def _claim(descriptor: int, folder: str) -> None:
    try:
        import fcntl
    except ImportError:  # Windows
        return
    try:
        # Released by the system when the process ends, however it ends.
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise UsageProblem(
            f"--keep {folder}: another campaign is at work there; wait, or name another folder"
        ) from None
    except OSError:
        return  # a file system without locks

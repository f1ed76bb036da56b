"""One job, in a worker: the log read where the worker is, the commands run, what came of it."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import chdir, contextmanager
from dataclasses import dataclass, field, replace
from time import process_time
from typing import Any

from erdctl.campaign.plan import Job, Step
from erdctl.core.errors import ComputationProblem, ErdctlError, ExitCode, UsageProblem
from erdctl.core.messages import as_text
from erdctl.core.version import __version__
from erdctl.core.workers import alone
from erdctl.interface.diagnose import diagnose
from erdctl.interface.identify import Identified, identify
from erdctl.interface.inspect import inspect
from erdctl.interface.log import BenchLog, open_log
from erdctl.interface.validate import validate
from erdctl.io import documents
from erdctl.io.campaign_journal import Entry, ParameterEntry
from erdctl.io.project.labels import OWN
from erdctl.io.urls import fetch, is_url

MOST_ERROR = 500  # characters of an error in a table
SIGMAS = 1.96  # half a 95 % interval


@dataclass(frozen=True)
class Done:
    """What came of a job.

    documents : file in the journal's folder -> its bytes
    """

    entry: Entry
    documents: Mapping[str, bytes] = field(default_factory=dict)


def done(job: Job) -> Done | None:
    """Do a job; None if its logs are what they were when it was done before.

    What goes wrong with a log stands in the entry, and is raised no more.
    """
    # The field's lag rounds otherwise once a compiler is loaded (see `diagnose.executor`): loaded
    # from the beginning, a log's numbers do not depend on which logs its worker had before.
    import erdctl.model.recurrences  # noqa: F401  # only to load the compiler

    work = _Work(job)
    with alone():
        try:
            with _inside(job.folder, job.paths):
                if work.unchanged():
                    return None
                work.run()
        except ErdctlError as error:
            work.fail(str(error), error.exit_code)
        except MemoryError:
            work.fail("out of memory", ExitCode.NOT_COMPLETED)
        except Exception as error:  # noqa: BLE001  # a defect that one log shows must not end the others
            work.fail(f"internal error: {type(error).__name__}: {error}", ExitCode.NOT_COMPLETED)
    return Done(work.entry, work.documents)


@contextmanager
def _inside(folder: str, paths: Sequence[str]) -> Iterator[None]:
    """Relative paths begin where the command was given, also for a worker elsewhere."""
    fixed = all(is_url(path) or os.path.isabs(path) for path in paths)
    if fixed or os.path.realpath(os.getcwd()) == os.path.realpath(folder):
        yield
        return
    if not os.path.isdir(folder):
        raise UsageProblem(
            f"a worker does not see the folder {folder}: run the campaign on a disk that all of"
            " them share, or give URLs"
        )
    with chdir(folder):
        yield


def failed(job: Job, error: str) -> Done:
    """The outcome of a job that could not even be begun, or whose worker died of it."""
    work = _Work(job)
    work.fail(error, ExitCode.NOT_COMPLETED)
    return Done(work.entry)


def refused(job: Job) -> Done:
    """The outcome of a job that cannot be done as it is asked for."""
    work = _Work(job)
    work.fail(str(job.problem), ExitCode.USAGE)
    return Done(work.entry)


class _Work:
    """A job that is being done: what is known so far."""

    def __init__(self, job: Job) -> None:
        self.job, self.asked, self.documents = job, job.asked, dict[str, bytes]()
        labels = job.labels
        self.entry = Entry(
            key=job.key, log=job.name, logs=[as_text(path) for path in job.paths],
            version=job.version, damper=labels.damper, corner=labels.corner, date=labels.date,
            conditions=dict(labels.conditions),
        )  # fmt: skip

    def unchanged(self) -> bool:
        """Whether the logs have the hash that is known of them."""
        if self.job.version != __version__:
            raise ComputationProblem(
                f"this worker has erdctl {__version__}, and the campaign {self.job.version};"
                " install the same on both"
            )
        if self.job.known is None:
            return False
        with self._timed("hash"):
            return _together([_digest(path) for path in self.job.paths]) == self.job.known

    def run(self) -> None:
        """All steps, as far as the log bears them."""
        with self._timed("read"):
            log = self._read()
        steps: Mapping[Step, Callable[[BenchLog], None]] = {
            Step.INSPECT: self._inspect,
            Step.IDENTIFY: self._identify,
            Step.VALIDATE: self._validate,
            Step.DIAGNOSE: self._diagnose,
        }
        for step in self.asked.steps:
            if step is not Step.DIAGNOSE or self._falls_short():
                with self._timed(step.value):
                    steps[step](log)

    def fail(self, error: str, code: ExitCode) -> None:
        """Note an error in one line; what was found before it stays."""
        line = " ".join(error.split())
        self.entry.error = line if len(line) <= MOST_ERROR else f"{line[:MOST_ERROR]}..."
        self.entry.exit_code = int(code)

    def _read(self) -> BenchLog:
        force = self.asked.steps != (Step.INSPECT,)
        project, changed = self.job.project, self.entry.by_project
        if project is not None:
            project = replace(project, used=changed.append)
        try:
            log = open_log(
                self.job.paths, map=self.asked.maps, text=self.asked.text, where=self.asked.where,
                need_force=force, want_force=True, project=project,
            )  # fmt: skip
        except ErdctlError as error:
            # A log that is bad today is not read again tomorrow, unless it has changed.
            if error.exit_code is ExitCode.BAD_INPUT:
                self.entry.hash = _together([_digest(path) for path in self.job.paths])
            raise
        self.entry.hash = _together([s.sha256 for s in log.recording.sources])
        self.entry.remarks = [*log.remarks]
        stated = log.recording.labels  # by a project file also those of columns
        for name in OWN:
            setattr(self.entry, name, getattr(self.entry, name) or stated.get(name))
        return log.labelled(date=self.job.labels.date, damper=self.job.labels.damper)

    def _falls_short(self) -> bool:
        above, nrmse = self.asked.diagnose_above, self.entry.nrmse
        return above is None or nrmse is None or nrmse > above

    def _inspect(self, log: BenchLog) -> None:
        document = inspect(log).to_dict()
        self._keep(Step.INSPECT, document, document["rig"])

    def _identify(self, log: BenchLog) -> None:
        self._identified: Identified = identify(log, accept=self.asked.accept)
        document = self._identified.to_dict()
        self._keep(Step.IDENTIFY, document, document["provenance"].get("rig", []))
        self.entry.noise_rms = document["provenance"].get("noise_rms")
        self.entry.parameters += parameters_in(document, Step.IDENTIFY)

    def _validate(self, log: BenchLog) -> None:
        document = validate(self._identified, log).to_dict()
        self._keep(Step.VALIDATE, document, document["rig"])
        self.entry.nrmse = document["nrmse"]
        self.entry.nrmse_worst = max(level["nrmse"] for level in document["nrmse_by_duty"])

    def _diagnose(self, log: BenchLog) -> None:
        asked = self.asked
        document = diagnose(
            log, effects=asked.effects or None, exclude=asked.exclude or None, accept=asked.accept,
            max_effects=asked.max_effects, seed=asked.seed, jobs=1,
        ).to_dict()  # fmt: skip
        self._keep(Step.DIAGNOSE, document, document["rig"])
        self.entry.verdict = document["verdict"]
        self.entry.findings = [f["effect"] for f in document["findings"]]
        self.entry.noise_rms = document["noise_rms"]
        self.entry.parameters += parameters_in(document["corrected"]["params"], Step.DIAGNOSE)
        self.entry.parameters += [
            ParameterEntry(
                command=Step.DIAGNOSE.value, parameter=f"{effect}.{limit['parameter']}",
                unit=limit["unit"], value=None, stderr=None, low=None, high=limit["value"],
                identified=False,
            )
            for effect, limit in document["limits"].items()
        ]  # fmt: skip  # from `high` on it would have been named

    def _keep(self, step: Step, document: dict[str, Any], rig: list[dict[str, Any]]) -> None:
        name = self.job.document(step)
        self.entry.documents[step.value] = name
        self.documents[name] = documents.encode(document)
        codes = [f["code"] for f in rig if f["code"] not in self.asked.accept]
        self.entry.rig = [*dict.fromkeys([*(self.entry.rig or []), *codes])]

    @contextmanager
    def _timed(self, what: str) -> Iterator[None]:
        begun = process_time()
        yield
        self.entry.seconds[what] = process_time() - begun


def parameters_in(document: Mapping[str, Any], step: Step) -> list[ParameterEntry]:
    """The parameters of a parameter file, in its order, with both ends of their intervals."""
    groups = [(name, document[name]) for name in ("compression", "release")]
    groups += [(e["effect"], e["parameters"]) for e in document.get("effects", [])]
    return [
        _parameter(step, f"{group}.{symbol}", value)
        for group, values in groups
        for symbol, value in values.items()
    ]


def _parameter(step: Step, name: str, value: Mapping[str, Any]) -> ParameterEntry:
    number, stderr = value["value"], value.get("stderr")
    low, high = value.get("interval") or (None, None)
    if low is None and number is not None and stderr is not None:
        low, high = number - SIGMAS * stderr, number + SIGMAS * stderr
    return ParameterEntry(
        command=step.value, parameter=name, unit=value.get("unit"), value=number, stderr=stderr,
        low=low, high=high, identified=value.get("identified", True),
    )  # fmt: skip


def _digest(path: str) -> str:
    if is_url(path):
        return hashlib.sha256(fetch(path)).hexdigest()
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""  # what it was is no more; reading it says so


def _together(digests: list[str]) -> str | None:
    """The hash of a log, or of the logs of a group in order; None where one could not be read."""
    if not all(digests):
        return None
    return (
        digests[0] if len(digests) == 1 else hashlib.sha256("".join(digests).encode()).hexdigest()
    )

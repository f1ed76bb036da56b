"""What is to be done of which logs: pure, before anything is read."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

import msgspec

from erdctl.campaign.labels import common
from erdctl.core.errors import UsageProblem
from erdctl.core.messages import as_text
from erdctl.core.version import __version__
from erdctl.diagnose.thresholds import MOST_EFFECTS
from erdctl.io.project.labels import Labels
from erdctl.io.project.reading import ProjectReading

Labelling = Callable[[str], Labels | None]
STEM = 60  # characters of a log's name in the names of its documents


class Step(StrEnum):
    """Commands that a campaign runs, in their order."""

    INSPECT = "inspect"
    IDENTIFY = "identify"
    VALIDATE = "validate"
    DIAGNOSE = "diagnose"


@dataclass(frozen=True, kw_only=True)
class StepOptions:
    """What is done of each log: the options of the commands that have them.

    steps : in their order
    diagnose_above : only logs whose NRMSE under their own identified model is above this [1]
    """

    steps: tuple[Step, ...] = (Step.IDENTIFY, Step.VALIDATE)
    diagnose_above: float | None = None
    maps: tuple[str, ...] = ()
    text: tuple[str, ...] = ()
    where: tuple[str, ...] = ()
    accept: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()
    max_effects: int = MOST_EFFECTS
    seed: int = 0


Reading = Callable[[Mapping[str, Labels]], ProjectReading | None]


@dataclass(frozen=True, kw_only=True)
class Job:
    """One log, or several that are taken together, and what is asked of it.

    name : what the table calls it: the log's path, or the labels of a group
    problem : why nothing can be done of it;  known : hash of the log as it was done before
    folder : in which relative paths begin, on a worker too
    project : how the logs are read where the options do not say it;  said : what it says of each
    """

    name: str
    paths: tuple[str, ...]
    labels: Labels
    asked: StepOptions
    version: str = __version__
    problem: str | None = None
    known: str | None = field(default=None, compare=False)
    folder: str = field(default_factory=os.getcwd, compare=False)
    project: ProjectReading | None = field(default=None, compare=False)
    said: tuple[object, ...] = ()

    @property
    def key(self) -> str:
        """SHA-256 of all that the outcome depends on beside the bytes of the logs."""
        paths = [as_text(path) for path in self.paths]
        what = (self.name, paths, self.labels, self.asked, self.version, self.problem, *self.said)
        return hashlib.sha256(msgspec.json.encode(what)).hexdigest()

    def document(self, step: Step) -> str:
        """Name of the document of a command in the journal's folder."""
        stem = os.path.splitext(os.path.basename(self.name))[0]
        plain = re.sub(r"[^A-Za-z0-9.=_-]+", "_", stem)[:STEM].strip("._") or "log"
        key = self.key
        return f"{key[:2]}/{plain}-{key[:16]}.{step.value}.json"


def steps_of(text: str, above: float | None) -> tuple[Step, ...]:
    """The steps of `--steps`, with those that they need.

    above : the score from which on a log is diagnosed, which takes the score
    Check: a score is that of an identified model.
    >>> [step.value for step in steps_of("validate", None)]
    ['identify', 'validate']
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    unknown = [word for word in words if word not in list(Step)]
    if unknown or not words:
        raise UsageProblem(f"--steps takes {', '.join(Step)}, not '{text}'")
    wanted = {Step(word) for word in words}
    if above is not None:
        wanted |= {Step.VALIDATE, Step.DIAGNOSE}
    if Step.VALIDATE in wanted:
        wanted.add(Step.IDENTIFY)
    return tuple(step for step in Step if step in wanted)


def plan(
    logs: Sequence[str],
    asked: StepOptions,
    labelling: Labelling = lambda path: None,
    group_by: Sequence[str] = (),
    reading: Reading = lambda labels: None,
) -> list[Job]:
    """The jobs of a campaign, in the order of the table's rows.

    labelling : what is known of a log by its path; None for nothing, UsageProblem for nonsense
    group_by : labels that logs have in common which are taken together as one; each alone if empty
    reading : how logs of these labels, by path, are read by a project file
    """

    def job(name: str, labels: Labels, of: Mapping[str, Labels], problem: str | None = None) -> Job:
        project = reading(of) if problem is None else None
        return Job(
            name=name, paths=tuple(of), labels=labels, asked=asked, problem=problem,
            project=project, said=tuple(project.says(path) for path in of) if project else (),
        )  # fmt: skip

    jobs: list[Job] = []
    groups: dict[tuple[str, ...], list[tuple[str, Labels]]] = {}
    for path in logs:
        problem, labels = None, Labels()
        try:
            labels = labelling(as_text(path)) or labels
        except UsageProblem as error:
            problem = str(error)
        values = tuple(labels.value(name) or "" for name in group_by)
        lacking = [name for name, value in zip(group_by, values, strict=True) if not value]
        if problem is None and lacking:
            problem = f"{as_text(path)}: its path does not say {', '.join(lacking)}, see --label"
        if group_by and problem is None:
            groups.setdefault(values, []).append((path, labels))
        else:
            jobs.append(job(as_text(path), labels, {path: labels}, problem))
    for values, members in groups.items():
        name = ",".join(f"{n}={v}" for n, v in zip(group_by, values, strict=True))
        jobs.append(job(name, common([labels for _, labels in members]), dict(members)))
    return sorted(jobs, key=lambda job: job.name)

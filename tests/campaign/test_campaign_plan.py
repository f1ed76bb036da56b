"""What is to be done of which logs: labels, groups, steps and keys."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from erdctl.campaign.labels import Labels, common, labels_of_path, pattern_of
from erdctl.campaign.plan import Job, Step, StepOptions, plan, steps_of
from erdctl.core.errors import UsageProblem

PATTERN = re.compile(r"(?P<damper>D\d+)/(?P<corner>[a-z]{2})_(?P<date>[\d-]+)_(?P<oil>\d+C)?")


def labels(path: str) -> Labels | None:
    return labels_of_path(path, PATTERN)


@pytest.mark.parametrize(
    ("written", "iso"),
    [("2024-05-01", "2024-05-01"), ("20240501", "20240501"), ("2024-05", "2024-05-01"),
     ("202405", "20240501")],
)  # fmt: skip
def test_labels_of_a_path(written: str, iso: str) -> None:
    found = labels(f"lab/D7/fl_{written}_40C.csv")
    assert found == Labels("D7", "fl", iso, {"oil": "40C"})
    assert labels("lab/other.csv") is None


def test_no_date_and_no_expression() -> None:
    with pytest.raises(UsageProblem, match=r"the date '2024-99' is none.*lab/D7"):
        labels("lab/D7/fl_2024-99_40C.csv")
    with pytest.raises(UsageProblem, match="no regular expression"):
        pattern_of("(")
    with pytest.raises(UsageProblem, match="name what it finds"):
        pattern_of("D[0-9]+")


@pytest.mark.parametrize("written", ["240501", "201205"])
def test_six_digits_that_may_be_a_month_or_a_day_are_no_date(written: str) -> None:
    with pytest.raises(UsageProblem, match=f"the date '{written}' may be year and month or"):
        labels(f"lab/D7/fl_{written}_40C.csv")


def test_a_group_has_what_its_logs_share() -> None:
    a = Labels("D1", "fl", "2024-05-01", {"oil": "40C", "rig": "2"})
    b = Labels("D1", "fr", "2024-05-01", {"oil": "20C", "rig": "2"})
    assert common([a, b]) == Labels("D1", None, "2024-05-01", {"rig": "2"})


def test_groups_are_one_job_each_and_what_has_no_label_is_refused() -> None:
    logs = ["D2/fl_2024-05_.csv", "D1/fl_2024-05_.csv", "D1/fr_2024-06_.csv", "other.csv"]
    jobs = plan(logs, StepOptions(), labels, ["damper"])
    assert [(j.name, j.paths) for j in jobs] == [
        ("damper=D1", ("D1/fl_2024-05_.csv", "D1/fr_2024-06_.csv")),
        ("damper=D2", ("D2/fl_2024-05_.csv",)),
        ("other.csv", ("other.csv",)),
    ]
    assert "does not say damper" in str(jobs[2].problem)
    assert jobs[0].labels == Labels("D1")


def test_one_wrong_date_is_the_problem_of_its_log() -> None:
    jobs = plan(["D1/fl_2024-99_.csv", "D1/fl_2024-05_.csv"], StepOptions(), labels)
    assert [j.problem is None for j in jobs] == [True, False]


def test_a_key_is_of_all_that_the_outcome_depends_on() -> None:
    """But not of where the command was given, nor of what was done before."""
    job = Job(name="a.csv", paths=("a.csv",), labels=Labels("D1"), asked=StepOptions())
    others = [
        replace(job, labels=Labels("D2")),
        replace(job, version="0.0.0"),
        replace(job, paths=("b.csv",)),
        replace(job, asked=StepOptions(steps=(Step.INSPECT,))),
        replace(job, asked=StepOptions(maps=("x=Defl[mm]",))),
        replace(job, asked=StepOptions(diagnose_above=0.1)),
        replace(job, asked=StepOptions(seed=1)),
    ]
    assert len({j.key for j in (job, *others)}) == len(others) + 1
    assert replace(job, folder="/elsewhere", known="00").key == job.key


def test_steps() -> None:
    assert steps_of("diagnose,inspect", None) == (Step.INSPECT, Step.DIAGNOSE)
    assert steps_of("identify", 0.1) == (Step.IDENTIFY, Step.VALIDATE, Step.DIAGNOSE)
    for wrong in ("", "identify,guess"):
        with pytest.raises(UsageProblem, match="--steps takes inspect, identify"):
            steps_of(wrong, None)


def test_a_name_that_is_no_text() -> None:
    """Bytes of another encoding, as Python holds them."""
    (job,) = plan(["lab/m\udcfcll.csv"], StepOptions(), labels)
    assert job.paths == ("lab/m\udcfcll.csv",)
    assert job.name == "lab/m\\udcfcll.csv"
    assert len(job.key) == 64


def test_names_of_documents_are_names_of_files() -> None:
    job = Job(name="s3://b/ü t/../fl 1.csv?x=/..", paths=(), labels=Labels(), asked=StepOptions())
    assert re.fullmatch(r"[0-9a-f]{2}/[\w.=-]+-[0-9a-f]{16}\.identify\.json",
                        job.document(Step.IDENTIFY))  # fmt: skip

"""A search that a fault in some records would drive on ends early, and none is made twice."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import quarter_car

from erdctl.core.recording import Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.executor import Executor
from erdctl.diagnose.fault_beside import a_fault_explains
from erdctl.diagnose.hypothesis import fit_hypothesis, rank_starts
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.record_effects import Varying
from erdctl.diagnose.search import Selection, search
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.io.logs import read_logs
from erdctl.model.composed import Model
from erdctl.model.onset import START

FAULT, STEEP = get("electrical_fault"), get("preyield_viscosity")


@pytest.fixture(scope="module")
def car(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Six drives, an electrical fault in some of them."""

    def recorded(having: Sequence[int]) -> Recording:
        onsets = tuple(0.0 if r in having else np.inf for r in range(6))
        file: Path = tmp_path_factory.mktemp("car") / "car.parquet"
        quarter_car.log(75, 200, fault="electrical_fault", onsets=onsets).to_parquet(file)
        return read_logs([str(file)], need_force=True, report=lambda line: None).recording

    return recorded


def _told_to(sought: list[str], name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    def called(*given: Any) -> Any:
        sought.append(name)
        return function(*given)

    return called


def found(recording: Recording, *, once: bool) -> Selection:
    problem = prepare(recording)
    return search(problem, [FAULT, STEEP], 8, Executor([problem]), once=once)


@pytest.mark.long
def test_it_ends_where_a_fault_leaves_nothing(car: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """It went on to eight effects, none of them there, for minutes before the fault was sought."""
    some, none = (car(having).select([0, 1, 2]) for having in ((1,), ()))
    assert not found(some, once=True).ended  # what is found so soon takes less than to look
    monkeypatch.setattr(thresholds, "BEFORE_A_FAULT", 1)
    sought = list[str]()
    module = importlib.import_module("erdctl.diagnose.search")
    for name in ("forward_step", "joint_tasks"):
        monkeypatch.setattr(module, name, _told_to(sought, name, getattr(module, name)))
    ended = found(some, once=True)
    assert ended.ended
    assert ended.named == (STEEP,)
    assert sought == ["forward_step"]
    assert not found(some, once=False).ended
    assert not found(none, once=True).ended


BENT = ("preyield_viscosity", "rise_decay_asymmetry", "time_skew")  # of a search in these drives


@pytest.mark.parametrize(
    ("having", "names", "explains"),
    [
        pytest.param((1, 3), BENT, True, marks=pytest.mark.long),
        ((), BENT, False),
        pytest.param((1, 3), ("preyield_field_dependence",), False, marks=pytest.mark.long),
    ],
)
def test_a_fault_explains(
    having: tuple[int, ...], names: tuple[str, ...], explains: bool, car: Any
) -> None:
    """Where it is there, and leaves nothing beside the effects."""
    problem, effects = prepare(car(having)), tuple(get(name) for name in names)
    start = {name: q.start for name, q in Model(effects).quantities.items()}
    best = fit_hypothesis(problem, effects, [start])
    assert a_fault_explains(best, (FAULT,), 0) == explains


@pytest.mark.long
def test_nothing_else_changes_with_a_search_that_is_known(car: Any) -> None:
    recording = car((1, 3)).select([0])
    candidates = [STEEP]
    first = diagnose(recording, candidates, once=False)
    again = diagnose(recording, candidates, once=False, known=first.searched)
    assert again.searched is first.searched
    assert to_json(again) == to_json(first)


def test_lags_are_not_sought_beside_what_has_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    module, asked = importlib.import_module("erdctl.diagnose.searched"), list[bool]()
    monkeypatch.setattr(module, "to_be_searched_with_lags", lambda *a: asked.append(True))
    for ended in (False, True):
        result = SimpleNamespace(ended=ended)
        monkeypatch.setattr(module, "search", lambda *a, result=result, **k: result)
        module.searched(((),), [], 1, lambda p: None, 0, None, [], once=True, known=None)
    assert asked == [True]


@pytest.mark.parametrize(("ended", "apart"), [(False, ()), (True, ()), (False, ("strokes",))])
def test_what_a_fault_does_not_say_is_sought_once(
    car: Any, ended: bool, apart: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same search once more is not made, unless the first one had ended before its time, or
    there are strokes to leave out now."""
    recording = car((1, 3)).select([0])
    first = diagnose(recording, [STEEP], once=False)
    searched = replace(first.searched, selection=replace(first.searched.selection, ended=ended))
    once: Any = SimpleNamespace(in_order=lambda recording: recording)
    first = replace(first, once=once, searched=searched, verdict=Verdict.UNEXPLAINED)
    asked: list[dict[str, Any]] = []

    def run(recording: Recording, **options: Any) -> Diagnosis:
        asked.append(options)
        return first

    module = importlib.import_module("erdctl.diagnose.one_after_another")
    monkeypatch.setattr(module, "_named", lambda *a: None)
    monkeypatch.setattr(module, "_beside", lambda *a: None)
    monkeypatch.setattr(module, "unlogged", lambda best: apart)
    with_a_fault_once(run, recording)
    assert [o.get("once", True) for o in asked] == [True, False, False]
    assert asked[-1]["known"] is (None if ended or apart else searched)


@pytest.mark.long
def test_it_goes_on_after_all_where_no_fault_is_seen_on_all_samples(
    car: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(thresholds, "BEFORE_A_FAULT", 1)
    module, ended = importlib.import_module("erdctl.diagnose.diagnosis"), list[bool]()
    sought = module.searched

    def noted(*given: Any, **options: Any) -> Any:
        found = sought(*given, **options)
        ended.append(found[0].selection.ended)
        return found

    monkeypatch.setattr(module, "searched", noted)
    monkeypatch.setattr(module, "sets_in_once", lambda *a: None)
    recording = car((1,)).select([0, 1, 2])
    found = diagnose(recording, [FAULT, STEEP], limits=False, learning=False)
    assert ended == [True, False]
    assert not found.searched.selection.ended


def test_where_records_are_free_to_differ_no_fault_is_sought(
    car: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    module, asked = importlib.import_module("erdctl.diagnose.diagnosis"), list[bool]()

    def noted(*given: Any, once: bool, **options: Any) -> Any:
        asked.append(once)
        raise InterruptedError

    monkeypatch.setattr(module, "searched", noted)
    for free in (Varying(), Varying(gain=True)):
        with pytest.raises(InterruptedError):
            diagnose(car((1,)).select([0, 1, 2]), [FAULT], free=free)
    assert asked == [True, False]


def test_onsets_stay_while_starts_are_ranked(car: Any) -> None:
    problem = prepare(car((1,)).select([1]))
    start = {name: q.start for name, q in Model((FAULT,)).quantities.items()}
    onset = FAULT.key(START)
    points = [{**start, onset: at} for at in (1.0, 6.0)]
    assert {p[onset] for p in rank_starts(problem, (FAULT,), points)} == {1.0, 6.0}

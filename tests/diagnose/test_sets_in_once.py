"""A fault in some of a car's drives: which, in which records, from when on, whether it stays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import quarter_car

from erdctl.core.recording import Recording, running_time
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.findings import earned, part_taken
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.records_with_a_fault import apart, telling
from erdctl.diagnose.residual.predictability import lack_of_fit_of
from erdctl.diagnose.search import Selection
from erdctl.diagnose.sets_in_once import SetsInOnce, sets_in_once
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.io.logs import read_logs
from erdctl.model.composed import Model
from erdctl.model.effect import Variable

NEVER = np.inf
STAYS, ONCE = (NEVER, 4.4, 0.0, 0.0), (NEVER, 4.4, NEVER, NEVER)
FAULTS = tuple(get(name) for name in quarter_car.FAULTS)


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("car")

    @cache
    def recorded(
        kind: str, onsets: Sequence[float], seed: int = 31, left: float = 0.6
    ) -> Recording:
        table = quarter_car.log(
            seed, 200, records=len(onsets) or 4, seconds=8.0, fault=kind, left=left, onsets=onsets
        )
        file = Path(folder) / f"{kind}-{len(list(folder.iterdir()))}.parquet"
        table.to_parquet(file)
        return read_logs([str(file)], need_force=True, report=lambda line: None).recording

    return recorded


def sought(recording: Recording) -> SetsInOnce | None:
    problem, effects = prepare(recording), (get("preyield_viscosity"),)
    start = {name: q.start for name, q in Model(effects).quantities.items()}
    best = fit_hypothesis(problem, effects, [start])
    return sets_in_once(best, FAULTS, lack_of_fit_of(best).misfit_rms)


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", quarter_car.FAULTS)
@pytest.mark.parametrize("onsets", [STAYS, ONCE], ids=["stays", "once"])
def test_record_and_time(kind: str, onsets: tuple[float, ...], recordings: Any) -> None:
    found = sought(recordings(kind, onsets))
    assert found is not None
    assert (found.record, found.stays) == (1, onsets is STAYS)
    assert found.at[0] <= 4.4 <= found.at[1]
    assert found.f == pytest.approx(0.6, abs=0.05)


@pytest.mark.few(1)
@pytest.mark.parametrize(("seed", "left"), [(63, 0.66), (82, 0.64)])
def test_the_time_and_the_kind_are_chosen_together(seed: int, left: float, recordings: Any) -> None:
    """In the time of all records another kind takes less than it takes of one record alone."""
    onsets = (NEVER, 4.4, 0.0, 0.0, 0.0, 0.0)
    found = sought(recordings("electrical_fault", onsets, seed, left))
    assert found is not None
    assert (found.effect.name, found.record, found.stays) == ("electrical_fault", 1, True)
    assert found.f == pytest.approx(left, abs=0.03)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("kind", "having", "seed"),
    [
        ("oil_leakage", (1, 3), 71), ("electrical_fault", (2, 3, 4, 5), 72),
        ("deformation_fault", (0, 1, 4), 73), ("electrical_fault", (5,), 74),
    ],
)  # fmt: skip
def test_records_that_have_it_all_along(
    kind: str, having: tuple[int, ...], seed: int, recordings: Any
) -> None:
    found = sought(recordings(kind, tuple(0.0 if r in having else NEVER for r in range(6)), seed))
    assert found is not None
    assert found.whole
    assert (found.effect.name, found.records) == (kind, having)
    assert found.stays == (having == (2, 3, 4, 5))
    assert found.may_be_a_duty == (kind == "electrical_fault")
    assert found.f == pytest.approx(0.6, abs=0.05)


@pytest.mark.long
def test_where_most_records_have_it_the_others_are_said(recordings: Any) -> None:
    """23 of 24 records were listed as those of a fault, where the duty of one was logged wrong."""
    onsets = tuple(NEVER if r == 3 else 0.0 for r in range(6))
    found = diagnosed(recordings("deformation_fault", onsets, 75))
    assert found.once is not None
    assert (found.once.records, found.once.odd) == ((0, 1, 2, 4, 5), (3,))
    assert "lies in record 'r3', as if all others had a fault" in found.mismatch[0].text
    # Beside "99 % of the misfit lies in record 'r3'" the list ended with 60 % in the same.
    assert [r.variable for r in found.mismatch].count(Variable.RECORD) == 1
    assert "in record 'r3' the viscous and yield force is 1.68 times" in remaining_text(found)


@pytest.mark.long
def test_a_record_that_tells_nothing_is_not_said_to_be_whole(recordings: Any) -> None:
    """The first drive has hardly any field, and was listed as one of those without the fault."""
    onsets = tuple(NEVER if r == 3 else 0.0 for r in range(6))
    found = diagnosed(recordings("electrical_fault", onsets, 76))
    assert found.once is not None
    assert found.once.records == (1, 2, 4, 5)
    assert found.once.silent == {0}
    assert found.once.odd == (3,)


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", [31, 32, 33])
def test_nothing_is_sought_in_vain(seed: int, recordings: Any) -> None:
    """In healthy drives, in those of which every one has it, and where the log's time goes on."""
    healthy = recordings("oil_leakage", (), seed)
    assert sought(healthy) is None
    stays = recordings("oil_leakage", STAYS, seed)
    goes_on = sought(replace(stays, t=running_time(stays.t, stays.starts)))
    assert goes_on is None or not goes_on.stays
    assert sought(stays.select([0])) is None


def diagnosed(recording: Recording) -> Diagnosis:
    candidates = [*FAULTS, get("preyield_viscosity")]
    run = partial(diagnose, candidates=candidates, jobs=1, limits=False)
    return with_a_fault_once(run, recording)


@pytest.mark.long
@pytest.mark.parametrize(
    "onsets", [STAYS, pytest.param(ONCE, marks=pytest.mark.long)], ids=["stays", "once"]
)
def test_it_is_said_with_all_that_a_second_search_finds(
    onsets: tuple[float, ...], recordings: Any
) -> None:
    found = diagnosed(recordings("oil_leakage", onsets))
    document = to_json(found)
    assert found.verdict is Verdict.UNEXPLAINED  # no law in each record's time says it
    once = document["sets_in_once"]
    assert (once["effect"], once["record"]) == ("oil_leakage", "r1")
    assert once["in_later_records"] == (onsets is STAYS)
    assert once["interval"][0] <= 4.4 <= once["interval"][1]
    assert once["f"] == pytest.approx(0.6, abs=0.02)
    assert once["beside"] == ["preyield_viscosity"]
    assert once["explained"]
    assert "of a fault at" in document["mismatch"][0]["text"]
    text = remaining_text(found)
    assert "oil_leakage that sets in once" in text
    assert ("their time goes on" in text) == (onsets is STAYS)
    assert ("--where record=r1" in text) == (onsets is ONCE)


@pytest.mark.long
def test_a_fault_all_along_is_said_with_its_records(recordings: Any) -> None:
    """In any of them; the damper may have been mended in between."""
    recording = recordings("oil_leakage", (NEVER, 0.0, NEVER, 0.0, NEVER), 75)
    found = diagnosed(recording)
    document = to_json(found)
    once = document["sets_in_once"]
    assert found.verdict is Verdict.UNEXPLAINED
    assert (once["effect"], once["records"]) == ("oil_leakage", ["r1", "r3"])
    assert once["all_along"]
    assert not once["in_later_records"]
    assert once["f"] == pytest.approx(0.6, abs=0.02)
    assert once["explained"]
    assert "in records 'r1', 'r3', as of a fault all along" in document["mismatch"][0]["text"]
    text = remaining_text(found)
    assert "oil_leakage all along records 'r1', 'r3' leaves" in text.replace(
        " (or deformation_fault, from which these data do not tell it)", ""
    )
    assert "--where" not in text  # no one record holds its law


@pytest.mark.long
@pytest.mark.parametrize("spread", [0.02, pytest.param(0.1, marks=pytest.mark.long)])
def test_records_whose_gains_scatter_have_no_fault(spread: float, recordings: Any) -> None:
    """As of a rig that is off, however far."""
    recording = recordings("oil_leakage", (NEVER,) * 6, 76)
    gains = 1.0 + spread * np.array([0.3, -1.2, 0.8, -0.4, 1.6, -1.1])
    force = recording.force * np.repeat(gains, np.diff(recording.starts))
    assert diagnosed(replace(recording, force=force)).once is None


def test_a_record_that_shows_nothing_of_a_force_is_none_of_a_fault(recordings: Any) -> None:
    """Without a duty there is no yield force that could be less."""
    recording = recordings("electrical_fault", (NEVER, 0.0, NEVER, NEVER, NEVER), 77)
    duty, idle = recording.duty.copy(), recording.slices[4]
    duty[idle] = 0.0
    problem = prepare(replace(recording, duty=duty))
    effects = (get("preyield_viscosity"),)
    start = {name: q.start for name, q in Model(effects).quantities.items()}
    best = fit_hypothesis(problem, effects, [start])
    assert 4 not in apart(best, get("electrical_fault"))


@pytest.mark.long
@pytest.mark.parametrize("seed", [41, 43])
def test_a_fault_in_the_end_of_one_record_is_not_called_noise(seed: int, recordings: Any) -> None:
    """It takes a few per cent of the square: all that looks for any misfit sees nothing."""
    recording = recordings("electrical_fault", (NEVER, NEVER, 6.4, NEVER, NEVER), seed, left=0.7)
    found = diagnosed(recording)
    assert found.verdict is Verdict.UNEXPLAINED
    once = to_json(found)["sets_in_once"]
    assert (once["effect"], once["record"]) == ("electrical_fault", "r2")
    assert once["f"] == pytest.approx(0.7, abs=0.02)
    assert once["interval"][0] - 0.01 <= 6.4 <= once["interval"][1] + 0.01


@pytest.mark.parametrize(
    "seed", [pytest.param(seed, marks=pytest.mark.long) for seed in (52, 53, 55, 56)]
)
def test_what_is_a_single_place_to_a_search_is_fitted_beside_its_names(
    seed: int, recordings: Any
) -> None:
    """A fifth of the damper in the last seconds of one record of six; 55 rests when it sets in."""
    onsets = (NEVER, NEVER, 6.4, NEVER, NEVER, NEVER)
    found = diagnosed(recordings("deformation_fault", onsets, seed, 0.8))
    assert found.verdict is Verdict.UNEXPLAINED
    assert found.once is not None
    assert found.once.confirmed is not None
    assert (found.once.effect.name, found.once.record) == ("deformation_fault", 2)
    assert "oil_leakage" in found.once.confirmed.alike  # but for the gas it is the same
    assert found.once.confirmed.explained
    assert found.once.at[0] <= 6.4 <= found.once.at[1]
    assert found.once.f == pytest.approx(0.8, abs=0.02)
    assert found.once.confirmed.beside == tuple(e.name for e in found.selection.named)


@pytest.mark.long
def test_records_are_those_that_can_be_used(recordings: Any) -> None:
    """One whose force has the wrong sign is left out, and those behind it keep their names."""
    recording = recordings("oil_leakage", (NEVER, *STAYS))
    force = recording.force.copy()
    force[recording.slices[0]] *= -1.0
    found = diagnosed(replace(recording, force=force))
    assert len(found.problem.recording.names) == 4
    once = to_json(found)["sets_in_once"]
    assert (once["effect"], once["record"]) == ("oil_leakage", "r2")
    assert once["interval"][0] <= 4.4 <= once["interval"][1]


@pytest.mark.long
def test_what_the_second_search_does_not_name_is_not_said(recordings: Any) -> None:
    calls: list[dict[str, Any]] = []
    found = diagnosed(recordings("oil_leakage", STAYS))
    found = replace(found, selection=found.selection.nothing, findings=())

    def run(recording: Recording, **options: Any) -> Diagnosis:
        calls.append(options)
        return replace(found, once=None) if options else found

    # Nor does it take most of what is missing beside the names, as there are none.
    answer = with_a_fault_once(run, recordings("oil_leakage", STAYS))
    assert answer.once is None
    assert calls[:2] == [{}, {"limits": False, "learning": False, "once": False}]
    assert [c["once"] for c in calls[2:]] == [False]
    assert "sets_in_once" not in to_json(answer)


@pytest.mark.long
def test_a_name_that_no_search_with_the_fault_has_is_not_kept_for_it(recordings: Any) -> None:
    """Of two records one with the fault: what bent a little like it took most of the other."""
    recording = recordings("oil_leakage", STAYS)
    calls: list[dict[str, Any]] = []

    def run(r: Recording, **options: Any) -> Diagnosis:
        calls.append(options)
        candidates = [*FAULTS, get("preyield_viscosity")]
        found = diagnose(r, candidates, **{"limits": False, **options})
        with_the_fault = options.get("once") is False and options.get("limits") is False
        kept = [f for f in found.findings if f.effect.sets_in or not with_the_fault]
        return replace(found, findings=tuple(kept))

    answer = with_a_fault_once(run, recording)
    assert [(c["once"], c["learning"], c["apart"]) for c in calls[2:]] == [(False, False, ())]
    assert answer.once is not None
    assert answer.once.effect.name == "oil_leakage"
    assert answer.findings == ()  # as most of the misfit stays in the records with the fault


def test_a_record_that_shows_nothing_of_the_force_is_not_accused() -> None:
    """An electrical fault takes as much of a record without a duty as if that had none: a log with
    the fault in record 5 of six (a car, seed 472) was said to have it in 3 as well."""
    fault = get("electrical_fault")
    begins = np.array([0.0, 10.0, 20.0, 30.0, 40.0, 50.0])
    found = SetsInOnce(fault, (0, 1, 2, 4, 3, 5), 4, True, (30.0, 30.0), 0.37, (fault,))
    alone = found.of_those((0, 1, 2, 4, 5), begins)
    assert alone.records == (5,)
    assert alone.at == (50.0, 50.0)
    assert sorted(alone.order) == list(range(6))
    assert found.of_those(range(6), begins) is found
    stays = SetsInOnce(fault, (0, 1, 2, 3, 4, 5), 3, True, (30.0, 30.0), 0.37, (fault,))
    assert stays.of_those((0, 1, 2, 3, 5), begins) is stays  # it is there from one record on


@pytest.mark.long
def test_what_is_said_in_the_end_is_of_the_records_that_tell_of_it(recordings: Any) -> None:
    """Before the drive with the fault come two without a duty, r3 and r4: both were accused, the
    onset "0 to 8 s" of r3."""
    healthy = (NEVER,) * 6
    recording = recordings("electrical_fault", (*healthy[:5], 0.0), 75, 0.4)
    idle = recordings("electrical_fault", (*healthy[:3], 0.0, *healthy[4:]), 75, 0.0)
    of_3 = recording.slices[3]
    duty, force = recording.duty.copy(), recording.force.copy()
    duty[of_3], force[of_3] = 0.0, idle.force[of_3]  # as if it had had none
    fault = get("electrical_fault")
    both = SetsInOnce(fault, (0, 1, 2, 4, 3, 5), 4, True, (0.0, 0.0), 0.4, FAULTS)
    candidates = [*FAULTS, get("preyield_viscosity")]

    def run(r: Recording, **options: Any) -> Diagnosis:
        found = diagnose(
            r, candidates=candidates, jobs=1, limits=False, learning=False,
            once=options.get("once", True),
        )  # fmt: skip
        return found if options else replace(found, once=both)

    found = with_a_fault_once(run, replace(recording, duty=duty, force=force)).once
    assert found is not None
    assert (found.records, found.whole, found.at) == ((5,), True, (0.0, 0.0))
    assert found.f == pytest.approx(0.4, abs=0.05)


def test_where_it_stays_the_first_that_tells_of_it_has_it_from_its_beginning() -> None:
    """It has set in in one of those before, which say nothing; those behind have it as well."""
    fault = get("electrical_fault")
    begins = 10.0 * np.arange(6)
    found = SetsInOnce(fault, (0, 1, 2, 3, 4, 5), 2, False, (21.0, 29.0), 0.4, (fault,))
    later = found.of_those((0, 1, 3, 5), begins)
    assert (later.records, later.whole, later.at, later.stays) == (
        (3, 4, 5), True, (30.0, 30.0), True
    )  # fmt: skip
    assert found.of_those((0, 2), begins) is found


@pytest.mark.long
def test_what_stays_of_a_fault_takes_no_name_from_what_acts_everywhere(recordings: Any) -> None:
    """A record with 0.7 of its force left more than a drift of the zero took, so that nothing was
    named (a log of the plant, seed 1660010, a gain of 0.7 in record 5 of nine)."""
    recording = recordings("electrical_fault", (NEVER, NEVER, 0.0, NEVER), 75, 0.2)
    problem = prepare(recording)
    model = (get("preyield_viscosity"),)
    start = {name: q.start for name, q in Model(model).quantities.items()}
    base, best = fit_hypothesis(problem, (), [{}]), fit_hypothesis(problem, model, [start])
    none = fit_hypothesis(problem, (get("fluid_inertia"),), [{"fluid_inertia.m": 0.01}])
    fault = SetsInOnce(get("electrical_fault"), (0, 1, 3, 2), 3, True, (0.0, 0.0), 0.2, FAULTS)
    left = lack_of_fit_of(best)
    parts = {
        (h, of): part_taken(Selection(base, h, (), {}, {}), left, of)
        for h in (best, none)
        for of in (None, fault)
    }
    print(sorted(parts.values()))
    assert not earned(parts[best, None])
    assert earned(parts[best, fault])
    assert not earned(parts[none, fault])


def test_a_record_of_which_a_fault_takes_all_tells_of_it(recordings: Any) -> None:
    """There is no force left in it whose gain could be told; without the fault there would be."""
    recording = recordings("electrical_fault", (NEVER, NEVER, 0.0, NEVER), 75, 0.0)
    fault = get("electrical_fault")
    order = (0, 1, 3, 2)
    ordered = recording.select(order)
    problem = prepare(replace(ordered, t=running_time(ordered.t, ordered.starts)))
    begin = float(problem.recording.t[problem.recording.starts[3]])
    start = {name: q.start for name, q in Model((fault,)).quantities.items()}
    onset = {"electrical_fault.f": 0.0, "electrical_fault.t_0": begin, "electrical_fault.t_r": 0.0}
    best = fit_hypothesis(problem, (fault,), [start | onset], 1)
    assert best.values["electrical_fault.f"] == pytest.approx(0.0, abs=1e-6)
    assert [order[k] for k in telling(best, fault)] == list(order)

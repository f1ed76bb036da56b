"""A sealed case: what is written, that the diagnosis sees the log alone, when the key is opened."""

from __future__ import annotations

import hashlib
import json
import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pyarrow.parquet as pq
import pytest
from results import document

from erdctl.core.errors import ComputationProblem, UsageProblem
from erdctl.core.recording import Recording
from erdctl.diagnose.problem import prepare
from erdctl.effects import get, names
from erdctl.io.logs import read_logs
from erdctl.plant import draw, log
from erdctl.prove import judge as judging
from erdctl.prove.best import best_fit, damper_values
from erdctl.prove.case import Sealed, Wish, check, opened, seal
from erdctl.prove.score import Errors

SEED = 32
WISH = Wish(effects=("coulomb_friction",), level=3.0, motion="exact")


@pytest.fixture(scope="module")
def sealed(tmp_path_factory: pytest.TempPathFactory) -> Sealed:
    return seal(WISH, SEED, 1, tmp_path_factory.mktemp("case"))


def test_the_hash_is_that_of_the_key_file(sealed: Sealed) -> None:
    data = sealed.key.read_bytes()
    assert sealed.sha256 == hashlib.sha256(data).hexdigest()
    assert opened(sealed) == json.loads(data)
    assert opened(sealed)["effects"][0]["name"] == "coulomb_friction"


def test_a_key_that_was_changed_is_refused(sealed: Sealed, tmp_path: Path) -> None:
    changed = tmp_path / "key.json"
    changed.write_bytes(sealed.key.read_bytes().replace(b"coulomb", b"stribeck"))
    with pytest.raises(ComputationProblem, match="has changed"):
        opened(replace(sealed, key=changed))


def test_the_log_holds_the_contract_and_nothing_else(sealed: Sealed) -> None:
    table = pq.read_table(sealed.log)
    assert table.column_names == ["t", "x", "xdot", "duty", "force", "record"]
    assert table.schema.metadata is None
    assert sealed.log.name == "case-001.parquet"
    assert table.equals(
        log(draw(SEED, known=names(), effects=["coulomb_friction"], level=3.0, motion="exact"))
    )


def test_the_diagnosis_is_given_the_log_alone(
    sealed: Sealed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = shutil.copy(sealed.log, tmp_path / "case-001.parquet")
    asked = []

    def diagnose(*given: object, **more: object) -> SimpleNamespace:
        asked.append((given, more))
        return SimpleNamespace(once=None)

    monkeypatch.setattr(judging, "diagnose", diagnose)
    judging.examine(Path(alone))
    (((recording,), more),) = asked
    assert isinstance(recording, Recording)
    assert [e.name for e in more.pop("candidates")] == list(names())
    assert more == {"limits": False}


def test_the_key_is_opened_after_the_diagnosis_is_written(
    sealed: Sealed, monkeypatch: pytest.MonkeyPatch
) -> None:
    said = document("explained", ("coulomb_friction",))
    monkeypatch.setattr(judging, "examine", lambda path, without: None)
    monkeypatch.setattr(judging, "to_json", lambda found: said)
    monkeypatch.setattr(judging, "_errors", lambda *given: Errors(2.0, 1.0, 1.0, 10.0))
    written = []

    def watched(case: Sealed) -> object:
        written.append(json.loads(case.diagnosis.read_bytes()))
        return opened(case)

    monkeypatch.setattr(judging, "opened", watched)
    result = judging.judge(sealed)
    assert written == [said]
    assert (result.named, result.verdict, result.seed) == (True, "explained", SEED)
    assert result.hidden[0].level == pytest.approx(3.0, rel=0.1)


def test_the_true_structure_refitted_reaches_the_noise(sealed: Sealed) -> None:
    key = opened(sealed)
    recording = read_logs([str(sealed.log)], need_force=True, report=print).recording
    problem = prepare(recording)
    reached = best_fit(problem, [get("coulomb_friction")], damper_values(key), {})
    rms = np.sqrt(np.average(reached.residual**2, weights=problem.block.weight))
    assert rms == pytest.approx(key["force_noise"]["rms"], rel=0.02)
    friction = key["effects"][0]["parameters"]["F_c"]["value"]
    assert reached.values["coulomb_friction.F_c"] == pytest.approx(friction, rel=0.05)


@pytest.mark.parametrize(
    ("wish", "message"),
    [
        (Wish(effects=("phlogiston",)), "no such effect to hide: phlogiston"),
        (Wish(kind="triple"), "kind is 'triple'"),
        (Wish(concealment="buried"), "concealment is 'buried'"),
        (Wish(motion="still"), "motion is 'still'"),
        (Wish(colour="mauve"), "colour is 'mauve'"),
        (Wish(level=0.0), "--level is 0"),
        (Wish(level=float("nan")), "--level is nan"),
        (Wish(kind="null", effects=("backlash",)), "hides nothing"),
        (Wish(kind="pair", effects=("backlash",)), "nothing to pair backlash with"),
    ],
)
def test_wishes_that_make_no_sense(wish: Wish, message: str) -> None:
    with pytest.raises(UsageProblem, match=message):
        check(wish, range(3))


def test_wishes_that_make_sense() -> None:
    check(Wish(), range(20))
    check(Wish(kind="unknown", level=4.0), range(3))
    check(Wish(effects=("backlash", "end_stop"), concealment="absorbed"), range(3))

"""`erdctl prove --on`: effects hidden in a user's own recording."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import jsonschema
import numpy as np
import pandas as pd
import pytest
from dampers import damper
from rig import campaign, noisy
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.diagnose.detectable import Injection
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.record_effects import NONE_VARY
from erdctl.model.parameters import Parameters
from erdctl.prove import on_log
from erdctl.prove.on_log import Host, Trial, hideable
from erdctl.prove.on_log_document import json_schema, line, tables


def run(*arguments: object, code: int = 0) -> Any:
    """The command in this process, which has its libraries loaded; its trials are in others."""
    words = ["prove", *map(str, arguments)]
    done = CliRunner().invoke(build(["prove"]), words, catch_exceptions=False)
    assert done.exit_code == code, done.stderr
    assert "Traceback" not in done.stderr
    return done


@pytest.fixture
def log(tmp_path: Path) -> Path:
    r = noisy(campaign(50.0, 4.0), seed=77)
    path = tmp_path / "bench.csv"
    records = [name for name, part in zip(r.names, r.slices, strict=True) for _ in r.t[part]]
    columns = {"t": r.t, "x": r.x, "xdot": r.xdot, "duty": r.duty, "force": r.force}
    pd.DataFrame({**columns, "record": records}).to_csv(path, index=False)
    return path


def test_a_large_effect_is_found_and_nothing_is_not(
    log: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    diagnosed: list[Host] = []

    def once(*given: Any) -> Host:
        """The log as it is, diagnosed for the first run and taken as it was for the second."""
        if not diagnosed:
            diagnosed.append(host(*given))
        return diagnosed[0]

    host = on_log.host
    monkeypatch.setattr(on_log, "host", once)
    kept = tmp_path / "kept"
    options = ["--on", log, "--effects", "quadratic_damping", "--sizes", "0.02,2", "--nulls", 1,
               "--jobs", 1, "--keep", kept, "--json"]  # fmt: skip
    document = json.loads(run(*options).stdout)
    jsonschema.validate(document, json_schema(), cls=jsonschema.Draft202012Validator)
    small, large = document["trials"]
    assert [small["found"], large["found"]] == [False, True]
    assert large["size"] == pytest.approx(2.0, rel=0.05)
    assert large["beyond_rms"] == pytest.approx(2.0 * large["local_noise_rms"], rel=0.05)
    # Beyond noise alone, local noise is noise.
    assert large["local_noise_rms"] == pytest.approx(0.3, rel=0.3)
    assert document["named"] == document["again"] == document["nulls"][0]["said"] == []
    (found,) = document["summary"]["effects"]
    assert found["size"] == 2.0
    assert found["parameters"] == large["parameters"]

    # The paper's model absorbs to first order what it absorbs at all.
    hiding = on_log.Hiding(diagnosed[0])
    s = diagnosed[0].found.problem.block.signals
    rubs = 2.0 * np.sign(s.xdot)
    first, again = (float(np.std(f(rubs))) for f in (hiding.injection.beyond, hiding._refitted))
    assert again == pytest.approx(first, rel=0.05)
    hiding.force = 0.01
    (trial,) = hiding.trials("quadratic_damping", [2.0])
    assert trial.skipped is not None
    assert "another damper" in trial.skipped

    # What is kept is not done again: an outcome that was changed there comes back changed.
    (file,) = kept.glob("quadratic_damping-*.json")
    file.write_text(file.read_text().replace('"found":true', '"found":false'))
    again = json.loads(run(*options).stdout)
    assert [t["found"] for t in again["trials"]] == [False, False]


def test_what_does_not_go_together_is_refused(log: Path) -> None:
    assert "--kind does not go with --on" in run("--on", log, "--kind", "null", code=2).stderr
    assert "expected sizes" in run("--on", log, "--sizes", "1,-2", code=2).stderr
    assert "cannot hide nonsense" in run("--on", log, "--effects", "nonsense", code=2).stderr


def test_effects_can_be_chosen() -> None:
    assert hideable(["backlash"]) == ["backlash"]
    assert len(hideable(None)) > 20


def trial(effect: str | None, wanted: float, found: bool | None, **more: Any) -> Trial:
    values = {"g": (1e-4 * wanted, "m")}
    return Trial(effect, wanted, wanted, values, wanted, wanted, 1.0, found, **more)


def test_found_from_the_size_from_which_all_larger_are() -> None:
    trials = [
        trial("a", 1.0, found=True), trial("a", 2.0, found=False), trial("a", 4.0, found=True),
        trial("b", 1.0, found=None, skipped="is in the log already"),
        trial(None, 0.0, found=None, said=("c",), verdict="explained"),
        trial(None, 0.0, found=None, verdict="adequate"),
    ]  # fmt: skip
    effects, shares, skipped = tables(trials)
    assert effects[2] == [["a", "yes", "no", "yes", "g 0.4 mm", "4 N"]]
    assert shares[2][-1] == ["nothing", "1", "2", "50 %"]
    assert skipped[2] == [["b", "1", "is in the log already"]]
    assert "found no" in line(trials[1])
    assert "nothing hidden" in line(trials[-1])


def test_an_effect_that_one_size_cannot_have_is_not_said_to_be_hidden_at_none() -> None:
    far = "it would be another damper: 9 N rms where the log has 3 N"
    trials = [
        trial("a", 1.0, found=True),
        trial("a", 2.0, found=None, skipped=far),
        trial("a", 4.0, found=None, skipped=far),
        trial("a", 8.0, found=None, skipped="cannot be diagnosed: why"),
    ]
    *_, skipped = tables(trials)
    assert skipped[2] == [["a", "2 4", far], ["a", "8", "cannot be diagnosed: why"]]


def hiding_in(given: Parameters) -> tuple[on_log.Hiding, Hypothesis]:
    """What hides effects in a log of a damper, and that damper's own fit."""
    clean = campaign(100.0, 6.0)
    force = given.model.force(prepare(clean, NONE_VARY).block.signals, given.values)
    problem = prepare(noisy(replace(clean, force=force), 5, 0.2), NONE_VARY)
    best = fit_hypothesis(problem, given.model.effects, [given.values])
    hiding = object.__new__(on_log.Hiding)
    found = SimpleNamespace(problem=problem, selection=SimpleNamespace(best=best))
    hiding.host, hiding.rest = cast("Host", SimpleNamespace(found=found)), best.residual
    return hiding, best


def test_a_size_is_what_a_model_leaves_that_may_bend() -> None:
    """A shear thinning takes up more of a large friction than its slopes say."""
    hiding, best = hiding_in(damper("shear_thinning", n=0.3))
    problem = best.problem
    rubs = 15.0 * problem.block.signals.sign
    weight = problem.block.weight
    first, again = (
        float(np.sqrt(np.average(f(rubs) ** 2, weights=weight)))
        for f in (Injection(problem, best).beyond, hiding._refitted)
    )
    assert again < 0.8 * first


def test_a_refit_begins_on_the_samples_of_a_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """To all samples at once one was stuck with 4,244 N where a diagnosis leaves 1,455 N."""
    hiding, best = hiding_in(damper("coulomb_friction", F_c=5.0))
    problem = best.problem
    fits: list[tuple[int, list[float]]] = []

    def watched(problem: Any, effects: Any, starts: Any, **more: Any) -> Any:
        found = fit_hypothesis(problem, effects, starts, **more)
        friction = [start["coulomb_friction.F_c"] for start in starts]
        fits.append((len(problem.block.force), [*friction, found.values["coulomb_friction.F_c"]]))
        return found

    monkeypatch.setattr(on_log, "fit_hypothesis", watched)
    monkeypatch.setattr(on_log.thresholds, "SEARCH_SAMPLES", 600)
    # What is added is friction: all of it is absorbed.
    beyond = hiding._refitted(3.0 * problem.block.signals.sign)
    (few, searched), (whole, refitted) = fits
    assert few < whole == len(problem.block.force)
    assert searched[-1] == pytest.approx(8.0, abs=0.3)
    assert refitted[0] == searched[-1]
    assert float(np.std(beyond)) < 0.05

"""Logs that begin and end at rest, where a velocity that is measured is noise."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from click.testing import Result
from rig import campaign, noisy
from typer.testing import CliRunner

import erdctl
from erdctl.bench.unknown_direction import unknown_direction
from erdctl.cli.app import build
from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get

RATE, REST, MOVES = 500.0, 2.0, 4.0  # Hz, s
TABLE_2 = Path(__file__).parents[2] / "fixtures" / "table_2.json"


def rested(noise: float, seed: int = 0) -> pd.DataFrame:
    """Three records of a damper of Table 2, with a rest before and after: noise of the speed."""
    random, frames = np.random.default_rng(seed), []
    for duty in (0.1, 0.2, 0.3):
        t = np.arange(int((MOVES + 2.0 * REST) * RATE)) / RATE
        moves = (t >= REST) & (t < REST + MOVES)
        w, s = 2.0 * np.pi * 1.5, t - REST
        x = np.where(moves, 0.01 * np.sin(w * s), 0.0)
        true = np.where(moves, 0.01 * w * np.cos(w * s), 0.0)
        table = pd.DataFrame({"t": t, "x": x, "xdot": true, "duty": duty})
        force = erdctl.simulate(TABLE_2, table).force
        noises = random.standard_normal((3, len(t)))
        frames.append(
            pd.DataFrame(
                {
                    "record": f"{duty:g}", "t": t, "x": x + 1e-6 * noises[0],
                    "xdot": true + noise * 0.01 * w * noises[1], "duty": duty,
                    "force": force + 0.1 * noises[2],
                }
            )
        )  # fmt: skip
    return pd.concat(frames, ignore_index=True)


def called(*words: str) -> Result:
    return CliRunner().invoke(build([words[0]]), [*words], catch_exceptions=False)


@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_validate_says_of_what_its_error_is(noise: float, tmp_path: Path) -> None:
    """The model that made the log was at 0.3 of the range, and nothing said why."""
    table = rested(noise)
    log = tmp_path / "rested.csv"
    table.to_csv(log, index=False)
    done = called("validate", str(TABLE_2), str(log), "--json")
    document = json.loads(done.stdout)
    said = "xdot is noise there" in " ".join(done.stderr.split())
    assert said == ("direction_unknown" in document) == (noise > 0.0)
    if not said:
        assert document["nrmse"] < 0.01
        return
    unknown = document["direction_unknown"]
    assert document["nrmse"] > 0.1
    still = 2.0 * REST / (MOVES + 2.0 * REST)
    assert still < unknown["samples"] < still + 0.05
    assert unknown["squared_error"] > 0.9
    # By numpy of the samples that move, and of the same denominator.
    modelled = erdctl.simulate(TABLE_2, table).force
    moves = np.abs(table["xdot"]) > 0.05 * table["xdot"].max()
    error = np.sqrt(np.mean((table["force"] - modelled)[moves] ** 2)) / np.ptp(table["force"])
    assert unknown["nrmse_of_others"] == pytest.approx(error, rel=0.2)
    assert erdctl.validate(TABLE_2, table).to_dict()["direction_unknown"] == pytest.approx(
        unknown, rel=1e-6
    )


def test_no_error_at_a_rest_is_that_of_a_wrong_model() -> None:
    """One that is wrong where the rod moves as well."""
    r = campaign()
    signals = Signals.of(r)
    assert unknown_direction(signals, 3.0 + 0.0 * r.xdot) is None
    assert unknown_direction(signals, np.zeros(len(r))) is None


def with_rests(r: Recording) -> Recording:
    """Of every record the last third at rest: noise of the speed, and a force of friction there."""
    random = np.random.default_rng(1)
    x, xdot, force = r.x.copy(), r.xdot.copy(), np.array(r.force)
    for part in r.slices:
        n = part.stop - part.start
        rest: Array = np.arange(part.start + 2 * n // 3, part.stop)
        x[rest] = x[rest[0]]
        xdot[rest] = 0.0
        force[rest] = 0.0
    speed = float(np.std(xdot))
    return replace(r, x=x, xdot=xdot + 0.01 * speed * random.standard_normal(len(r)), force=force)


def test_a_diagnosis_says_what_remains_where_the_rod_moves() -> None:
    """9 N "is noise as far as these data tell" was said of a log with 0.3 N of noise."""
    found = diagnose(
        noisy(with_rests(campaign()), seed=4), [get("coulomb_friction")], limits=False,
        learning=False,
    )  # fmt: skip
    assert found.verdict is Verdict.ADEQUATE
    said = remaining_text(found)
    rms = float(said.split("what remains, ")[1].split(" N rms")[0])
    assert rms == pytest.approx(found.lack_of_fit.noise_rms, rel=0.3)
    assert rms < 0.3 * found.carried.overall.rms
    assert "where xdot is noise" in said

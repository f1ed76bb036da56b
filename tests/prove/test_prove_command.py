"""`erdctl prove` as a user calls it."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from concurrent.futures import Executor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.core.blocks import thinned
from erdctl.effects import get
from erdctl.plant import key
from erdctl.plant.draw import draw
from erdctl.prove import judge
from erdctl.prove import run as prove_run
from erdctl.prove.case import Wish
from erdctl.prove.document import Proof, from_json
from erdctl.prove.judge import Failed, Result
from erdctl.prove.run import prove

ERDCTL = [sys.executable, "-m", "erdctl", "prove"]
SEED = 214  # this and the next have short campaigns


def run(*arguments: object, code: int = 0) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([*ERDCTL, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    assert "Traceback" not in done.stderr
    return done


def run_here(*arguments: object, code: int = 0) -> Any:
    """The command in this process, which has its libraries loaded."""
    words = ["prove", *map(str, arguments)]
    done = CliRunner().invoke(build(["prove"]), words, catch_exceptions=False)
    assert done.exit_code == code, done.stderr
    assert "Traceback" not in done.stderr
    return done


class Elsewhere:
    """Stands in for a cluster; tests/campaign has a real one."""

    def executor(self) -> Executor:
        return ThreadPoolExecutor(2)


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cases in threads of this process; their diagnoses see few samples and two effects.

    What is found does not matter to the order in which things are done, shown and kept. The test
    of one case has processes, all samples and the whole catalogue.
    """
    read, few = judge._read, [get("coulomb_friction"), get("backlash")]
    monkeypatch.setattr(judge, "_read", lambda path: thinned(read(path), 2500))
    monkeypatch.setattr(judge, "candidates", lambda exclude: few)
    monkeypatch.setattr(prove_run, "workers", ThreadPoolExecutor)


def check_kept(proof: Proof, kept: Path, lines: list[str]) -> None:
    """Keys, logs and diagnoses of a proof; the hash of each key is shown before its score is."""
    for result in proof.results:
        assert isinstance(result, Result)
        data = (kept / "keys" / f"case-{result.number:03d}.json").read_bytes()
        assert result.key_sha256 == hashlib.sha256(data).hexdigest()
        assert json.loads(data)["seed"] == key(draw(result.seed, kind="null"))["seed"]
        (shown,) = [
            i for i, line in enumerate(lines) if line.endswith(f"sha256 {result.key_sha256}")
        ]
        (scored,) = [i for i, line in enumerate(lines) if line.startswith(f"seed {result.seed} ")]
        assert shown < scored
        table = pq.read_table(kept / "logs" / f"case-{result.number:03d}.parquet")
        assert table.column_names == ["t", "x", "xdot", "duty", "force", "record"]
        found = json.loads((kept / "diagnoses" / f"case-{result.number:03d}.json").read_text())
        assert found["verdict"] == result.verdict


@pytest.mark.long
def test_a_case_from_seed_to_scoreboard(tmp_path: Path) -> None:
    """In processes, by the whole catalogue."""
    kept, out = tmp_path / "kept", tmp_path / "proof.json"
    done = run("--seed", SEED, "--cases", 1, "--kind", "null", "--jobs", 2, "--keep", kept,
               "-o", out, "--json")  # fmt: skip
    document = json.loads(done.stdout)
    assert document == json.loads(out.read_text())
    check_kept(from_json(document), kept, done.stderr.splitlines())
    assert "Nothing hidden, by the colour of the noise" in done.stderr


@pytest.mark.usefixtures("quick")
def test_two_cases_are_kept_and_taken_up(tmp_path: Path) -> None:
    """One test, as under xdist every process that had a part of it would run the cases anew."""
    kept, out = tmp_path / "kept", tmp_path / "proof.json"
    done = run_here("--seed", SEED, "--cases", 2, "--kind", "null", "--jobs", 2, "--keep", kept,
                    "-o", out, "--json")  # fmt: skip
    document = json.loads(done.stdout)
    assert document == json.loads(out.read_text())
    proof = from_json(document)
    assert [r.seed for r in proof.results] == [SEED, SEED + 1]
    check_kept(proof, kept, done.stderr.splitlines())
    assert "Nothing hidden, by the colour of the noise" in done.stderr

    # Taken up without one of them, which comes out as before: the key first, then the diagnosis.
    for folder in ("results", "diagnoses"):
        (kept / folder / "case-002.json").unlink()
    sealed = []
    again = prove(
        Wish(kind="null"), [SEED, SEED + 1], kept, jobs=1,
        on_sealed=lambda s: sealed.append((s.sha256, s.diagnosis.exists())),
    )  # fmt: skip
    assert again == proof.results
    assert sealed == [(proof.results[1].key_sha256, False)]

    asked = ("--kind", "null", "--jobs", 1, "--keep", kept, "--json")
    taken_up = run_here("--seed", SEED, "--cases", 2, *asked)
    assert json.loads(taken_up.stdout) == document
    assert taken_up.stderr.count("sha256") == 0
    other = run_here("--seed", SEED + 1, "--cases", 1, *asked, code=2)
    assert "another seed" in other.stderr
    assert len(other.stderr.splitlines()) == 1


@pytest.mark.parametrize("cluster", [None, Elsewhere()], ids=["here", "elsewhere"])
def test_a_case_that_fails_does_not_take_the_others_with_it(cluster: Any, tmp_path: Path) -> None:
    numbers: list[int] = []
    outcomes = prove(
        Wish(kind="triple"), [3, 4], tmp_path, jobs=1, cluster=cluster,
        on_outcome=lambda o: numbers.append(o.number),
    )  # fmt: skip
    assert [(o.number, o.seed) for o in outcomes] == [(1, 3), (2, 4)]
    assert numbers == [1, 2]
    assert all(isinstance(o, Failed) and "kind is 'triple'" in o.message for o in outcomes)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--effects", "phlogiston"],
        ["--kind", "triple"],
        ["--level", "0"],
        ["--motion", "still"],
        ["--concealment", "buried"],
        ["--colour", "mauve"],
        ["--kind", "null", "--effects", "backlash"],
        ["-o", "/no/such/folder/proof.json"],
        ["--cluster", "tcp://a:1"],
        ["--cluster", "tcp://a:1", "--nulls", "3"],
    ],
)
def test_wrong_usage_is_one_line(arguments: list[str]) -> None:
    assert len(run_here(*arguments, code=2).stderr.splitlines()) == 1


def test_a_directory_that_holds_something_is_not_written_into(tmp_path: Path) -> None:
    (tmp_path / "mine").touch()
    assert "not empty" in run("--keep", tmp_path, code=2).stderr


def test_help_has_examples_and_exit_codes() -> None:
    text = run_here("--help").stdout
    assert "Examples:" in text
    assert "erdctl prove --cases 200" in text
    assert "Exit codes" in text

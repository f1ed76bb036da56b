"""No command writes over what it reads, nor over what else it writes; all its files come at once.

The tests go over the options of all commands, so that a new one cannot be forgotten.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
import typer
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli import files
from erdctl.cli.app import COMMANDS, build
from erdctl.core import leftovers
from erdctl.core.errors import ComputationProblem, UsageProblem
from erdctl.io import atomic, identity
from erdctl.io.identity import Named

APP = build()
GROUP: Any = typer.main.get_command(APP)
# A call of every command that writes files, with all of them; {name} is replaced.
CALLS = {
    "identify": "identify {logs} -o {output} --plot {plot}",
    "simulate": "simulate {params} {log} -o {output} --plot {plot}",
    "validate": "validate {arguments} {log} --report {report} --plot {plot}",
    "diagnose": "diagnose {logs} --params {params} -o {output} --report {report} --plot {plot}",
    "prove": "prove -o {output} --report {report}",
    "mimic": "mimic {params} {log} --fault oil=0.5 -o {output} --manifest {manifest}"
    " --report {report} --plot {plot}",
    "export": "export {params} -o {output}",
    "plot": "plot {logs} --params {params} --before {before} -o {output}",
    "convert": "convert {log} {output}",
    "derive": "derive {geometry} -o {output}",
    "project": "project init {logs} -o {output}",
    "compare": "compare {arguments} --limits {limits} -o {output} --report {report} --plot {plot}",
    "campaign": "campaign run {logs} -o {output}",
    "effects": "effects new bore_wear --from {source} -o {output}",
}
SUFFIX = {"report": ".html", "plot": ".png"}


def parameters(command: str) -> dict[str, Any]:
    """Options and arguments; of several commands under one word those of all."""
    found = GROUP.commands[command]
    return {p.name: p for c in (found, *getattr(found, "commands", {}).values()) for p in c.params}


def fields(command: str) -> list[str]:
    """The files in a call, in its order."""
    words = CALLS[command].split()
    return [w.strip("{}") for w in words if w.startswith("{")]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_text_is_said_to_be_a_file_or_not(command: str) -> None:
    texts = {
        p.name for p in parameters(command).values() if p.type.name in ("text", "path", "filename")
    }
    known = files.READS | files.WRITES | files.FOLDERS | files.OTHERS
    assert texts <= known, "say in erdctl/cli/files.py whether it names a file"


@pytest.mark.parametrize("command", COMMANDS)
def test_the_calls_below_hold_every_file_of_every_command(command: str) -> None:
    named = set(parameters(command)) & (files.READS | files.WRITES)
    if named & files.WRITES:
        assert named <= set(fields(command))


def pairs() -> list[tuple[str, str, str]]:
    """Every two files of a call, at least one of which is written."""
    return [
        (command, a, b) for command in CALLS for a, b in combinations(fields(command), 2)
        if {a, b} & files.WRITES
    ]  # fmt: skip


def fill(folder: Path, command: str) -> dict[str, str]:
    """Paths for all files of a call; those that are read exist."""
    out = {}
    for name in fields(command):
        path = folder / f"{name}{SUFFIX.get(name, '.json' if name != 'output' else '.csv')}"
        if name in files.READS:
            path.write_text(f"the content of {name}")
        out[name] = str(path)
    if command == "plot":
        out["output"] = str(folder / "output.png")
    return out


def listing(folder: Path) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.is_file()}


@pytest.mark.parametrize("way", ["same", "relative", "symlink", "hard link"])
@pytest.mark.parametrize(("command", "first", "second"), pairs())
def test_two_names_of_one_file_are_refused(
    command: str, first: str, second: str, way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    given = fill(tmp_path, command)
    # The one that is written takes the place of the other.
    kept, changed = (first, second) if second in files.WRITES else (second, first)
    target = Path(given[kept])
    if way == "same":
        given[changed] = str(target)
    elif way == "relative":
        given[changed] = os.path.join("..", tmp_path.name, ".", target.name)
    else:
        target.write_text("something stands here")
        other = Path(given[changed])
        other.symlink_to(target) if way == "symlink" else other.hardlink_to(target)
    before = listing(tmp_path)
    result = CliRunner().invoke(APP, CALLS[command].format(**given).split())
    assert result.exit_code == 2, result.stderr
    errors = [x for x in result.stderr.splitlines() if x.startswith("erdctl: error")]
    assert len(errors) == 1
    assert given[kept] in errors[0]
    assert given[changed] in errors[0]
    assert "would" in errors[0]
    assert listing(tmp_path) == before


def call(*words: str, **options: Any) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "erdctl", *words]
    return subprocess.run(command, capture_output=True, text=True, **options)


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copy(FIXTURES / "bad" / "good.csv", tmp_path / "log.csv")
    shutil.copy(FIXTURES / "table_2.json", tmp_path / "p.json")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(words: str) -> Any:
    return CliRunner().invoke(APP, words.split())


def test_a_name_made_from_another_is_refused_too(bench: Path) -> None:
    """The manifest is called like the output, with something behind."""
    shutil.copy("log.csv", "out.csv.manifest.json")  # a CSV by content, and the log of this run
    before = listing(bench)
    result = run("mimic p.json out.csv.manifest.json --fault oil=0.5 -o out.csv")
    assert result.exit_code == 2, result.stderr
    assert "out.csv.manifest.json" in result.stderr
    assert listing(bench) == before


@pytest.mark.parametrize(
    "words",
    ["mimic p.json log.csv --fault oil=0.5 --manifest -", "prove --json -o -"],
)
def test_two_things_never_mix_on_standard_output(words: str, bench: Path) -> None:
    result = run(words)
    assert result.exit_code == 2
    assert "standard output" in result.stderr
    assert result.stdout == ""


def test_redirected_streams_are_files_too(bench: Path) -> None:
    before = listing(bench)
    with open("log.csv", "rb") as log:
        done = call("simulate", "p.json", "-", "-o", "log.csv", stdin=log)
    assert done.returncode == 2, done.stderr
    with open("log.csv", "ab") as log:
        found = subprocess.run(
            [sys.executable, "-m", "erdctl", "convert", "log.csv", "-"],
            stdout=log, stderr=subprocess.PIPE,
        )  # fmt: skip
    assert found.returncode == 2
    assert listing(bench) == before


def test_reading_one_file_twice_is_allowed(bench: Path) -> None:
    assert run("plot log.csv --params p.json --before p.json --kind before-after -o a.png"
               ).exit_code == 0  # fmt: skip


def test_another_case_is_another_file_where_the_folder_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    upper, lower = (Named(str(tmp_path / n), n, reads=False) for n in ("M.csv", "m.csv"))
    assert identity.clash([upper], lower) is None
    monkeypatch.setattr(identity, "_ignores_case", lambda folder: True)
    assert identity.clash([upper], lower) is not None


def test_devices_may_be_read_and_written(bench: Path) -> None:
    assert run("mimic p.json log.csv --fault oil=0.5 -o /dev/null --manifest /dev/null"
               ).exit_code == 0  # fmt: skip


# --- together or not at all ----------------------------------------------------------------


def failing(words: str, bench: Path, code: int) -> str:
    before = listing(bench)
    result = run(words)
    assert result.exit_code == code, result.stderr
    assert listing(bench) == before
    return str(result.stderr)


def test_a_later_output_that_fails_takes_the_first_with_it(bench: Path) -> None:
    (bench / "out.csv").write_text("old")
    words = "mimic p.json log.csv --fault oil=0.5 -o out.csv --manifest"
    assert "does not exist" in failing(f"{words} none/m.json", bench, 2)
    (bench / "folder").mkdir()
    assert "not the name of a file" in failing(f"{words} folder", bench, 2)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_a_full_disk_at_the_last_output_leaves_none(bench: Path) -> None:
    words = "mimic p.json log.csv --fault oil=0.5 -o out.csv --manifest /dev/full"
    assert "disk full while writing /dev/full" in failing(words, bench, 4)


@pytest.mark.parametrize("count", [2, 3])
@pytest.mark.parametrize("old", [True, False])
@pytest.mark.parametrize("links", [True, False], ids=["links", "no links"])
def test_a_failed_rename_undoes_the_others(
    count: int, old: bool, links: bool, bench: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = ["out.csv", "out.html", "out.json"]
    if old:
        for name in names:
            (bench / name).write_text(f"old {name}")
    done: list[str] = []

    def replace(source: str, target: str) -> None:
        if os.path.basename(target) in names and ".erdctl" in source:
            done.append(target)
            if len(done) == count:
                raise PermissionError(13, "Permission denied")
        os.rename(source, target)

    def link(source: str, target: str) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(atomic.os, "replace", replace)
    if not links:
        monkeypatch.setattr(atomic.os, "link", link)
    words = "mimic p.json log.csv --fault oil=0.5 -o out.csv --manifest out.json --report out.html"
    assert "nothing was written" in failing(words, bench, 4)


def test_what_cannot_be_undone_is_said(bench: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def replace(source: str, target: str) -> None:
        if target.endswith("out.json"):
            raise PermissionError(13, "Permission denied")
        os.rename(source, target)

    def unlink(path: str) -> None:
        if path.endswith("out.csv"):
            raise PermissionError(13, "Permission denied")
        os.remove(path)

    monkeypatch.setattr(atomic.os, "replace", replace)
    monkeypatch.setattr(atomic.os, "unlink", unlink)
    result = run("mimic p.json log.csv --fault oil=0.5 -o out.csv --manifest out.json")
    assert result.exit_code == 4
    assert "out.csv was written already" in result.stderr
    assert "nothing was written" not in result.stderr


def test_all_appear_after_a_check_that_failed(bench: Path) -> None:
    result = run("validate p.json log.csv --fail-above 0 --report r.html --plot a.png")
    assert result.exit_code == 1
    assert {"r.html", "a.png"} <= set(listing(bench))


def test_nothing_appears_before_the_end(bench: Path) -> None:
    with atomic.together():
        for name in ("a", "b"):
            with atomic.output(name) as stream:
                stream.write(name.encode())
        assert not {"a", "b"} & set(listing(bench))
    assert listing(bench)["a"] == b"a"
    assert listing(bench)["b"] == b"b"


def test_one_file_cannot_be_written_twice_in_a_run(bench: Path) -> None:
    def twice() -> None:
        with atomic.together():
            for _ in range(2):
                with atomic.output("a") as stream:
                    stream.write(b"x")

    with pytest.raises(UsageProblem, match="a and a"):
        twice()
    assert "a" not in listing(bench)


def test_a_reader_that_has_gone_is_no_success_where_files_were_asked_for(bench: Path) -> None:
    def broken() -> None:
        with atomic.together([Named("a", "--plot", reads=False)]):
            raise BrokenPipeError

    with pytest.raises(ComputationProblem, match="reader of standard output has gone"):
        broken()


# --- signals --------------------------------------------------------------------------------

SLOW = """
import os, sys, time
from erdctl.cli import app
from erdctl.io import atomic
from erdctl.core.workers import pool

def build(names):
    def call(**options):
        with atomic.together(), atomic.output(sys.argv[1]) as stream:
            stream.write(b"half")
            workers = pool(1)
            workers.submit(time.sleep, 60)
            workers.submit(os.getpid).cancel()
            print("ready", next(iter(workers._processes)), flush=True)
            while True:  # one long sleep does not end for a signal that came just before it
                time.sleep(0.05)
    return call

app.build = build
if __name__ == "__main__":
    app.main()
"""


@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT", "SIGHUP"])
def test_a_signal_leaves_no_file_and_no_process(name: str, tmp_path: Path) -> None:
    script = tmp_path / "slow.py"
    script.write_text(SLOW)
    folder = tmp_path / "out"
    folder.mkdir()
    # A shell's background job, and what `nohup` began, hand on signals as ignored.
    heard = partial(signal.signal, getattr(signal, name), signal.SIG_DFL)
    process = subprocess.Popen(
        [sys.executable, str(script), str(folder / "a.csv")],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        preexec_fn=heard,
    )  # fmt: skip
    assert process.stdout is not None
    worker = int(process.stdout.readline().split()[1])
    assert len(os.listdir(folder)) == 1
    process.send_signal(getattr(signal, name))
    _, said = process.communicate(timeout=30)
    assert process.returncode == -getattr(signal, name)  # a shell says 128 + its number
    assert said == f"erdctl: error: stopped by {name}; no file was written\n"
    assert os.listdir(folder) == []
    for _ in range(100):
        if not Path(f"/proc/{worker}").exists():
            break
        time.sleep(0.05)
    assert not Path(f"/proc/{worker}").exists()


def test_an_ignored_signal_stays_ignored(tmp_path: Path) -> None:
    """As `nohup` does it: the end of the terminal must not end the program."""
    code = (
        "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
        "from erdctl.core import leftovers; leftovers.end_cleanly()\n"
        "print(signal.getsignal(signal.SIGHUP) is signal.SIG_IGN)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "True\n", done.stderr


def test_a_signal_between_two_renames_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    ended: list[int] = []
    monkeypatch.setattr(leftovers.os, "kill", lambda pid, number: ended.append(number))
    monkeypatch.setattr(leftovers.signal, "signal", lambda number, what: None)
    monkeypatch.setattr(leftovers, "_held", [])
    monkeypatch.setattr(leftovers, "_paths", set())
    with leftovers.undisturbed():
        leftovers._end(signal.SIGTERM, None)
        assert ended == []
    assert ended == [signal.SIGTERM]


# --- streams that are closed ----------------------------------------------------------------

CLOSED = {
    ">&-": ("simulate p.json log.csv", 4), "2>&-": ("simulate p.json log.csv", 0),
    ">&- 2>&-": ("simulate p.json log.csv", 4), "<&-": ("simulate p.json -", 3),
    "<&- >&- 2>&-": ("simulate p.json log.csv -o out.csv", 0),
    "> /dev/full": ("effects", 4), "2> /dev/full": ("simulate p.json log.csv -o out.csv", 0),
    ">&- 2> /dev/full": ("--version", 4), "2>&1 | head -0": ("identify log.csv -o out.json", 0),
    "2>&- <&-": ("simulate", 2),
}  # fmt: skip


@pytest.mark.parametrize("streams", CLOSED)
def test_closed_and_full_streams(streams: str, bench: Path) -> None:
    words, code = CLOSED[streams]
    script = f'set -o pipefail; "$0" -m erdctl {words} {streams}'
    done = subprocess.run(["bash", "-c", script, sys.executable], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    assert "Traceback" not in done.stderr
    assert listing(bench)["log.csv"] == (FIXTURES / "bad" / "good.csv").read_bytes()
    written = {"out.csv", "out.json"} & set(listing(bench))
    assert bool(written) == ("-o" in words)
    for name in written:  # nothing of what is said has gone into it
        text = (bench / name).read_text()
        assert "erdctl:" not in text
        if name.endswith(".json"):
            json.loads(text)


def test_what_nobody_foresaw_is_no_failed_check(bench: Path) -> None:
    """Exit code 1 belongs to checks that were asked for."""
    code = (
        "from erdctl.cli import app\n"
        "def run(words): raise ZeroDivisionError('\\x1b[2J' + 'x' * 10_000)\n"
        "app.run = run; app.main()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 4
    assert done.stderr.startswith("erdctl: error: internal error")
    assert "Traceback" not in done.stderr
    assert "\x1b" not in done.stderr
    assert len(done.stderr) < 1_000

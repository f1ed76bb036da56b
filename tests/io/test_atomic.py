"""Files appear whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from erdctl.core.errors import ComputationProblem, ExitCode, UsageProblem
from erdctl.io.atomic import output, replacing


def listing(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def test_nothing_is_visible_before_the_end(tmp_path: Path) -> None:
    target = tmp_path / "out.json"
    target.write_bytes(b"old")
    with output(str(target)) as stream:
        stream.write(b"new")
        stream.flush()
        assert target.read_bytes() == b"old"
    assert target.read_bytes() == b"new"
    assert listing(tmp_path) == ["out.json"]


@pytest.mark.parametrize("failure", [RuntimeError, KeyboardInterrupt, SystemExit])
@pytest.mark.parametrize("old", [None, b"old"])
def test_failure_leaves_no_trace(
    tmp_path: Path, failure: type[BaseException], old: bytes | None
) -> None:
    target = tmp_path / "out.csv"
    if old is not None:
        target.write_bytes(old)
    before = listing(tmp_path)

    def interrupted() -> None:
        with output(str(target)) as stream:
            stream.write(b"half")
            raise failure

    with pytest.raises(failure):
        interrupted()
    assert listing(tmp_path) == before
    assert old is None or target.read_bytes() == old


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EFBIG])
def test_full_disk(tmp_path: Path, number: int) -> None:
    target = tmp_path / "out.csv"
    target.write_bytes(b"old")

    def write() -> None:
        with replacing(str(target)):
            raise OSError(number, os.strerror(number))

    with pytest.raises(ComputationProblem) as caught:
        write()
    assert str(caught.value) == f"disk full while writing {target}; nothing was written"
    assert caught.value.exit_code == ExitCode.NOT_COMPLETED
    assert listing(tmp_path) == ["out.csv"]
    assert target.read_bytes() == b"old"


def test_full_disk_found_at_the_rename(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(source: str, target: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    target = tmp_path / "out.csv"
    with pytest.raises(ComputationProblem, match="disk full"), output(str(target)) as stream:
        stream.write(b"new")
    assert listing(tmp_path) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_dev_full_is_written_directly() -> None:
    expected = pytest.raises(ComputationProblem, match="disk full while writing /dev/full")
    with expected, output("/dev/full") as stream:
        stream.write(b"x" * 100)
    assert not stat.S_ISREG(os.stat("/dev/full").st_mode)


def test_missing_directory(tmp_path: Path) -> None:
    target = tmp_path / "none" / "out.csv"
    expected = pytest.raises(UsageProblem, match="none' does not exist; make it first")
    with expected as caught, output(str(target)):
        pytest.fail("the block must not run")
    assert caught.value.exit_code == ExitCode.USAGE


def test_a_file_where_a_directory_should_be(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(UsageProblem, match="not a directory"), output(str(tmp_path / "file" / "o")):
        pytest.fail("the block must not run")


@pytest.mark.parametrize("name", ["", "."])
def test_not_a_file_name(tmp_path: Path, name: str) -> None:
    target = str(tmp_path / name) if name else ""
    with pytest.raises(UsageProblem, match="not the name of a file"), output(target):
        pytest.fail("the block must not run")


def test_no_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(path: str, flags: int, mode: int = 0o777) -> int:
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(os, "open", refused)  # root, in containers, may write everywhere
    with pytest.raises(UsageProblem, match="permission denied"), output(str(tmp_path / "out")):
        pytest.fail("the block must not run")


def test_modes_are_those_of_ordinary_files(tmp_path: Path) -> None:
    new, old = tmp_path / "new", tmp_path / "old"
    old.write_bytes(b"")
    ordinary = stat.S_IMODE(old.stat().st_mode)
    with output(str(new)) as stream:
        stream.write(b"1")
    assert stat.S_IMODE(new.stat().st_mode) == ordinary
    old.chmod(0o640)
    with output(str(old)) as stream:
        stream.write(b"1")
    assert stat.S_IMODE(old.stat().st_mode) == 0o640


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    real, link = tmp_path / "real", tmp_path / "link"
    real.write_bytes(b"old")
    link.symlink_to(real)
    with output(str(link)) as stream:
        stream.write(b"new")
    assert link.is_symlink()
    assert real.read_bytes() == b"new"


def test_a_pipe_is_written_directly(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    got: list[bytes] = []
    reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
    reader.start()
    with output(str(pipe)) as stream:
        stream.write(b"through")
    reader.join(timeout=10)
    assert got == [b"through"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_stdout_in_memory(capsysbinary: pytest.CaptureFixture[bytes]) -> None:
    with output("-") as stream:
        stream.write(b"abc")
    assert capsysbinary.readouterr().out == b"abc"


PROGRAM = """
import sys
from erdctl.core.errors import ErdctlError
from erdctl.io.atomic import output
print("first", flush=False)
try:
    with output(sys.argv[1]) as stream:
        stream.write(b"data" * int(sys.argv[2]))
except ErdctlError as error:
    print(error, file=sys.stderr)
    sys.exit(error.exit_code)
"""


def program(target: str, size: int, stdout: str) -> subprocess.CompletedProcess[str]:
    command = f'"$0" -c "$1" {target} {size} {stdout}'
    return subprocess.run(
        ["bash", "-c", command, sys.executable, PROGRAM], capture_output=True, text=True
    )


def test_stdout_keeps_its_order() -> None:
    assert program("-", 1, "").stdout == "first\ndata"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
@pytest.mark.parametrize("size", [100, 1_000_000])
def test_full_stdout_ends_with_the_documented_code(size: int, tmp_path: Path) -> None:
    program_without_print = PROGRAM.replace('print("first", flush=False)', "")
    done = subprocess.run(
        ["bash", "-c", f'"$0" -c "$1" - {size} > /dev/full', sys.executable, program_without_print],
        capture_output=True,
        text=True,
    )
    assert done.stderr == "disk full while writing standard output; the output is incomplete\n"
    assert done.returncode == ExitCode.NOT_COMPLETED


def test_dev_stdout_appends(tmp_path: Path) -> None:
    target = tmp_path / "all.txt"
    target.write_bytes(b"before\n")
    done = program("/dev/stdout", 1, f">> {target}")
    assert done.returncode == 0, done.stderr
    assert b"before\n" in target.read_bytes()
    assert b"data" in target.read_bytes()

"""Every command that README, tutorial, proof and help texts show is run, and prints what they say.

So is the Python beside the tutorial's commands, in order and in one namespace.

Shortened: `diagnose` searches few effects unless it is the tutorial's (see doc_snippets). `prove`
is parsed only, since a case takes ten seconds and tests/prove runs the command, and so is what
takes as long or names a cluster. What runs pytest is left to CI.
"""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path
from typing import Any

import pytest
import typer
from doc_files import place
from doc_snippets import (
    Block,
    alike,
    blocks,
    examples,
    inline,
    missing_lines,
    run,
    run_python,
    shortened,
    workplace,
)
from places import FIXTURES, ROOT, SHARED
from typer.testing import CliRunner

from erdctl.cli.app import COMMANDS, build
from erdctl.effects import catalogue

SHELL = re.compile(r"[|<>$;&*]|--install-completion")  # a shell's work
APP = build()
README, TUTORIAL, PROOF = ROOT / "README.md", FIXTURES / "TUTORIAL.md", FIXTURES / "PROOF.md"


def all_examples() -> list[str]:
    group = typer.main.get_command(APP)
    texts = [group.help, *(c.help for c in group.commands.values())]  # type: ignore[attr-defined]  # a group
    return list(dict.fromkeys(e for text in texts for e in examples(text or "")))


def parse(command: str) -> None:
    """Check the words of one erdctl command, and run nothing."""
    program, name, *words = shlex.split(command)
    assert program == "erdctl"
    group = typer.main.get_command(build([name]))
    only = getattr(group, "commands", {name: group})[name]
    only.make_context(name, words)


def is_long(command: str) -> bool:
    """`prove`, a cluster, a build of an FMU, which tests/export runs, and a search of the whole
    catalogue in a real recording, whose names and errors tests/diagnose/test_real_data.py holds."""
    begins = command.startswith(("erdctl prove", "erdctl diagnose ../shared"))
    return begins or "--cluster" in command or command.endswith(".fmu")


def check(command: str, work: Path) -> str:
    done = run(command, work)
    assert done.returncode == 0, f"{command}\n{done.stdout}"
    assert "Traceback" not in done.stdout
    return done.stdout


@pytest.mark.parametrize(
    "command", sorted({*all_examples(), *inline(README), *inline(TUTORIAL), *inline(PROOF)})
)
def test_examples_run(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if is_long(command):
        parse(command)
        return
    work = workplace(tmp_path)
    if SHELL.search(command):
        check(shortened(command), work)
        return
    # In this process, which has the libraries loaded that most of the time would go into.
    place(work, command)
    monkeypatch.chdir(work)
    done = CliRunner().invoke(APP, shlex.split(shortened(command))[1:], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr


def test_every_command_has_examples() -> None:
    shown = " ".join(all_examples())
    assert [name for name in COMMANDS if f"erdctl {name}" not in shown] == []


def skip_unless_at_hand(block: Block) -> None:
    if "jq " in block.code and not shutil.which("jq"):
        pytest.skip("jq is not installed")
    if "../shared" in block.code and not SHARED.exists():
        pytest.skip("the real recordings are not at hand (expected in ../shared/data)")


def reads_recordings(block: Block) -> bool:
    return "../shared" in block.code and not is_long(block.commands)


def each_block(path: Path) -> list[Any]:
    """The blocks that stand for themselves; those that read real recordings carry the mark."""
    return [
        pytest.param(
            block, id=f"{path.stem}-line-{block.line}",
            marks=[pytest.mark.real_data] if reads_recordings(block) else [],
        )
        for block in blocks(path)
    ]  # fmt: skip


@pytest.mark.parametrize("block", [*each_block(README), *each_block(PROOF)])
def test_readme_and_proof(block: Block, tmp_path: Path) -> None:
    skip_unless_at_hand(block)
    if not block.commands:
        assert "pytest" in block.code
        return
    if is_long(block.commands):
        parse(block.commands)
        return
    output = check(block.commands, workplace(tmp_path))
    if block.output is not None:
        assert missing_lines(block.output, output) == []


@pytest.mark.long
def test_the_tutorial_in_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each log searched for the whole catalogue: none of these effects explains what is learned."""
    monkeypatch.setattr("doc_snippets.IN_FULL", ("",))
    test_the_tutorial(tmp_path)


def test_the_tutorial(tmp_path: Path) -> None:
    """In one go, as a reader does; later steps use what earlier ones wrote."""
    work = workplace(tmp_path)
    found = blocks(TUTORIAL)
    assert len(found) >= 6
    assert f"none of the {len(catalogue())} effects tried" in TUTORIAL.read_text()
    variables = ""
    for block in found:
        skip_unless_at_hand(block)
        output = check(variables + block.commands, work)
        variables += "".join(re.findall(r"^\w+=.*\n", block.code, flags=re.MULTILINE))
        if block.output is not None:
            assert missing_lines(block.output, output) == [], f"line {block.line}:\n{output}"


@pytest.mark.untraced
def test_the_tutorial_in_python(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(workplace(tmp_path))
    found = blocks(TUTORIAL, "python")
    assert len(found) >= 8
    names: dict[str, Any] = {}
    for block in found:
        output = run_python(block.code, names)
        if block.output is not None:
            assert missing_lines(block.output, output) == [], f"line {block.line}:\n{output}"


def test_the_readme_in_python(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With few effects to search for, as the commands of the README are shortened."""
    (block,) = blocks(README, "python")
    full, few = '.diagnose("bench.parquet")', '.diagnose("bench.parquet", effects=["backlash"])'
    assert full in block.code
    work = workplace(tmp_path)
    place(work, block.code.replace('"', " "))
    monkeypatch.chdir(work)
    output = run_python(block.code.replace(full, few), {})
    assert "nrmse" in output.lower()


def test_python_runs_as_at_a_prompt() -> None:
    names: dict[str, Any] = {}
    assert run_python("a = 2\nprint('x')\na + 1", names) == "x\n3\n"
    assert run_python("print(a)", names) == "2\n"
    assert run_python("b = [a]", names) == ""


def test_numbers_are_compared_to_their_last_digits() -> None:
    assert alike("  all  0.0072  12 N", "all 0.0071   12 N")
    assert not alike("all 0.0072", "all 0.0092")
    assert not alike("records 24", "records 25")
    assert not alike("all 0.0072", "one 0.0072")
    assert alike("none of the 42 effects tried, 3 s", "none of the 2 effects tried, 3 s")
    assert missing_lines("a 1.0\nb 2.0", "x\na 1.0\ny\nb 2.1\n") == []
    assert missing_lines("a 1.0\nb 2.0", "b 2.0\na 1.0\n") == ["b 2.0"]

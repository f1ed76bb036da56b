"""Commands, Python and their output out of Markdown files and help texts, and how they are run."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

from doc_files import place
from places import FIXTURES, SHARED

# What a shortened command leaves out: a search over the whole catalogue takes half a minute, and
# what it finds is tested in tests/diagnose. Of the logs of the tutorial one is searched in full.
FEW_EFFECTS = " --effects coulomb_friction,time_skew"
# And what is hidden there, or a law would be learned in its place.
HIDDEN = {
    "worn_joint": " --effects coulomb_friction,backlash",
    "stuck_separator.": " --effects coulomb_friction,gas_preload",
    "stuck_separator_2": " --effects stuck_separator,gas_preload,coulomb_friction",
}
IN_FULL = ("late_amplifier",)
ULPS = 3  # by how many units of its last digit a printed number may differ
PART = 0.003  # or by which part of itself

_FENCE = re.compile(r"^```(.*)$")
_TRIED = re.compile(r"none of the \d+ effects tried")  # fewer, where the search is shortened
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


@dataclass(frozen=True)
class Block:
    """A block of shell commands or Python, and the output that the text prints for it, if any."""

    line: int
    code: str
    output: str | None

    @property
    def commands(self) -> str:
        """What runs of it: installing and the test suite are what CI does before it comes here."""
        kept = [re.sub(r"^pip install [^&]*(&& )?", "", row) for row in self.code.splitlines()]
        return "\n".join(shortened(row) for row in kept if row and "pytest" not in row)


def shortened(command: str) -> str:
    """The command, or the same with less to search."""
    full = any(name in command for name in IN_FULL)
    if "erdctl diagnose" in command and "--effects" not in command and not full:
        few = next((f for name, f in HIDDEN.items() if name in command), FEW_EFFECTS)
        return command.replace("erdctl diagnose", "erdctl diagnose" + few)
    return command


def blocks(path: Path, language: str = "sh") -> list[Block]:
    """The blocks of a language in a Markdown file.

    A plain block before the next heading, or the next block that is run, is a block's output.
    """
    found: dict[str, list[Block]] = {"sh": [], "python": []}
    last = ""
    inside: str | None = None
    body: list[str] = []
    start, open_to_output = 0, False
    for number, row in enumerate(path.read_text().splitlines(), start=1):
        fence = _FENCE.match(row)
        if fence and inside is None:
            inside, body, start = fence[1].split(" ")[0], [], number + 1
        elif fence:
            text = "\n".join(body)
            if inside in found:
                found[inside].append(Block(start, text, None))
                last, open_to_output = inside, True
            elif inside == "" and open_to_output:
                found[last][-1] = Block(found[last][-1].line, found[last][-1].code, text)
                open_to_output = False
            inside = None
        elif inside is not None:
            body.append(row)
        elif row.startswith("#"):
            open_to_output = False
    return found[language]


def run_python(code: str, names: dict[str, Any]) -> str:
    """Run a block as a prompt does: what it prints, and its last value, if that is not None."""
    tree, out = ast.parse(code), StringIO()
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    with redirect_stdout(out):
        exec(compile(tree, "block", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "block", "eval"), names)
            if value is not None:
                print(repr(value))
    return out.getvalue()


def inline(path: Path) -> list[str]:
    """Whole commands in `code` of running text: those without placeholders."""
    prose = re.sub(r"^```.*?^```", "", path.read_text(), flags=re.MULTILINE | re.DOTALL)
    spans = re.findall(r"`(erdctl [^`]*)`", prose.replace("\n", " "))
    whole = [s for s in spans if not re.search(r"\b[A-Z]{3,}\b|\.\.\.|\[", s)]
    return list(dict.fromkeys(whole))


def examples(help_text: str) -> list[str]:
    """The commands under `Example:` or `Examples:` of a help text, continued lines joined."""
    after = re.split(r"Examples?:\n", help_text, maxsplit=1)[1]
    joined = re.sub(r"\\\n\s+", "", after.split("\n\n")[0])
    return [row.strip() for row in joined.splitlines() if row.strip()]


def workplace(folder: Path) -> Path:
    """A folder like the project's own, with `fixtures`, `../shared`, and `erdctl` and `python`.

    Both are of this source.
    """
    work, programs = folder / "work", folder / "bin"
    work.mkdir()
    programs.mkdir()
    (work / "fixtures").symlink_to(FIXTURES)
    if SHARED.exists():
        (folder / "shared").symlink_to(SHARED.parent)
    for name, words in (("erdctl", "-m erdctl "), ("python", "")):
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" {words}"$@"\n')
        program.chmod(0o755)
    return work


def run(command: str, work: Path) -> subprocess.CompletedProcess[str]:
    """Run shell commands in a workplace; what they print on either stream is in `stdout`."""
    place(work, command)
    # Test workers are told of 80 columns; a document shows what a pipe gets, which has no width.
    world = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    # The cross-compiler builds what it needs itself only once, not for every new home.
    world.setdefault("ZIG_GLOBAL_CACHE_DIR", str(Path.home() / ".cache" / "zig"))
    path = f"{work.parent / 'bin'}{os.pathsep}{os.environ['PATH']}"
    # The shell stays: completion is installed for the shell that erdctl was started from.
    script = command.replace("/tmp/", f"{work}/") + "\n:"
    return subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script],
        cwd=work, env={**world, "PATH": path, "HOME": str(work.parent)},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, stdin=subprocess.DEVNULL,
    )  # fmt: skip


def missing_lines(printed: str, actual: str) -> list[str]:
    """Lines of a text's output that did not come, in their order, within the last digits."""
    rows = iter(actual.splitlines())
    missing = []
    for want in filter(str.strip, printed.splitlines()):
        if not any(alike(want, row) for row in rows):
            missing.append(want)
            rows = iter(actual.splitlines())
    return missing


def alike(want: str, got: str) -> bool:
    """Whether two lines say the same but for spaces, the last digits of numbers, and how many
    effects were tried."""
    want, got = (_TRIED.sub("none of the effects tried", line) for line in (want, got))
    if _NUMBER.sub("#", want).split() != _NUMBER.sub("#", got).split():
        return False
    pairs = zip(_NUMBER.findall(want), _NUMBER.findall(got), strict=True)
    return all(abs(float(a) - float(b)) <= allowed(a) for a, b in pairs)


def allowed(number: str) -> float:
    """By how much a printed number may be off."""
    mantissa, _, exponent = number.partition("e")
    decimals = len(mantissa.partition(".")[2])
    last = 10.0 ** (int(exponent or 0) - decimals)
    # A whole number counts something.
    return max(ULPS * last, PART * abs(float(number))) if decimals or exponent else 0.0

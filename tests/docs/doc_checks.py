"""The worked values in docstrings: found, run, and what is wrong with them said.

A docstring that says `Check:` goes on with lines of Python and what they show, as doctest reads
them. They see the names of their own module and those of `by_hand.HELPERS`, nothing else. Every
number that they show must stand in the words, too, so that neither changes without the other.
"""

from __future__ import annotations

import ast
import doctest
import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from by_hand import HELPERS

SAYS_CHECK = re.compile(r"\bCheck:")
EQUATION = re.compile(r"^    \S.*(=|->)", re.M)
SOURCE = re.compile(r"^Source:\s+(.*)", re.M | re.S)
QUOTED = re.compile(r"'.*?'")
NUMBER = re.compile(r"(?<![A-Za-z_\d.])\d+(?:\.\d+)?")
YEAR = re.compile(r"\b1[89]\d\d\b|\b20\d\d\b")
AUTHOR = re.compile(r"[A-ZÀ-Þ]")  # a citation begins with a name
# What all of erdctl models. It is cited in full where the model is (`erdctl.model.paper`).
PAPER = re.compile(r"\bthe ER damper paper, Eqs?\. \d")

Definition = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


class Docstring(NamedTuple):
    """One docstring, whose it is, and the line of the file before its first."""

    owner: str
    line: int
    text: str

    @property
    def checked(self) -> bool:
        return bool(SAYS_CHECK.search(self.text)) or ">>>" in self.text


def docstrings(source: str) -> list[Docstring]:
    """All of a module, from its text: also of what is nested, compiled or wrapped."""
    out = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, Definition) and (text := ast.get_docstring(node, clean=False)):
            owner = "module" if isinstance(node, ast.Module) else node.name
            out.append(Docstring(owner, node.body[0].lineno - 1, text))
    return out


def has_checks(source: str) -> bool:
    return any(d.checked for d in docstrings(source))


def wrong_checks(source: str, file: str, names: Mapping[str, Any]) -> list[str]:
    """What is wrong with the checks of a module, whose names are given; nothing if all hold."""
    return [w for d in docstrings(source) if d.checked for w in _wrong(d, file, names)]


def _wrong(docstring: Docstring, file: str, names: Mapping[str, Any]) -> list[str]:
    owner, line, text = docstring
    where = f"{file}:{line + 1}, {owner}"
    try:
        examples = doctest.DocTestParser().get_examples(text, where)
    except ValueError as problem:
        return [f"{where}: {problem}"]
    after = SAYS_CHECK.search(text)
    if after is not None:
        first = text[: after.start()].count("\n")
        # Lines that show nothing, or stand before it, check nothing that the text says.
        if not any(e.want for e in examples if e.lineno > first):
            return [f"{where}: 'Check:' without lines that run (>>>) and what they show"]
    said: list[str] = []
    shown = "".join(QUOTED.sub("", e.want) for e in examples)
    loose = sorted(_digits(shown) - _digits(_words(text)))
    if after is not None and loose:
        said.append(f"{where}: shown, but not in the words of 'Check:': {', '.join(loose)}")
    test = doctest.DocTest(examples, {**HELPERS, **names}, owner, file, line, text)
    doctest.DocTestRunner(verbose=False).run(test, out=said.append)
    return ["\n".join(said)] if said else []


def _words(text: str) -> str:
    """The words of a check, up to the lines that run."""
    return " ".join(re.findall(r"\bCheck:(.*?)>>>", text, re.S))


def _digits(text: str) -> set[str]:
    """Its numbers, by their digits alone: 9.0 mm is 0.009 m, and -0.9640 is 0.964."""
    return {n.replace(".", "").strip("0") for n in NUMBER.findall(text)} - {""}


def wrong_effect(source: str, file: str, cited: str) -> list[str]:
    """What an effect's file lacks: equation, check, source; cited : the source in its `EFFECT`."""
    text = ast.get_docstring(ast.parse(source)) or ""
    out = []
    if not EQUATION.search(text):
        out.append(f"{file}: no equation, indented by four spaces, in the docstring of the module")
    if not SAYS_CHECK.search(text):
        out.append(f"{file}: no 'Check:' in the docstring of the module")
    found = SOURCE.search(text)
    given = found[1].strip() if found else ""
    if not found:
        out.append(f"{file}: no 'Source:' in the docstring of the module")
    elif not _names_a_source(given):
        out.append(f"{file}: 'Source:' names no author and year: {given!r}")
    if not _names_a_source(cited):
        out.append(f"{file}: EFFECT.source names no author and year: {cited!r}")
    elif _names_a_source(given) and not {*YEAR.findall(cited)} <= {*YEAR.findall(given)}:
        out.append(f"{file}: EFFECT.source and 'Source:' differ in the year: {cited!r}")
    return out


def _names_a_source(text: str) -> bool:
    return bool(PAPER.search(text) or (AUTHOR.match(text.strip()) and YEAR.search(text)))

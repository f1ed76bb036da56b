"""All that is wrong with a file in one message, so that nobody mends it one run at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from erdctl.core.errors import ErdctlError, InputProblem, UsageProblem

T = TypeVar("T")
MOST = 12  # listed


@dataclass(frozen=True)
class Wrong:
    """One thing that is wrong: what was found, what was expected, what to do; and where."""

    message: str
    row: int | None = None
    column: str | None = None


@dataclass
class Problems:
    """Errors of a file as they are met, to be raised together."""

    file: str
    met: list[ErdctlError] = field(default_factory=list)

    def attempt(self, work: Callable[[], T]) -> T | None:
        """What the work gives; if it fails for the input, None, and the error is kept."""
        try:
            return work()
        except (InputProblem, UsageProblem) as error:
            self.met.append(error)
            return None

    def settle(self) -> None:
        """Raise what was met: a single error as it is, several as one."""
        if len(self.met) == 1:
            raise self.met[0]
        if self.met:
            kinds = {type(error) for error in self.met}
            texts = [str(error).removeprefix(f"{self.file}: ") for error in self.met]
            message = _list(list(dict.fromkeys(texts)))
            if kinds == {UsageProblem}:
                raise UsageProblem(f"{self.file}: {message}")
            raise InputProblem(message, file=self.file)


def problem_of(found: Sequence[Wrong], file: str) -> InputProblem:
    """One error that says all of it."""
    if len(found) == 1:
        one = found[0]
        return InputProblem(one.message, file=file, row=one.row, column=one.column)
    return InputProblem(
        _list([str(InputProblem(w.message, row=w.row, column=w.column)) for w in found]), file=file
    )


def _list(texts: Sequence[str]) -> str:
    shown = [f"\n  ({i}) {text}" for i, text in enumerate(texts[:MOST], 1)]
    more = f"\n  and {len(texts) - MOST} more" if len(texts) > MOST else ""
    return f"{len(texts)} things are wrong:" + "".join(shown) + more

"""Errors that a user can act on; each knows the documented exit code it ends with."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import Any


class ExitCode(IntEnum):
    """Exit codes of every command."""

    DONE = 0
    CHECK_FAILED = 1
    USAGE = 2
    BAD_INPUT = 3
    NOT_COMPLETED = 4


class ErdctlError(Exception):
    """Base of all errors with a one-line message for the user.

    after_the_work : whether it is said of a finished work, whose files are then written
    """

    exit_code: ExitCode = ExitCode.NOT_COMPLETED
    after_the_work: bool = False


class CheckFailed(ErdctlError):
    """A check that the user asked for (`--fail-above`, `--fail-on-mismatch`) failed."""

    exit_code = ExitCode.CHECK_FAILED
    after_the_work = True


class UsageProblem(ErdctlError):
    """The command line asks for something that makes no sense."""

    exit_code = ExitCode.USAGE


class InputProblem(ErdctlError):
    """A log or a JSON document cannot be used as it is.

    message : what was found, what was expected, what to do next
    file, row, column : where; `row` is the 1-based line of a CSV file (header = line 1) or the
    1-based data row of a binary table
    """

    exit_code = ExitCode.BAD_INPUT

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        row: int | None = None,
        column: str | None = None,
    ) -> None:
        place = [f"row {row}"] if row is not None else []
        if column is not None:
            place.append(f"column '{column}'")
        self.file = file
        head = [file] if file else []
        if place:
            head.append(", ".join(place))
        super().__init__(": ".join([*head, message]))


class ComputationProblem(ErdctlError):
    """The computation could not be completed (no convergence, full disk, out of memory)."""

    exit_code = ExitCode.NOT_COMPLETED


class PartlyDone(ComputationProblem):
    """Some of many computations could not be completed; the others stand, and are written."""

    after_the_work = True


class IncompatibleEffects(ErdctlError):
    """Effects that no model can hold together: one slot for two, or a law behind a spring."""

    exit_code = ExitCode.BAD_INPUT


class EffectFailed(ErdctlError):
    """A function of an effect raised an error or returned what its slot cannot take.

    Never a reason to go on without the effect: that would look as if it were absent.
    """

    exit_code = ExitCode.NOT_COMPLETED

    def __init__(self, function: Callable[..., Any] | str, reason: str) -> None:
        super().__init__(
            f"{function if isinstance(function, str) else place_of(function)}: {reason}"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """As a worker process sends it: the message is whole."""
        return _failed, (str(self),)


def _failed(message: str) -> EffectFailed:
    place, _, reason = message.partition(": ")
    return EffectFailed(place, reason)


def place_of(function: Callable[..., Any]) -> str:
    """File, line and name of a function."""
    code = getattr(function, "__code__", None)
    name = getattr(function, "__name__", type(function).__name__)
    if code is None:
        return f"{name} of {getattr(function, '__module__', 'an unknown module')}"
    return f"{code.co_filename}, line {code.co_firstlineno}, {name}"

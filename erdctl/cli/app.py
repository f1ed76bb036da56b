"""The `erdctl` program: its commands, and how errors end it."""

from __future__ import annotations

import errno
import io
import os
import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated, Any, TextIO

import typer
from typer.core import TyperCommand, TyperGroup, TyperOption

# Blocks of a log are the parallelism here. Linear algebra threads on top of it fight for the same
# cores: on 10 million rows they made `identify` ten times slower. NumPy reads this when it loads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from erdctl.cli import in_force
from erdctl.cli.options import EXIT_CODES
from erdctl.cli.streams import open_streams
from erdctl.core.errors import ErdctlError, ExitCode, InputProblem
from erdctl.core.leftovers import end_cleanly
from erdctl.core.memory import check_room
from erdctl.core.messages import CELL, shown, tell
from erdctl.core.version import __version__
from erdctl.report.text import QUIET

# What Typer raises for a wrong command line; of its own Click, or of the one that is installed.
WrongCommandLine: Any = typer.BadParameter.__mro__[2]
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG, errno.EBADF)


class Command(TyperCommand):
    """A command with the options that all of them share, whose files appear together."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.params.append(quiet_option())
        self.params.extend(in_force.options(self.params))

    def invoke(self, ctx: Any) -> Any:
        from erdctl.cli import files
        from erdctl.io.atomic import together

        check_room()
        project = _project(ctx)
        names = files.names(self.params, ctx.params)
        with in_force.force(project), together([*in_force.names(project), *names]):
            try:
                return super().invoke(ctx)
            except InputProblem as problem:
                raise files.placed(problem, names) from None


def _project(ctx: Any) -> in_force.InForce | None:
    """The project file that a command is under; those that are about it take it as they like."""
    if ctx.parent is not None and ctx.parent.info_name == "project":
        return None
    if in_force.file_of(ctx) is None and "duty_max" not in ctx.params:
        return None  # what most calls have to do
    from erdctl.cli.project_options import applied

    return applied(ctx, all_commands)


def all_commands() -> dict[str, Any]:
    """Every command by its name, as Typer builds it."""
    commands: dict[str, Any] = typer.main.get_command(build()).commands  # type: ignore[attr-defined]  # a group
    return commands


def quiet_option() -> TyperOption:
    """`--quiet`, in force until the command ends."""

    def keep(context: Any, parameter: Any, asked: bool) -> None:
        if asked:
            before = QUIET.set(True)
            context.call_on_close(lambda: QUIET.reset(before))

    return TyperOption(
        param_decls=["--quiet", "-q"],
        is_flag=True,
        expose_value=False,
        callback=keep,
        help="No tables, remarks or progress on stderr: only warnings and errors.",
    )


# What the loader of a compiled library says where a limit of memory leaves no room for it.
_UNMAPPED = ("failed to map segment", "cannot allocate memory")


class Guarded(TyperGroup):
    """Turns every foreseen error into one line on stderr and the documented exit code."""

    def main(self, args: Any = None, *, standalone_mode: bool = True, **options: Any) -> Any:  # type: ignore[override]  # Click overloads it by standalone_mode
        """As Typer, but what it says of a wrong command line is shown as all else is."""
        try:
            code = super().main(args, standalone_mode=False, **options)
        except WrongCommandLine as problem:
            if not standalone_mode:
                raise
            text = io.StringIO()
            problem.show(file=text)
            for line in text.getvalue().splitlines():
                tell(shown(line))
            sys.exit(problem.exit_code)
        except SystemExit as end:
            # Typer's word for a reader of a help text who has seen enough.
            sys.exit(ExitCode.DONE if end.code == 1 else end.code)
        except typer.Abort:
            if not standalone_mode:
                raise
            sys.exit(_end("stopped", ExitCode.NOT_COMPLETED).exit_code)
        if standalone_mode:
            sys.exit(code if isinstance(code, int) else ExitCode.DONE)
        return code

    def invoke(self, ctx: Any) -> Any:
        try:
            result = super().invoke(ctx)
            sys.stdout.flush()
            return result
        except BrokenPipeError:
            # The reader has seen enough (`| head -1`). Python would complain once more when it
            # flushes stdout at exit, so what is left goes nowhere.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(ExitCode.DONE) from None
        except ErdctlError as error:
            raise _end(str(error), error.exit_code) from None
        except MemoryError:
            raise _end("out of memory", ExitCode.NOT_COMPLETED) from None
        except ImportError as error:
            if not any(reason in str(error).lower() for reason in _UNMAPPED):
                raise
            raise _end("out of memory", ExitCode.NOT_COMPLETED) from None
        except OSError as error:
            raise _full(error) from None


def _end(message: str, code: ExitCode) -> typer.Exit:
    tell(f"erdctl: error: {shown(' '.join(message.split()))}")
    return typer.Exit(code)


def _full(error: OSError) -> typer.Exit:
    """What a print to standard output may raise; any other error is raised as it is."""
    if error.errno not in FULL:
        raise error
    reason = "it is closed" if error.errno == errno.EBADF else (error.strerror or "").lower()
    return _end(f"cannot write standard output: {reason}", ExitCode.NOT_COMPLETED)


COMMANDS = (
    "inspect", "identify", "simulate", "validate", "diagnose", "prove", "mimic", "export", "plot",
    "convert", "derive", "effects", "project", "schema", "compare", "campaign",
)  # fmt: skip


def _version(asked: bool) -> None:
    if asked:
        print(f"erdctl {__version__}")
        raise typer.Exit


def root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Options of the program itself."""


def build(names: Sequence[str] = COMMANDS) -> typer.Typer:
    """The program with the given commands."""
    app = typer.Typer(
        cls=Guarded,
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,  # Rich help takes longer to import than all else takes together
        context_settings={"help_option_names": ["-h", "--help"]},
        help=(
            "Identify, simulate, validate, diagnose and mimic electro-rheological dampers from"
            " bench logs."
            "\n\n\b\nExamples:\n"
            "  erdctl identify bench.parquet -o damper.json\n"
            "  erdctl validate damper.json other.csv\n"
            "  erdctl identify bench.csv | erdctl simulate - drive.csv | erdctl validate -\n"
            "  erdctl diagnose bench.parquet -o diagnosis.json --report diagnosis.html"
        ),
        epilog=EXIT_CODES,
    )
    app.callback()(root)
    for name in names:
        module = import_module(f"erdctl.cli.{name}")
        under, functions = app, getattr(module, "COMMANDS", None)
        if functions is not None:  # several under one word
            under = typer.Typer(rich_markup_mode=None)
            app.add_typer(under, name=name, help=module.__doc__, epilog=EXIT_CODES,
                          no_args_is_help=True)  # fmt: skip
        for word, function in (functions or {name: module.command}).items():
            under.command(word, cls=Command, epilog=EXIT_CODES)(function)
    return app


def run(words: Sequence[str]) -> int:
    """The exit code of a call; what nobody foresaw is raised as it is."""
    warnings.showwarning = _show_warning
    # One command is all that most calls need: building every other costs them 15 ms.
    named = [word for word in words[:1] if word in COMMANDS]
    try:
        try:
            build(named or COMMANDS)(args=list(words), prog_name="erdctl")
        finally:
            sys.stdout.flush()
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else ExitCode.DONE
    except BrokenPipeError:
        return ExitCode.DONE  # the reader has seen enough of a help text
    except OSError as error:
        return _full(error).exit_code
    return ExitCode.DONE


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """A remark of a library, in one line; it may quote what stands in a file."""
    tell(shown(f"erdctl: note: {category.__name__}: {message}"))


def main() -> None:
    """Entry point of the console script.

    Ends the process at once when all is written: taking the libraries down in order costs a batch
    script 30 ms at every call, and nothing is left that it would save.
    """
    open_streams()
    end_cleanly()
    try:
        code = run(sys.argv[1:])
    except Exception as error:  # noqa: BLE001  # exit code 1 is for a check that was asked for
        code = _defect(error)
    os._exit(code)


def _defect(error: Exception) -> int:
    """A line for an error that erdctl should have foreseen; all of it for whoever mends it."""
    import traceback

    if os.environ.get("ERDCTL_TRACEBACK"):
        tell("".join(traceback.format_exception(error)))
    frames = traceback.extract_tb(error.__traceback__)
    own = [f for f in frames if f"{os.sep}erdctl{os.sep}" in f.filename] or frames
    place = f" in {os.path.basename(own[-1].filename)}, line {own[-1].lineno}" if own else ""
    found = shown(f"{type(error).__name__}: {error}", CELL)
    what = (
        f"internal error{place}: {found}; this is a defect of erdctl, please report it with the"
        " command; ERDCTL_TRACEBACK=1 shows where it arose"
    )
    return _end(what, ExitCode.NOT_COMPLETED).exit_code


if __name__ == "__main__":
    main()

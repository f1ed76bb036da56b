"""The `erdctl` program: its commands, and how errors end it."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup, TyperOption

# Blocks of a log are the parallelism here. Linear algebra threads on top of it fight for the same
# cores: on 10 million rows they made `identify` ten times slower. NumPy reads this when it loads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from erdctl.cli.options import EXIT_CODES
from erdctl.core.errors import ErdctlError, ExitCode
from erdctl.core.version import __version__
from erdctl.report.text import QUIET


class Command(TyperCommand):
    """A command with the options that all of them share."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.params.append(quiet_option())


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


class Guarded(TyperGroup):
    """Turns every foreseen error into one line on stderr and the documented exit code."""

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
        except OSError as error:
            if error.errno not in (errno.ENOSPC, errno.EDQUOT, errno.EIO):
                raise
            raise _end(f"cannot write: {error.strerror}", ExitCode.NOT_COMPLETED) from None


def _end(message: str, code: ExitCode) -> typer.Exit:
    line = " ".join(message.split())
    print(f"erdctl: error: {line}", file=sys.stderr)
    return typer.Exit(code)


COMMANDS = (
    "inspect", "identify", "simulate", "validate", "diagnose", "prove", "mimic", "plot", "convert",
    "derive", "effects", "schema",
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
        app.command(name, cls=Command, epilog=EXIT_CODES)(
            import_module(f"erdctl.cli.{name}").command
        )
    return app


def main() -> None:
    """Entry point of the console script.

    Ends the process at once when all is written: taking the libraries down in order costs a batch
    script 30 ms at every call, and nothing is left that it would save.
    """
    # One command is all that most calls need: building every other costs them 15 ms.
    named = [word for word in sys.argv[1:2] if word in COMMANDS]
    try:
        try:
            build(named or COMMANDS)(prog_name="erdctl")
        finally:
            sys.stdout.flush()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else ExitCode.DONE
    except BrokenPipeError:
        code = ExitCode.DONE  # the reader has seen enough of a help text
    except OSError as error:
        code = _end(f"cannot write: {error.strerror}", ExitCode.NOT_COMPLETED).exit_code
    sys.stderr.flush()
    os._exit(code)


if __name__ == "__main__":
    main()

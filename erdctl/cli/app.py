"""The `erdctl` program: its commands, and how errors end it."""

from __future__ import annotations

import errno
import os
import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

# Blocks of a log are the parallelism here. Linear algebra threads on top of it fight for the same
# cores: on 10 million rows they made `identify` ten times slower. NumPy reads this when it loads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from erdctl import __version__
from erdctl.cli import derive, effects, identify, mimic, schema, simulate, validate
from erdctl.cli.options import EXIT_CODES
from erdctl.errors import ErdctlError, ExitCode


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


app = typer.Typer(
    cls=Guarded,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # Rich help takes longer to import than all else takes together
    context_settings={"help_option_names": ["-h", "--help"]},
    help=(
        "Identify, simulate, validate and mimic electro-rheological dampers from bench logs."
        "\n\n\b\nExamples:\n"
        "  erdctl identify bench.parquet -o damper.json\n"
        "  erdctl validate damper.json other.csv\n"
        "  erdctl identify bench.csv | erdctl simulate - drive.csv | erdctl validate -"
    ),
    epilog=EXIT_CODES,
)


def _version(asked: bool) -> None:
    if asked:
        print(f"erdctl {__version__}")
        raise typer.Exit


@app.callback()
def root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Options of the program itself."""


for module in (identify, simulate, validate, mimic, derive, effects, schema):
    app.command(module.__name__.rpartition(".")[2], epilog=EXIT_CODES)(module.command)


def main() -> None:
    """Entry point of the console script."""
    app(prog_name="erdctl")


if __name__ == "__main__":
    main()

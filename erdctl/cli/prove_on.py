"""`erdctl prove --on LOG`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from erdctl.core.messages import counted

if TYPE_CHECKING:
    from pathlib import Path

    from erdctl.prove.on_log import Trial


def prove_on(
    log: str,
    maps: Sequence[str],
    *,
    effects: Sequence[str] | None,
    sizes: str,
    nulls: int,
    thin: int,
    seed: int,
    jobs: int | None,
    folder: Path,
    as_json: bool,
    output: str | None,
) -> None:
    """Hide effects in a user's own recording and say from which size each is found."""
    from erdctl.cli.reading import read_logs
    from erdctl.core.errors import PartlyDone
    from erdctl.core.messages import shown, tell
    from erdctl.core.workers import cores
    from erdctl.io import documents
    from erdctl.prove.on_log import hideable, host
    from erdctl.prove.on_log_document import line, tables, to_json
    from erdctl.prove.on_log_run import trials
    from erdctl.report.layout import wrapped
    from erdctl.report.text import QUIET, progress, say, table, width

    wanted, names = _sizes(sizes), hideable(effects)
    recording = read_logs([log], maps=maps, need_force=True, want_hash=True, report=say).recording
    with progress() as step:
        found = host(recording, thin, seed, jobs or cores(), step)
        anyway = ", ".join(found.anyway) or "nothing"
        say(f"{found.found.verdict.value}; named: {anyway}", "the log as it is")
        say(
            f"{found.found.carried.overall.rms:.3g} N rms are left of it; effects are hidden in"
            f" {len(found.found.problem.recording)} samples"
        )
        done = 0

        def on_trials(outcome: Sequence[Trial]) -> None:
            nonlocal done
            done += 1
            for trial in outcome:
                if not QUIET.get():
                    tell(wrapped(shown(line(trial)), width()))
            step("hidden", f"{done} of {len(names) + nulls}")

        all_ = trials(
            found, names, wanted, nulls, folder, jobs=jobs or cores(), on_trials=on_trials
        )
    document = to_json(found, all_)
    if as_json:
        documents.write(document, "-")
    if output is not None:
        documents.write(document, output)
    for title, header, rows in tables(all_):
        table(title, header, rows)
    failed = [t for t in all_ if t.skipped and t.skipped.startswith("cannot be diagnosed")]
    if failed:
        raise PartlyDone(f"{len(failed)} of {counted(len(all_), 'trial')} could not be diagnosed")


def refuse(**options: object) -> None:
    """Raise UsageProblem for an option that says what to draw, where nothing is drawn."""
    from erdctl.core.errors import UsageProblem

    given = [name for name, value in options.items() if value is not None]
    if given:
        raise UsageProblem(f"--{given[0]} does not go with --on, which draws no damper")


def _sizes(text: str) -> list[float]:
    from math import isfinite

    from erdctl.core.errors import UsageProblem

    try:
        sizes = sorted({float(part) for part in text.split(",")})
    except ValueError:
        raise UsageProblem(f"--sizes is '{text}', expected numbers such as 1,2,4") from None
    if not all(isfinite(s) and s > 0.0 for s in sizes):
        raise UsageProblem(f"--sizes is '{text}', expected sizes over noise above 0")
    return sizes

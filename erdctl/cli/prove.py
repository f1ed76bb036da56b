"""`erdctl prove`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from erdctl.cli.options import Cluster, Maps, effect_names
from erdctl.cli.pages import Report, check_report
from erdctl.core.messages import counted

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from contextlib import AbstractContextManager
    from pathlib import Path

    from erdctl.prove.case import Wish
    from erdctl.prove.document import Proof


def command(
    cases: Annotated[int, typer.Option(min=1, help="How many.")] = 12,
    seed: Annotated[int, typer.Option(min=0, help="Of the first case; the next has the next.")] = 0,
    only: Annotated[
        list[str],
        typer.Option(
            "--effects",
            autocompletion=effect_names,
            metavar="NAME,...",
            help="Hide one of these: effects of the catalogue, or others that the plant knows.",
        ),
    ] = [],
    level: Annotated[
        float | None,
        typer.Option(metavar="X", help="Misfit of the refitted paper model, rms, over the noise."),
    ] = None,
    kind: Annotated[
        str | None,
        typer.Option(
            metavar="single|pair|null|unknown|crowded|sparse|left_out",
            help="What is hidden; unknown: what `erdctl effects` does not list; crowded, sparse and"
            " left_out, drawn only when asked for: one strong effect among faint ones in records"
            " that scatter, few short records of one duty or two, and an effect that is taken out"
            " of the catalogue for that case.",
        ),
    ] = None,
    concealment: Annotated[
        str | None,
        typer.Option(
            metavar="unlabelled|absorbed|not_logged",
            help="absorbed: the plain fit looks good; not_logged: a temperature, an onset.",
        ),
    ] = None,
    motion: Annotated[
        str | None,
        typer.Option(metavar="exact|measured", help="measured: xdot from a noisy, quantised x."),
    ] = None,
    colour: Annotated[
        str | None, typer.Option(metavar="white|ar1|pink", help="Of the force noise.")
    ] = None,
    nulls: Annotated[
        int | None,
        typer.Option(
            min=0,
            metavar="N",
            help="Instead: N short logs with nothing hidden, of many kinds of noise; with --on: so"
            " many diagnoses of LOG with nothing hidden, 10 if not given.",
        ),
    ] = None,
    keep: Annotated[
        str | None,
        typer.Option(
            metavar="DIR",
            help="Keep logs, fresh records, keys, diagnoses and scores here; what is there of the"
            " same proof is not done again.",
        ),
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Cases at a time; all cores if not given.")
    ] = None,
    cluster: Cluster = None,
    as_json: Annotated[bool, typer.Option("--json", help="Results as JSON on stdout.")] = False,
    output: Annotated[
        str | None,
        typer.Option("--output", "-o", metavar="FILE", help="Results as JSON to a file."),
    ] = None,
    report: Report = None,
    on: Annotated[
        str | None,
        typer.Option(metavar="LOG", help="Hide effects in this recording of your own instead."),
    ] = None,
    sizes: Annotated[
        str,
        typer.Option(metavar="X,...", help="With --on: sizes over the noise where it acts."),
    ] = "1,2,4",
    thin: Annotated[
        int, typer.Option(min=1, metavar="N", help="With --on: diagnose every Nth sample only.")
    ] = 1,
    maps: Maps = [],
) -> None:
    """Hide effects in an independent plant, diagnose its log, then open the key and score.

    A separate simulator, which shares no code with the models, draws a damper, a campaign, noise
    and what to hide. The SHA-256 of the sealed key is printed before `diagnose` reads the log; it
    reads nothing else. A seed gives the same case every time; --keep DIR keeps logs and keys, and
    with it a run that was ended is taken up where it stood.

    Scored are: the first name; the verdict; the region (intersection over union of at least 0.3
    with a true one); spurious findings; and the attainable reduction, which is the error removed on
    fresh, noise-free records, over what the true structure, fitted to the same log, removes.

    Of --kind crowded the first name must be that of the strong effect. Of --kind sparse a miss is
    `explained` by a name that is not hidden, and an interval of a parameter, in a model that is
    right, without the true value; not to name what such a log cannot tell is none.

    --nulls counts false alarms by the kind of noise, and prints how far noise alone moves each
    statistic that decides, beside its threshold.

    --on LOG hides effects in your own recording, under its own noise and misfit: to the measured
    force is added what the simulator says an effect would add on the motion and duty of the log.
    A size is the rms of what the log's own model, refitted, does not absorb of that, over what
    that diagnosis left where the effect acts. The table says from which size each effect is named
    beyond what is named anyway, and what is named when nothing was hidden.

    \b
    Examples:
      erdctl prove
      erdctl prove --cases 200 --seed 5000 -o proof.json --report proof.html
      erdctl prove --effects backlash,mount_compliance --level 3 --motion measured
      erdctl prove --kind null --colour pink --cases 40
      erdctl prove --kind crowded --cases 100 --seed 7000
      erdctl prove --seed 5017 --cases 1 --keep case
      erdctl prove --cases 1000 --seed 6000 --keep proof --cluster tcp://login1:8786
      erdctl prove --nulls 90 --seed 9000
      erdctl prove --on bench.parquet --thin 4 -o hidden.json
      erdctl prove --on bench.parquet --effects backlash,coulomb_friction --sizes 1,2 --nulls 0
    """
    from erdctl.core.errors import PartlyDone, UsageProblem
    from erdctl.io import documents
    from erdctl.prove.case import Wish, check
    from erdctl.prove.document import to_json
    from erdctl.prove.kept import Kept

    if cluster is not None:
        if on is not None or nulls is not None:
            raise UsageProblem("--cluster is for cases: leave --on and --nulls out")
        if keep is None or jobs is not None:
            raise UsageProblem(
                "--cluster takes --keep DIR, on a disk that its workers share, and no --jobs"
            )
    if nulls is not None and on is None:
        asked = (only, level, kind, concealment, motion, colour, keep, output, report)
        if any(asked) or as_json or not nulls:
            raise UsageProblem("--nulls N takes --seed and --jobs alone: it prints two tables")
        _nulls(range(seed, seed + nulls), jobs)
        return
    names = tuple(n.strip() for option in only for n in option.split(",") if n.strip())
    if on is not None:
        from erdctl.cli.prove_on import prove_on, refuse

        refuse(level=level, kind=kind, concealment=concealment, motion=motion, colour=colour,
               report=report)  # fmt: skip
        if output is not None:
            _must_exist(output)
        with _folder(keep) as folder:
            prove_on(
                on, maps, effects=names or None, sizes=sizes, nulls=10 if nulls is None else nulls,
                thin=thin, seed=seed, jobs=jobs, folder=folder, as_json=as_json, output=output,
            )  # fmt: skip
        return
    wish = Wish(
        effects=names or None, level=level, kind=kind, concealment=concealment, motion=motion,
        colour=colour,
    )  # fmt: skip
    seeds = range(seed, seed + cases)
    check(wish, seeds)
    if output is not None:
        _must_exist(output)
    check_report(report)
    with _folder(keep) as folder:
        Kept.of(folder, wish, seed)  # a directory of another proof is refused before all else
        proof = _run(wish, seeds, folder, jobs, cluster)
    document = to_json(proof)
    if as_json:
        documents.write(document, "-")
    if output is not None:
        documents.write(document, output)
    if report is not None:
        import sys

        from erdctl.cli.pages import write_report
        from erdctl.prove.tables import tables
        from erdctl.report.page.proof import proof_page
        from erdctl.report.page.render import Run

        run = Run(words=sys.argv[1:], details=[("seeds", f"{seeds.start} to {seeds.stop - 1}")])
        write_report(proof_page(document, list(tables(proof.summary)), run=run), report)
    _show(proof)
    if proof.failed:
        raise PartlyDone(f"{len(proof.failed)} of {counted(cases, 'case')} could not be scored")


def _nulls(seeds: Sequence[int], jobs: int | None) -> None:
    from erdctl.core.workers import cores
    from erdctl.prove import nulls
    from erdctl.report.text import progress, say, table

    done = 0
    with progress() as step:

        def on_result(result: nulls.NullResult) -> None:
            nonlocal done
            done += 1
            say(result.line)
            step("nulls", f"{done} of {len(seeds)} ({100 * done // len(seeds)} %)")

        results = nulls.nulls(seeds, jobs=min(jobs or cores(), len(seeds)), on_result=on_result)
    for title, header, rows in nulls.tables(results):
        table(title, header, rows)


def _run(
    wish: Wish, seeds: Sequence[int], folder: Path, jobs: int | None, address: str | None
) -> Proof:
    from erdctl.core.cluster import cluster_or_none
    from erdctl.core.messages import shown, tell
    from erdctl.core.workers import cores
    from erdctl.prove.document import proof_of
    from erdctl.prove.run import Outcome, prove
    from erdctl.prove.tables import line
    from erdctl.report.layout import wrapped
    from erdctl.report.text import QUIET, progress, say, width

    scored = 0
    say("nrmse on fresh records, without noise: paper's model, corrected, best that can be reached")
    with cluster_or_none(address) as there, progress() as step:

        def on_sealed(number: int, seed: int, sha256: str) -> None:
            say(f"case {number}, seed {seed}: sha256 {sha256}", "sealed")

        def on_outcome(outcome: Outcome) -> None:
            nonlocal scored
            scored += 1
            if not QUIET.get():
                tell(wrapped(shown(line(outcome)), width()))
            step("scored", f"{scored} of {len(seeds)} ({100 * scored // len(seeds)} %)")

        step("scored", f"0 of {len(seeds)} (0 %)")
        outcomes = prove(
            wish, seeds, folder if there is None else folder.absolute(), cluster=there,
            jobs=min(there.in_hand() if there else jobs or cores(), len(seeds)),
            on_sealed=lambda s: on_sealed(s.number, s.seed, s.sha256), on_outcome=on_outcome,
        )  # fmt: skip
    return proof_of(wish, seeds, outcomes)


def _show(proof: Proof) -> None:
    from erdctl.prove.tables import tables
    from erdctl.report.text import table

    for title, header, rows in tables(proof.summary):
        table(title, header, rows)


def _folder(keep: str | None) -> AbstractContextManager[Path]:
    """Where the cases lie: a directory of the user's, or one that goes when the block ends."""
    from contextlib import contextmanager
    from pathlib import Path
    from tempfile import TemporaryDirectory

    from erdctl.core import leftovers
    from erdctl.core.errors import UsageProblem

    @contextmanager
    def place() -> Iterator[Path]:
        if keep is None:
            with TemporaryDirectory(prefix="erdctl-") as name:
                leftovers.remember(name)
                yield Path(name)
            leftovers.forget(name)
            return
        path = Path(keep)
        try:
            path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageProblem(f"--keep {keep}: {error.strerror or error}") from None
        yield path

    return place()


def _must_exist(output: str) -> None:
    """A proof takes long; that its file cannot be written is said before, not after."""
    from pathlib import Path

    from erdctl.core.errors import UsageProblem

    parent = Path(output).absolute().parent
    if output != "-" and not parent.is_dir():
        raise UsageProblem(f"cannot write to '{output}': no directory {parent}")

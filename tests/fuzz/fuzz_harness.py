"""Every case through the command line in worker processes; what came of it, judged and counted."""

from __future__ import annotations

import json
import os
import re
import select
import shutil
import subprocess
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from queue import Queue
from typing import Any

import json_files
import numpy as np
import pyarrow.csv
import text_files
from places import FIXTURES

HANG = 60.0  # s of a processor's time
STARVED = 5  # times that on the clock: other processes may hold the processors
MEMORY = 2 << 30  # bytes, or 4 times the file
LOUD = 64 << 10  # bytes on stderr
CASES_A_WORKER = 400
HELD = 700 << 20  # bytes that a worker may keep; more would count as the peak of the next case
CODES = (0, 2, 3, 4)
RAW = re.compile(rb"[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]")
GOOD = FIXTURES / "bad" / "good.csv"
PARAMS = FIXTURES / "table_2.json"

# {} is the file of the case. Slow ones come seldom.
LOG_COMMANDS: tuple[tuple[int, str], ...] = (
    (20, "inspect {} --json"), (4, "inspect {}"), (20, "simulate P {} -o out.csv"),
    (14, "validate P {} --json"), (14, "identify {} -o out.json"), (8, "convert {} out.csv"),
    (4, "convert {} out.parquet"), (3, "convert {} out.feather"), (3, "convert {} out.mat"),
    (1, "convert {} out.mf4"), (2, "convert {} out.tdms"),
    (8, "mimic P {} --fault oil=0.5 -o out.csv"),
    (2, "mimic P {} --fault oil=0.5 --force -o out.mat --manifest out.json"),
    (1, "validate P {} --report out.html"), (1, "plot {} -o out.png"),
    (1, "diagnose {} --effects backlash --jobs 1 -o out.json"),
    (3, "inspect - --json < {}"), (3, "simulate P - < {}"), (2, "convert - out.csv < {}"),
)  # fmt: skip
PARAMETER_COMMANDS: tuple[tuple[int, str], ...] = (
    (12, "simulate {} L -o out.csv"), (6, "validate {} L --json"),
    (4, "mimic {} L --fault oil=0.5 -o out.csv --manifest out.json"), (3, "simulate - L < {}"),
    (2, "simulate {} --drive sine:freq=1,amp=0.01,duty=0.2,duration=2 -o out.csv"),
    (1, "plot L --params {} -o out.png"),
    (1, "diagnose L --params {} --effects backlash --jobs 1 -o out.json"),
)  # fmt: skip
GEOMETRY_COMMANDS: tuple[tuple[int, str], ...] = (
    (4, "derive {} -o out.json"),
    (1, "derive - < {}"),
)
FAMILIES = {"parameters": PARAMETER_COMMANDS, "document": PARAMETER_COMMANDS,
            "geometry": GEOMETRY_COMMANDS}  # fmt: skip


@dataclass(frozen=True)
class Trial:
    """A case and the command that it is given to."""

    number: int
    label: str
    data: bytes
    suffix: str
    command: str

    @property
    def family(self) -> str:
        """What the table counts it under: reader or document."""
        return re.split(r"[\[:]", self.label)[0].strip()


@dataclass
class Finding:
    """What is wrong with the outcome of a trial."""

    kind: str
    trial: Trial
    detail: str

    def __str__(self) -> str:
        return f"{self.kind}: erdctl {self.trial.command} | {self.trial.label} | {self.detail}"


@dataclass
class Row:
    """One line of the table."""

    codes: Counter[int] = field(default_factory=Counter)
    wrong: Counter[str] = field(default_factory=Counter)
    peak: int = 0
    slowest: float = 0.0
    slow: str = ""

    @property
    def cases(self) -> int:
        """How many."""
        return self.codes.total() + sum(self.wrong[k] for k in ("traceback", "crash", "hang"))


def trials(seed: int, count: int) -> Iterator[Trial]:
    """Cases of every generator in turn, each with a command drawn for it."""
    rng = np.random.default_rng(seed)
    makers: list[Any] = [text_files, json_files]
    if find_spec("binary_files") is not None:
        makers.append(import_module("binary_files"))
    shares = [count // len(makers)] * len(makers)
    shares[0] += count - sum(shares)
    made = [maker.cases(seed, share) for maker, share in zip(makers, shares, strict=True)]
    for number, (label, data, suffix) in enumerate(_in_turn(made)):
        commands = FAMILIES.get(re.split(r"[\[:]", label)[0].strip(), LOG_COMMANDS)
        weights = np.array([w for w, _ in commands], dtype=float)
        command = commands[int(rng.choice(len(commands), p=weights / weights.sum()))][1]
        yield Trial(number, label, data, suffix, command)


def _in_turn(sources: Sequence[Iterator[Any]]) -> Iterator[Any]:
    left = list(sources)
    while left:
        for source in [*left]:
            try:
                yield next(source)
            except StopIteration:
                left.remove(source)


class Worker:
    """A process that runs commands, begun anew after a crash, a hang, and many cases."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.process: subprocess.Popen[bytes] | None = None
        self.served = 0

    def ask(self, words: Sequence[str], stdin: str | None) -> dict[str, Any] | str:
        """The worker's answer, or "crash" or "hang"."""
        if self.process is None or self.served >= CASES_A_WORKER:
            self.end()
            self._begin()
        assert self.process is not None
        self.served += 1
        request = {"words": list(words), "folder": str(self.folder), "stdin": stdin}
        os.write(self.requests, (json.dumps(request) + "\n").encode())
        line, until, before = b"", time.monotonic() + STARVED * HANG, self._worked()
        while not line.endswith(b"\n"):
            ready, _, _ = select.select([self.answers], [], [], 0.5)
            if not ready:
                if time.monotonic() < until and self._worked() - before < HANG:
                    continue
                self.end()
                return "hang"
            piece = os.read(self.answers, 1 << 16)
            if not piece:
                code = self.process.wait()
                self.end()
                return f"crash {code}"
            line += piece
        found: dict[str, Any] = json.loads(line)
        if found["held"] > HELD:
            self.end()
        return found

    def _worked(self) -> float:
        """Processor's time of the worker and of its processes that have ended [s]."""
        assert self.process is not None
        try:
            fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        except OSError:  # not Linux: by the clock
            return time.monotonic() / STARVED
        return sum(int(f) for f in fields[11:15]) / os.sysconf("SC_CLK_TCK")

    def _begin(self) -> None:
        theirs, self.requests = os.pipe()
        self.answers, yours = os.pipe()
        script = Path(__file__).with_name("fuzz_worker.py")
        self.process = subprocess.Popen(
            [sys.executable, str(script), str(theirs), str(yours)],
            pass_fds=(theirs, yours), stdin=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(theirs)
        os.close(yours)
        self.served = 0

    def end(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            os.close(self.requests)
            os.close(self.answers)
            self.process = None


def run(
    cases: Iterable[Trial],
    folder: Path,
    workers: int,
    say: Callable[[str], None] = lambda line: None,
) -> tuple[dict[str, Row], list[Finding]]:
    """Every trial; rows of the table by family, and all that is wrong, which `say` is told."""
    rows: dict[str, Row] = defaultdict(Row)
    findings: list[Finding] = []
    free: Queue[Worker] = Queue()
    for i in range(workers):
        place = folder / f"worker {i}"
        place.mkdir(parents=True)
        free.put(Worker(place))

    def one(trial: Trial) -> None:
        worker = free.get()
        try:
            found = attempt(worker, trial, rows[trial.family])
        finally:
            free.put(worker)
        findings.extend(found)
        for finding in found:
            rows[trial.family].wrong[finding.kind] += 1
            say(f"#{trial.number} {str(finding)[:700]}")

    with ThreadPoolExecutor(workers) as pool:
        for _ in pool.map(one, cases):
            pass
    while not free.empty():
        free.get().end()
    return dict(rows), findings


def attempt(worker: Worker, trial: Trial, row: Row) -> list[Finding]:
    """One trial in a folder of its own, and what is wrong with what came of it."""
    place = worker.folder
    shutil.rmtree(place)
    place.mkdir()
    case = f"case{trial.suffix}"
    (place / case).write_bytes(trial.data)
    shutil.copy(GOOD, place / "good.csv")
    shutil.copy(PARAMS, place / "params.json")
    words, _, source = trial.command.partition(" < ")
    known = {"{}": case, "P": "params.json", "L": "good.csv"}
    answer = worker.ask([known.get(w, w) for w in words.split()], case if source else None)
    if isinstance(answer, str):
        kind, _, detail = answer.partition(" ")
        return [Finding(kind, trial, detail)]
    row.peak = max(row.peak, answer["peak"])
    if answer["seconds"] > row.slowest:
        row.slowest, row.slow = answer["seconds"], f"#{trial.number} {trial.command} {trial.label}"
    if answer["trace"] is not None:
        return [Finding("traceback", trial, " / ".join(answer["trace"].splitlines()[-3:]))]
    row.codes[answer["code"]] += 1
    problems = list(_wrong(place, case, trial, answer))
    return [Finding(kind, trial, detail) for kind, detail in problems]


def _wrong(
    place: Path, case: str, trial: Trial, answer: dict[str, Any]
) -> Iterator[tuple[str, str]]:
    code, said = answer["code"], (place / ".err").read_bytes()
    printed = (place / ".out").read_bytes()
    last = said.decode(errors="replace").strip().splitlines()[-1:]
    if code not in CODES:
        yield "exit code", str(code)
    if b"Traceback" in said or b"internal error" in said:
        yield "traceback", str(last)
    if RAW.search(said):
        yield "control bytes", repr(RAW.search(said))
    if len(said) > LOUD:
        yield "loud", f"{len(said)} bytes"
    if answer["peak"] > max(MEMORY, 4 * len(trial.data)):
        yield "memory", f"{answer['peak'] / 2**30:.2f} GiB"
    if trial.data != (place / case).read_bytes():
        yield "input", "was changed"
    files = {p.name for p in place.iterdir()} - {case, "good.csv", "params.json", ".out", ".err"}
    if any(f.startswith(".erdctl") for f in files):
        yield "left over", str(files)
    if code == 0:
        for name in files:
            yield from (("nan", f"{name}: {what}") for what in _unsound(place / name, trial))
        if "--json" in trial.command:
            yield from (("nan", what) for what in _unsound_json(printed, words(trial)))
        return
    if files or printed:
        yield "half written", f"{files}, {len(printed)} bytes on stdout"
    errors = [
        x for x in said.decode(errors="replace").splitlines() if x.startswith("erdctl: error")
    ]
    if code != 2 and len(errors) != 1:
        yield "message", f"{len(errors)} error lines: {last}"
    if code == 3 and not any(n in e for e in errors for n in (case, "stdin", "good.csv")):
        yield "message", f"no file in it: {errors}"


def words(trial: Trial) -> str:
    """The name of the command."""
    return trial.command.split()[0]


def _unsound(file: Path, trial: Trial) -> Iterator[str]:
    """What a result holds that no sound input makes: NaN, NUL, half a document."""
    command = words(trial)
    if file.suffix == ".json":
        yield from _unsound_json(file.read_bytes(), command)
    elif file.suffix == ".csv":
        data = file.read_bytes()
        # A text that holds them itself keeps them in the columns that pass through.
        given = trial.family in ("csv", "text") and b"\x00" in trial.data
        if b"\x00" in data and command != "convert" and not given:
            yield "NUL bytes"
        if command in ("simulate", "mimic"):
            yield from _unsound_table(file, command)


def _unsound_table(file: Path, command: str) -> Iterator[str]:
    new = ("force_model",) if command == "simulate" else ("duty", "force_expected")
    options = pyarrow.csv.ParseOptions(newlines_in_values=True)
    table = pyarrow.csv.read_csv(file, parse_options=options)
    for name in set(new) & set(table.column_names):
        values = np.array(table.column(name).to_pylist(), dtype=float)
        if not np.isfinite(values).all():
            yield f"{name} is not finite in {np.count_nonzero(~np.isfinite(values))} rows"


def _unsound_json(data: bytes, command: str) -> Iterator[str]:
    try:
        document = json.loads(data, parse_constant=_refuse)
    except ValueError as error:
        yield f"no JSON: {error}"
        return
    # NaN is written as null; an NRMSE may be that, over a force without range.
    if command == "validate" and b'"rms": null' in data:
        yield "an rms is null"
    if command == "identify":
        for way in ("compression", "release"):
            for symbol, found in document[way].items():
                if found["value"] is None and not found.get("reason"):
                    yield f"{way}.{symbol} is null without a reason"


def _refuse(name: str) -> None:
    raise ValueError(f"{name} in JSON")


WRONG = ("traceback", "crash", "hang", "nan")


def table(rows: dict[str, Row]) -> str:
    """The outcome as Markdown: a line for every reader and document."""
    out = [
        "| reader or document | cases | exit 0 | 1 | 2 | 3 | 4 | tracebacks | crashes | hangs | NaN"
        " | other | peak | slowest |",
        "|---|" + "---:|" * 13,
    ]
    total = Row()
    for name, row in sorted(rows.items()):
        out.append(_line(name, row))
        total.codes += row.codes
        total.wrong += row.wrong
        total.peak, total.slowest = max(total.peak, row.peak), max(total.slowest, row.slowest)
    return "\n".join([*out, _line("all", total)])


def _line(name: str, row: Row) -> str:
    other = sum(n for kind, n in row.wrong.items() if kind not in WRONG)
    cells = [
        name, row.cases, *(row.codes[i] for i in range(5)), *(row.wrong[k] for k in WRONG), other,
        f"{row.peak / 2**20:.0f} MiB", f"{row.slowest:.1f} s",
    ]  # fmt: skip
    return "| " + " | ".join(str(c) for c in cells) + " |"


def main() -> None:
    """python tests/fuzz/fuzz_harness.py SEED COUNT [ONE]: the table, and what is wrong."""
    import tempfile

    seed, count = int(sys.argv[1]), int(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        chosen = trials(seed, count)
        if len(sys.argv) > 3:
            only = int(sys.argv[3])
            chosen = (t for t in chosen if t.number == only)
        rows, _ = run(chosen, Path(folder), workers=2, say=print)
    print(table(rows))
    for row in sorted(rows.values(), key=lambda r: -r.slowest)[:5]:
        print(f"{row.slowest:.1f} s: {row.slow[:200]}")


if __name__ == "__main__":
    main()

"""Text logs as nobody should hand them over: damaged, foreign, hostile. Seeded.

    cases(seed, count) -> iterator of (label, bytes, suffix)

The same seed gives the same cases. A sound log of one or more records is spoiled in its numbers,
in its cells, in its dialect and at last in its bytes.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence

import numpy as np

Case = tuple[str, bytes, str]
Rng = np.random.Generator
Rows = list[list[str]]

EXTREME = (
    0.0, -0.0, 1.0, -1.0, 5e-324, 1e-300, 1e300, -1e308, 1e12, -1e12, 9.9e11, 1e9, 1e-15, 0.1,
    np.nan, np.inf, -np.inf,
)  # fmt: skip
CELLS = (
    "", " ", "-", "nan", "NaN", "inf", "-Infinity", "1e999", "-1e999", "0x1F", "1,5", "1.5.2",
    "--1",
    "1_000", "TRUE", "null", "NA", "#N/A", "None", "\x1b[2J\x1b]0;gone\x07", "\x9b31m", "\x00",
    "\u202e1.0", "٣", "1", "1e-400", "'1", '"', '"a', '"a\nb"', "=cmd|' /C calc'!A0", "\ufeff1",
    "12:30:01.5", "2024-03-01T12:00:00", "03/01/2024 11:59:59 PM", "0 days 00:00:01.5", "1 mm",
    "x" * 10_000, "9" * 5_000, "a,b", "a;b", "a\tb", "\r", "\x0b", "\x85", "\u2028",
)  # fmt: skip
NAMES = (
    "", " ", "t", "x", "xdot", "duty", "force", "record", "temperature", "force_model", "t [ms]",
    "x [mm]", "Displacement (mm)", "Force [kN]", "x [parsec]", "x [" + "m*" * 700 + "m]", "x [m]]",
    "time", "T", "Zeit [s]", "Kraft [N]", "\x1b[31mx", "x" * 10_000, "x\x00", "[mm]", "t,x", "[]",
)  # fmt: skip


def cases(seed: int, count: int) -> Iterator[Case]:
    """`count` text logs; the label says what was done to each."""
    rng = np.random.default_rng(seed)
    for index in range(count):
        names, rows, said = _sound(rng)
        for _ in range(_few(rng)):
            said.append(_pick(rng, SPOILERS)(names, rows, rng))
        data, dialect = _written(names, rows, rng)
        said.append(dialect)
        for _ in range(_few(rng) if rng.random() < 0.4 else 0):
            data, what = _pick(rng, DAMAGES)(data, rng)
            said.append(what)
        suffix = _pick(rng, (".csv", ".csv", ".csv", ".txt", ".lvm", ".dat"))
        kind = "text" if dialect or suffix != ".csv" else "csv"
        yield f"{kind} [{seed}/{index}]: {', '.join(s for s in said if s)}", data, suffix


def _few(rng: Rng) -> int:
    return int(rng.choice([0, 1, 1, 1, 2, 3]))


def _pick(rng: Rng, choices: Sequence[object]) -> object:
    return choices[int(rng.integers(len(choices)))]


def _sound(rng: Rng) -> tuple[list[str], Rows, list[str]]:
    records = int(rng.choice([1, 1, 1, 2, 3, 40]))
    length = int(rng.choice([1, 2, 3, 4, 10, 60, 200, 400]))
    step = float(rng.choice([1e-4, 1e-3, 1e-2, 0.5]))
    columns: dict[str, list[float]] = {n: [] for n in ("t", "x", "xdot", "duty", "force")}
    for _ in range(records):
        t = np.arange(length) * step
        omega, phase = 2 * np.pi * rng.uniform(0.5, 5.0), rng.uniform(0, 6.28)
        x = 0.01 * np.sin(omega * t + phase)
        xdot = 0.01 * omega * np.cos(omega * t + phase)
        duty = np.where(t % 0.7 < 0.35, 0.0, rng.choice([0.1, 0.2, 0.3]))
        force = 800.0 * x + 60.0 * xdot + 9.0 * duty * np.sign(xdot) + rng.normal(0, 0.2, length)
        for name, values in zip(columns, (t, x, xdot, duty, force), strict=True):
            columns[name] += values.tolist()
    names = [n for n in columns if n not in ("xdot", "duty") or rng.random() < 0.8]
    rows = [[f"{columns[n][i]:.9g}" for n in names] for i in range(records * length)]
    if records > 1 and rng.random() < 0.9:
        names.append("record")
        for i, row in enumerate(rows):
            row.append(f"run {i // length}")
    return names, rows, [f"{records} x {length} rows"]


def _extreme(names: list[str], rows: Rows, rng: Rng) -> str:
    column = int(rng.integers(len(names)))
    value = float(rng.choice(EXTREME))
    if rng.random() < 0.3:
        for row in rows:
            row[column] = repr(value)
        return f"all of {names[column]!r} are {value!r}"
    at = int(rng.integers(len(rows)))
    rows[at][column] = repr(value)
    return f"row {at} of {names[column]!r} is {value!r}"


def _scaled(names: list[str], rows: Rows, rng: Rng) -> str:
    column = int(rng.integers(len(names)))
    factor, offset = 10.0 ** rng.integers(-320, 14), float(rng.choice([0, 0, 1e9, -5.0]))
    for row in rows:
        try:
            row[column] = repr(float(row[column]) * factor + offset)
        except ValueError:
            return ""
    return f"{names[column]!r} times {factor:g} plus {offset:g}"


def _cell(names: list[str], rows: Rows, rng: Rng) -> str:
    cell = str(_pick(rng, CELLS))
    column = int(rng.integers(len(names)))
    some = range(len(rows)) if rng.random() < 0.2 else [int(rng.integers(len(rows)))]
    for at in some:
        rows[at][column] = cell
    return f"{len(some)} cells of column {column} are {cell[:12]!r}"


def _name(names: list[str], rows: Rows, rng: Rng) -> str:
    column, name = int(rng.integers(len(names))), str(_pick(rng, NAMES))
    names[column] = name
    return f"column {column} is called {name[:12]!r}"


def _column(names: list[str], rows: Rows, rng: Rng) -> str:
    column = int(rng.integers(len(names)))
    if rng.random() < 0.5 and len(names) > 1:
        for row in (names, *rows):
            del row[column]
        return f"no column {column}"
    names.append(str(_pick(rng, NAMES)))
    for row in rows:
        row.append(row[column])
    return f"column {column} twice"


def _order(names: list[str], rows: Rows, rng: Rng) -> str:
    a, b = sorted(int(i) for i in rng.integers(len(rows), size=2))
    way = int(rng.integers(4))
    if way == 0:
        rows[a], rows[b] = rows[b], rows[a]
    elif way == 1:
        rows.insert(a, [*rows[b]])
    elif way == 2:
        rows.reverse()
    else:
        del rows[a : b + 1]
    return f"{('swapped', 'repeated', 'reversed', 'removed')[way]} rows {a}, {b}"


def _ragged(names: list[str], rows: Rows, rng: Rng) -> str:
    at = int(rng.integers(len(rows) + 1))
    rows.insert(at, [str(_pick(rng, CELLS))] * int(rng.integers(0, 2 * len(names) + 1)))
    return f"a row of another length at {at}"


def _guarded(spoil: Callable[[list[str], Rows, Rng], str]) -> Callable[..., str]:
    def safely(names: list[str], rows: Rows, rng: Rng) -> str:
        return spoil(names, rows, rng) if rows and all(len(r) == len(names) for r in rows) else ""

    return safely


SPOILERS = tuple(
    _guarded(s)
    for s in (_extreme, _extreme, _scaled, _cell, _cell, _name, _column, _order, _order, _ragged)
)


def _written(names: list[str], rows: Rows, rng: Rng) -> tuple[bytes, str]:
    """A third in the contract's dialect, the others as programs and countries have it."""
    if rng.random() < 0.45:
        return "".join(",".join(r) + "\n" for r in (names, *rows)).encode(errors="replace"), ""
    separator = str(_pick(rng, (",", ";", "\t", "  ", " ", "|")))
    comma = separator != "," and rng.random() < 0.5
    end = str(_pick(rng, ("\n", "\r\n", "\r")))
    lines = [separator.join(r) for r in (names, *rows)]
    if comma:
        lines = [lines[0], *(line.replace(".", ",") for line in lines[1:])]
    front: list[str] = []
    if rng.random() < 0.4:
        front = ["Operator: Müller", "Date\t2024-03-01", "***End_of_Header***", ""][
            : int(rng.integers(5))
        ]
    if rng.random() < 0.3:
        front += ["# a comment, with; both\tseparators"]
    if rng.random() < 0.3:
        lines.insert(1, separator.join(["(s)", "[mm]", "mm/s", "%", "N", ""][: len(names)]))
    if rng.random() < 0.2:
        lines = lines[1:]
    encoding = str(_pick(rng, ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1", "cp1252")))
    data = end.join([*front, *lines, ""]).encode(encoding, errors="replace")
    return data, f"{encoding}, {separator!r}, {'decimal comma' if comma else 'point'}, {end!r}"


def _flipped(data: bytes, rng: Rng) -> tuple[bytes, str]:
    out = bytearray(data)
    for at in rng.integers(len(out), size=int(rng.integers(1, 9))) if out else ():
        out[at] ^= 1 << int(rng.integers(8))
    return bytes(out), "bits flipped"


def _cut(data: bytes, rng: Rng) -> tuple[bytes, str]:
    return data[: int(rng.integers(len(data) + 1))], "cut"


def _inserted(data: bytes, rng: Rng) -> tuple[bytes, str]:
    at = int(rng.integers(len(data) + 1))
    piece = _pick(rng, (b"\x00" * 9, b"\xff\xfe", b'"', b"\n\n\n", b"," * 3000, b"\x1b[2J", b"\r",
                        rng.bytes(40), b"PAR1", b"ARROW1\0\0", b"MDF     4.10"))  # fmt: skip
    assert isinstance(piece, bytes)
    return data[:at] + piece + data[at:], f"{piece[:6]!r} inserted"


def _moved(data: bytes, rng: Rng) -> tuple[bytes, str]:
    a, b = sorted(int(i) for i in rng.integers(len(data) + 1, size=2))
    return data[b:] + data[a:b], "pieces exchanged"


DAMAGES = (_flipped, _flipped, _cut, _inserted, _inserted, _moved)


if __name__ == "__main__":
    for label, data, _ in cases(1, 20):
        print(json.dumps(label), len(data))

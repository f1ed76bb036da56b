"""The same log as any lab might write it: random dialects, from a seed.

Imported by the tests of this room; it shares no code with the reader.
"""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass, field
from typing import Any

import numpy as np

START = dt.datetime(2022, 4, 29, 11, 56, 20, 699000)
ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1", "cp1252")
SEPARATORS = (",", ";", "\t", "|", " ", ", ", "; ", "fixed")
CLOCKS = (
    "seconds", "ms", "iso", "iso space", "german", "us 24h", "us am/pm", "us slash dmy",
    "two columns",
    "timedelta", "h:mm:ss", "iso zone", "named",
)  # fmt: skip
UNITS = {"x": {"m": 1.0, "mm": 1e-3, "cm": 1e-2}, "force": {"N": 1.0, "kN": 1e3}}
BLOCKS = ("none", "keys", "recorder", "title", "mts", "comments", "excel")


@dataclass
class Foreign:
    """A file, and what it must read to.

    data : its bytes;  maps : options that a user needs;  truth : column -> values in SI
    tolerance : of t [s];  about : how it was drawn
    """

    data: bytes
    truth: dict[str, np.ndarray]
    maps: list[str]
    about: dict[str, Any]
    tolerance: float = 1e-9
    text: list[str] = field(default_factory=list)


def printed(value: float, digits: int, decimal: str, thousands: str, *, exponent: bool) -> str:
    text = f"{value:.{digits}e}" if exponent else f"{value:{',' if thousands else ''}.{digits}f}"
    return text.replace(",", "\0").replace(".", decimal).replace("\0", thousands)


def stamp(clock: str, seconds: float, decimal: str) -> list[str]:
    """A time as the lab writes it; to the millisecond, as its clock has it."""
    at = START + dt.timedelta(milliseconds=round(seconds * 1e3))
    ms = f"{at.microsecond // 1000:03d}"
    point = "," if decimal == "," and clock == "german" else "."
    total = round(seconds * 1e3)
    hours, minutes = total // 3_600_000, total // 60_000 % 60
    hms = f"{hours:02d}:{minutes:02d}:{total // 1000 % 60:02d}.{total % 1000:03d}"
    half = at.hour % 12 or 12
    return {
        "iso": [at.strftime("%Y-%m-%dT%H:%M:%S.") + ms],
        "iso space": [at.strftime("%Y-%m-%d %H:%M:%S.") + ms],
        "iso zone": [at.strftime("%Y-%m-%dT%H:%M:%S.") + ms + "+02:00"],
        "german": [at.strftime("%d.%m.%Y %H:%M:%S") + point + ms],
        "us 24h": [at.strftime("%m/%d/%Y %H:%M:%S.") + ms],
        "us am/pm": [
            at.strftime("%m/%d/%Y ") + f"{half:02d}" + at.strftime(":%M:%S.") + ms
            + (" PM" if at.hour >= 12 else " AM")
        ],
        "us slash dmy": [at.strftime("%d/%m/%Y %H:%M:%S.") + ms],
        "two columns": [at.strftime("%Y-%m-%d"), at.strftime("%H:%M:%S.") + ms],
        "timedelta": [f"{total // 86400000} days {hms}"],
        "h:mm:ss": [hms],
        "named": [at.strftime("%d-%b-%Y %H:%M:%S.") + ms],
    }[clock]  # fmt: skip


def draw(seed: int) -> Foreign:
    """One file; small enough to write thousands of."""
    rng = np.random.default_rng(seed)

    def pick(options: Any) -> Any:
        return options[int(rng.integers(len(options)))]

    n = int(rng.integers(12, 60))
    dt_ms = int(pick((1, 2, 5, 10)))
    t = np.arange(n) * dt_ms * 1e-3
    amplitude = float(pick((0.004, 0.025, 0.3)))
    x = amplitude * np.sin(2 * np.pi * 2.0 * t + rng.uniform(0, 6)) + rng.uniform(-0.01, 0.01)
    force = float(pick((3.0, 900.0, 25_000.0))) * np.cos(2 * np.pi * 2.0 * t) + rng.normal(0, 2, n)
    separator, clock = pick(SEPARATORS), pick(CLOCKS)
    decimal = pick((".", ",")) if separator not in (",", ", ") or rng.random() < 0.15 else "."
    quoted = (separator in (",", ", ") and decimal == ",") or rng.random() < 0.05
    if separator in (" ", "fixed"):
        quoted = False
        clock = pick(("seconds", "ms", "iso", "h:mm:ss", "two columns"))
    sign = {", ": ",", "; ": ";", "fixed": " "}.get(separator, separator)
    thousands = ""
    if rng.random() < 0.15 and separator not in (" ", "fixed") and (quoted or sign != ","):
        thousands = pick((",", " ", "'")) if decimal == "." else pick((".", " "))
    units = {c: pick(list(UNITS[c])) for c in UNITS}
    digits = {"x": int(rng.integers(2, 7)), "force": int(rng.integers(1, 5))}
    exponent = rng.random() < 0.12
    if exponent:
        thousands = ""
    clock_name = "Date/Time" if clock not in ("seconds", "ms") else "Time"
    names = [pick(("Sample", "Index"))] if rng.random() < 0.3 else []
    numbered = bool(names)
    times = ["Date", "Clock"] if clock == "two columns" else [clock_name]
    names += [*times, pick(("Displacement", "Weg", "Stroke")), pick(("Load", "Force", "Kraft"))]
    style = pick(("(u)", "[u]", "/u", ", u", "row", "row brackets", "map"))
    if sign == "," and style == ", u":
        style = "(u)"
    if sign == " " and style not in ("row", "map", "/u"):
        style = "row"
    if style.startswith("row") and clock not in ("seconds", "ms"):
        style = "map" if rng.random() < 0.5 else style
    events = rng.random() < 0.25 and sign != " "
    comment = bool(rng.random() < 0.2)
    trailing = rng.random() < 0.15 and sign != " "
    extra = rng.random() < 0.3
    if extra:
        names.append(pick(("Aux 1", "Temp °C", "Druck ü")) if sign != " " else "Aux")
    unit_of = {"Time": "s" if clock == "seconds" else "ms"}
    unit_of[names[numbered + len(times)]] = units["x"]
    unit_of[names[numbered + len(times) + 1]] = units["force"]

    def titled(name: str) -> str:
        unit = unit_of.get(name)
        if unit is None or style in ("row", "row brackets", "map"):
            return name
        return (
            name
            + {"(u)": f" ({unit})", "[u]": f" [{unit}]", "/u": f"/{unit}", ", u": f", {unit}"}[
                style
            ]
        )

    header = [*map(titled, names), *(["Events"] if events else [])]
    shown: dict[str, list[float]] = {"t": [], "x": [], "force": []}
    rows = []
    for i in range(n):
        row = [str(i + 1)] if numbered else []
        if clock in ("seconds", "ms"):
            value = t[i] * (1.0 if clock == "seconds" else 1e3)
            places = 3 if clock == "seconds" else int(digits["x"] > 4)
            text = printed(value, places, decimal, "", exponent=False)
            row.append(text)
            shown["t"].append(
                float(text.replace(decimal, ".")) / (1.0 if clock == "seconds" else 1e3)
            )
        else:
            row += stamp(clock, t[i], decimal)
            shown["t"].append(round(t[i] * 1e3) / 1e3)
        for name, values in (("x", x), ("force", force)):
            scale = UNITS[name][units[name]]
            text = printed(values[i] / scale, digits[name], decimal, thousands, exponent=exponent)
            row.append(text)
            plain = f"{values[i] / scale:.{digits[name]}{'e' if exponent else 'f'}}"
            shown[name].append(float(plain) * scale)
        if extra:
            row.append(printed(20.0 + i / 7, 2, decimal, "", exponent=False))
        if events and (i == 0 or rng.random() < 0.05):
            row.append("DAQ Start" if i == 0 else "mark")
        rows.append(row)

    def line(cells: list[str], *, sample: bool = True) -> str:
        if separator == "fixed":
            return "  ".join(f"{c:>14}" for c in cells)
        if separator == " ":
            return " ".join(cells)
        quote = quoted and sample
        text = separator.join(f'"{c}"' if quote or sign in c else c for c in cells)
        return text + sign if trailing and not (events and len(cells) != len(header)) else text

    lines = block(pick(BLOCKS), pick, sign, decimal, dt_ms)
    if comment and sign != " ":
        lines.append("# bench 3, operator A")
    headed = "none" if rng.random() < 0.08 and style == "map" and not trailing else "row"
    if headed == "row":
        lines.append(line(header, sample=False))
        if style.startswith("row"):
            cells = [unit_of.get(name, "-") for name in names] + (["-"] if events else [])
            if style == "row brackets":
                cells = [f"[{c}]" for c in cells]
            lines.append(line(cells, sample=False))
    body = [line(row) for row in rows]
    if comment and rng.random() < 0.5:
        body.insert(int(rng.integers(2, n)), pick(("# pause", "#", "# 1,2;3")))
    if rng.random() < 0.1:
        body.insert(int(rng.integers(2, n)), "")
    ends = pick(("\n", "\r\n", "\r\n", "\r"))
    encoding = pick(ENCODINGS)
    text = ends.join([*lines, *body]) + (ends if rng.random() < 0.8 else "")
    if encoding in ("latin-1", "cp1252"):
        text = text.replace("’", "'")
    data = text.encode(encoding)
    maps: list[str] = []
    at = {
        name: (f"column_{i}" if headed == "none" else titled(name))
        for i, name in enumerate(names, 1)
    }
    if style == "map" or headed == "none":
        for target, name in zip(("x", "force"), names[numbered + len(times) :], strict=False):
            maps.append(f"{target}={at[name]}[{unit_of[name]}]")
        if clock in ("seconds", "ms"):
            maps.append(f"t={at['Time']}[{unit_of['Time']}]")
        elif headed == "none":
            maps.append(f"t={at[times[-1]]}")
    about = {
        "seed": seed, "separator": separator, "decimal": decimal, "thousands": thousands,
        "clock": clock, "encoding": encoding, "style": style, "quoted": quoted, "events": events,
        "trailing": trailing, "header": headed, "exponent": exponent, "digits": digits,
    }  # fmt: skip
    truth = {name: np.array(values) for name, values in shown.items()}
    return Foreign(data, truth, maps, about)


def block(kind: str, pick: Any, sign: str, decimal: str, dt_ms: int) -> list[str]:
    """What recorders write above the header."""
    rate = 1000 // dt_ms
    blocks: dict[str, list[str]] = {
        "none": [],
        "title": ["Damper test 29.04.2022, bench 3", ""],
        "keys": ["Operator: A. Meier", f"Sampling Rate: {rate}", "Gain: 1.5", ""],
        "recorder": ["Header Size:  5", "Version:  2", f"Sampling Interval:  {dt_ms / 1000}",
                     f"Sampling Rate:  {rate}", "Device Serial Number:  0"],
        "mts": ["MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A", "Data Header:\tTime:\t12.345\tSec", ""],
        "comments": ["% test 7", "% gain 2.0, 3.5"],
        "excel": [f"sep={sign}"] if sign in ",;\t|" else [],
    }  # fmt: skip
    return blocks[kind]

"""Parameter and geometry files as nobody should hand them over. Seeded.

    cases(seed, count) -> iterator of (label, bytes, suffix)

The first word of a label is the kind of document: `parameters`, `geometry`, or `document` for those
that no command reads. Sound ones with effects at and within their bounds are among them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
from places import FIXTURES

from erdctl.effects import catalogue
from erdctl.io.units import UNITS

Case = tuple[str, bytes, str]
Rng = np.random.Generator

PARAMETERS = json.loads((FIXTURES / "table_2.json").read_text())
GEOMETRY = json.loads((FIXTURES / "geometry_inove.json").read_text())
SCHEMAS = ("diagnosis", "inspection", "validation", "pwm", "proof")
VALUES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, -0.0, 1e-300, 5e-324, 1e300, -1e300, 1e12, 2**63, 10**40, "", "x",
    "1.5", "nan", "\x1b[2J\x07", "\u202e", "x" * 10_000, "\ud800", [], [1, 2], [[]], {},
    {"value": 1},
    {"value": None}, {"value": None, "assumed": -1.0}, {"value": "1"}, {"value": 1.0, "unit": "mm"},
    {"value": 1.0, "unit": "m*" * 800 + "m"}, {"value": 1.0, "unit": "\x1b[2J"},
    {"value": 1.0, "unit": None, "stderr": -1.0}, {"value": 1.0, "stderr": 1e308},
)  # fmt: skip
NAMES = (
    "__init__", "__pycache__", "..", "../effects/backlash", "a.b", "", "os", "backlash\x00",
    "\x1b[2J",
    "Backlash", "x" * 10_000, "erdctl.effects.backlash", "class", "ﬁ",
)  # fmt: skip
FRAGMENTS = (
    b"NaN", b"Infinity", b"-Infinity", b"1e999", b"-1e999", b"0x10", b"01", b"1.", b"[" * 50_000,
    b'{"a":' * 50_000, b"9" * 5_000, b"\xff", b"\x00", b'"\\ud800"', b"// no", b"'x'", b",", b"}",
    b'"\x1b[2J"',
)  # fmt: skip


def cases(seed: int, count: int) -> Iterator[Case]:
    """`count` documents; the label says what was done to each."""
    rng = np.random.default_rng(seed)
    for index in range(count):
        draw = rng.random()
        if draw < 0.75:
            kind, document = "parameters", _parameters(rng)
        elif draw < 0.95:
            kind, document = "geometry", _copy(GEOMETRY)
        else:
            name = SCHEMAS[int(rng.integers(len(SCHEMAS)))]
            kind, document = "document", {"schema": f"erdctl.{name}/1"}
        said = [_spoiled(document, rng) for _ in range(int(rng.choice([0, 1, 1, 2, 3])))]
        data = json.dumps(document).encode()
        if rng.random() < 0.35:
            data, what = _damaged(data, rng)
            said.append(what)
        yield f"{kind} [{seed}/{index}]: {', '.join(said)}", data, ".json"


def _copy(document: Any) -> Any:
    return json.loads(json.dumps(document))


def _parameters(rng: Rng) -> dict[str, Any]:
    out: dict[str, Any] = _copy(PARAMETERS)
    known = catalogue()
    chosen = rng.choice(len(known), size=int(rng.choice([0, 0, 1, 1, 2, 4])), replace=False)
    out["effects"] = [
        {
            "effect": known[i].name,
            "parameters": {
                q.symbol: _within(q.low, q.high, q.start, rng) for q in known[i].quantities
            },
        }
        for i in chosen.tolist()
    ]  # fmt: skip
    out["provenance"] = {
        "ranges": {name: [-0.01, 0.01] for name in list(UNITS)[:4]},
        "noise_rms": 0.2,
    }
    return out


def _within(low: float, high: float, start: float, rng: Rng) -> float:
    """Any value that the bounds admit; for most the start, since two extremes hide each other."""
    draw = rng.random()
    if draw < 0.15 and abs(low) < 1e300:
        return low
    if draw < 0.3 and abs(high) < 1e300:
        return high
    return start if draw < 0.7 else min(max(start * 10.0 ** rng.uniform(-3, 3), low), high)


def _places(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, Any]]:
    """Every field and element: what holds it, and its key."""
    if isinstance(node, dict | list):
        for key in list(node) if isinstance(node, dict) else range(len(node)):
            yield node, key
            yield from _places(node[key], (*path, key))


def _spoiled(document: dict[str, Any], rng: Rng) -> str:
    places = list(_places(document))
    if not places:
        return ""
    node, key = places[int(rng.integers(len(places)))]
    way = int(rng.integers(6))
    if way == 0:
        del node[key]
        return f"no {str(key)[:12]!r}"
    if way == 1 and isinstance(node, dict):
        name = NAMES[int(rng.integers(len(NAMES)))]
        node[name] = node.pop(key)
        return f"{str(key)[:12]!r} is called {name[:12]!r}"
    if way == 2 and key == "effect":
        node[key] = NAMES[int(rng.integers(len(NAMES)))]
        return f"effect {node[key][:12]!r}"
    if way == 3 and isinstance(node[key], int | float):
        node[key] = float(node[key]) * 10.0 ** int(rng.integers(-30, 30))
        return f"{str(key)[:12]!r} is {node[key]!r}"
    value = VALUES[int(rng.integers(len(VALUES)))]
    node[key] = _copy(value) if isinstance(value, dict | list) else value
    return f"{str(key)[:12]!r} is {str(value)[:12]!r}"


def _damaged(data: bytes, rng: Rng) -> tuple[bytes, str]:
    at = int(rng.integers(len(data) + 1))
    way = int(rng.integers(7))
    if way == 0:
        return data[:at], "cut"
    if way == 1:
        piece = FRAGMENTS[int(rng.integers(len(FRAGMENTS)))]
        return data[:at] + piece + data[at:], f"{piece[:8]!r} inserted"
    if way == 2:  # a number becomes something else
        numbers = [
            i
            for i in range(len(data))
            if data[i : i + 2] == b": " and data[i + 2 : i + 3].isdigit()
        ]
        if numbers:
            i = numbers[int(rng.integers(len(numbers)))] + 2
            piece = FRAGMENTS[int(rng.integers(len(FRAGMENTS)))]
            end = min(j for j in (data.find(c, i) for c in (b",", b"}", b"]")) if j > 0)
            return data[:i] + piece + data[end:], f"a number is {piece[:8]!r}"
    if way == 3:
        return b"\xef\xbb\xbf" + data, "a byte order mark"
    if way == 4:
        return data.decode(errors="replace").encode("utf-16"), "UTF-16"
    if way == 5:
        key = data[: data.find(b":") + 1]
        return key + b"1, " + data[1:], "a field twice"
    out = bytearray(data)
    for i in rng.integers(len(out), size=3):
        out[i] ^= 1 << int(rng.integers(8))
    return bytes(out), "bits flipped"

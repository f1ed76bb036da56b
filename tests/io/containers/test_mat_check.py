"""What a MATLAB 5 file states of itself is checked before SciPy takes memory for it."""

from __future__ import annotations

import io
import struct
import time
import zlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import loadmat, savemat

from erdctl.core.errors import InputProblem
from erdctl.io.containers.mat_check import Damaged, check

HEAD = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"


def saved(variables: dict[str, Any], *, compressed: bool = False) -> bytes:
    stream = io.BytesIO()
    savemat(stream, variables, do_compression=compressed)
    return stream.getvalue()


def checked(data: bytes) -> bool:
    return check(io.BytesIO(data), len(data), "log.mat")


def element(kind: int, data: bytes) -> bytes:
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def matrix(kind: int, dims: tuple[int, ...], name: str, content: bytes) -> bytes:
    return element(
        14,
        element(6, struct.pack("<II", kind, 0))
        + element(5, struct.pack(f"<{len(dims)}i", *dims))
        + element(1, name.encode())
        + content,
    )


VALUES = st.recursive(
    st.one_of(
        st.integers(0, 40).map(lambda n: np.arange(n, dtype=np.float64)),
        st.sampled_from([np.int8, np.uint16, np.float32]).map(lambda d: np.arange(9, dtype=d)),
        st.text("abcä", max_size=9),
        st.just(np.arange(6.0).reshape(2, 3) + 1j),
        st.just(np.array([True, False])),
    ),
    lambda inner: st.one_of(
        st.dictionaries(st.sampled_from(["a", "bc", "t", "force"]), inner, min_size=1, max_size=3),
        st.lists(inner, min_size=1, max_size=3).map(lambda v: _cells(v)),
    ),
    max_leaves=8,
)


def _cells(values: list[Any]) -> Any:
    out = np.empty(len(values), object)
    for i, value in enumerate(values):
        out[i] = value
    return out


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(st.sampled_from(["x", "y1", "records"]), VALUES, min_size=1), st.booleans())
def test_sound_files_pass(variables: dict[str, Any], compressed: bool) -> None:
    data = saved(variables, compressed=compressed)
    assert checked(data) is False
    loadmat(io.BytesIO(data))


@pytest.mark.parametrize(
    "variable",
    [
        matrix(6, (1_200_000_000, 1), "x", element(9, bytes(8))),
        matrix(6, (2_000_000_000, 2_000_000_000), "x", element(9, bytes(8))),
        matrix(6, (-1, 1), "x", element(9, bytes(8))),
        matrix(4, (2_000_000_000, 1), "x", element(4, b"")),
        matrix(1, (2_000_000_000, 1), "x", b""),
        matrix(2, (2_000_000_000, 1), "x", element(5, struct.pack("<i", 2)) + element(1, b"a\0")),
        matrix(6, (1, 1), "x", struct.pack("<II", 9, 0xFFFFFFF8)),
        struct.pack("<II", 14, 0xFFFFFFF0) + bytes(16),
        struct.pack("<II", 15, 12) + zlib.compress(struct.pack("<II", 14, 1 << 31))[:12],
    ],
    ids=["doubles", "product", "negative", "letters", "cells", "structs", "data", "whole", "cut"],
)
def test_claims(variable: bytes) -> None:
    with pytest.raises((Damaged, InputProblem, zlib.error)):
        checked(HEAD + variable)


def test_zeros_deflated() -> None:
    zeros = saved({n: np.zeros(1 << 22) for n in "abcdefghijklmnopqrstuv"}, compressed=True)
    with pytest.raises(InputProblem, match="no measured log is more than 200 times its file"):
        checked(zeros)


def test_cells_within_cells() -> None:
    inner = matrix(6, (1, 1), "", element(9, bytes(8)))
    for _ in range(5000):
        inner = matrix(1, (1, 1), "", inner)
    with pytest.raises(Damaged, match="deep"):
        checked(HEAD + inner)


def test_ten_million_cells_are_refused_at_once() -> None:
    body = matrix(1, (10_000_000, 1), "c", b"")[8:] + element(14, b"") * 10_000_000
    begin = time.perf_counter()
    with pytest.raises(Damaged, match="more than 1000000 cells"):
        checked(HEAD + struct.pack("<II", 14, len(body)) + body)
    assert time.perf_counter() - begin < 2.0


def test_any_length_made_huge() -> None:
    """No damage to a length makes the check run away, and what it passes SciPy can load."""
    sound = saved(
        {"x": np.arange(30.0), "s": {"a": "text", "b": np.arange(3)}, "c": _cells([1, 2])}
    )
    for at in range(128, len(sound) - 4, 4):
        for value in (0xFFFFFFFF, 0x7FFFFFFF, 1 << 24, 0):
            data = bytearray(sound)
            struct.pack_into("<I", data, at, value)
            try:
                strange = checked(bytes(data))
            except (Damaged, InputProblem, struct.error):
                continue
            if strange:  # is not read here
                continue
            try:
                loadmat(io.BytesIO(data))
            except MemoryError:
                raise
            except Exception:  # noqa: BLE001 - SciPy raises what it likes
                continue

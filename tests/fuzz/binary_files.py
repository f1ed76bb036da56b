"""Binary logs with seeded damage, and small files that claim to be enormous.

    cases(seed, count) -> iterator of (label, bytes, suffix)

The same seed gives the same cases. A sound log is written in every binary format, by the library
of the format or by hand, then its structure is damaged. The first cases of every run are the bombs:
files of a few kilobytes that open to gigabytes, which no random damage finds.
"""

from __future__ import annotations

import io
import struct
import tempfile
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pyarrow as pa

Case = tuple[str, bytes, str]

_ROWS = 400
_HUGE = (0x7FFFFFFF, 0xFFFFFFFF, 0x80000000, 0x7FFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF, 1 << 33)


def cases(seed: int, count: int) -> Iterator[Case]:
    """`count` damaged files; label says which format, which damage and where."""
    rng = np.random.default_rng(seed)
    bombs = list(BOMBS)
    names = list(BASES)
    for index in range(count):
        if index < len(bombs) and index < max(1, count // 2):
            yield f"bomb: {bombs[index]}", *bomb(bombs[index])
            continue
        name = names[int(rng.integers(len(names)))]
        data, suffix = sound(name)
        said = []
        for _ in range(1 if rng.random() < 0.8 else int(rng.integers(2, 5))):
            damage = DAMAGES[int(rng.integers(len(DAMAGES)))]
            data, what = damage(data, rng)
            said.append(what)
        yield f"{name} [{seed}/{index}]: {', '.join(said)}", data, suffix


@cache
def sound(name: str) -> tuple[bytes, str]:
    """The undamaged file of that name, and its suffix."""
    make, suffix = BASES[name]
    return make(), suffix


@cache
def bomb(name: str) -> tuple[bytes, str]:
    """The bomb of that name, and its suffix; some take a second to make."""
    make, suffix = BOMBS[name]
    return make(), suffix


# --- damage ---------------------------------------------------------------------------------


def _place(data: bytes, rng: np.random.Generator) -> int:
    """Half of all damage goes to the first and the last kilobyte, where structure is."""
    if not data:
        return 0
    kind = rng.random()
    if kind < 0.3:
        return int(rng.integers(min(len(data), 1024)))
    if kind < 0.5:
        return len(data) - 1 - int(rng.integers(min(len(data), 1024)))
    return int(rng.integers(len(data)))


def flipped(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """One to eight bits."""
    out = bytearray(data)
    places = [_place(data, rng) for _ in range(int(rng.integers(1, 9)))]
    for at in places if out else []:
        out[at] ^= 1 << int(rng.integers(8))
    return bytes(out), f"bits flipped at {places}"


def cut(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """The end is missing."""
    at = _place(data, rng)
    return data[:at], f"cut at {at}"


def _overwritten(byte: int) -> Callable[[bytes, np.random.Generator], tuple[bytes, str]]:
    def overwritten(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
        at, size = _place(data, rng), int(2 ** rng.uniform(0.0, 10.0))
        out = bytearray(data)
        size = min(size, len(out) - at)
        out[at : at + size] = bytes([byte]) * size
        return bytes(out), f"{size} bytes of {byte:#x} at {at}"

    return overwritten


def enlarged(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """A length, count or offset (a small whole number in the file) becomes another one."""
    width = int(rng.choice([2, 4, 8]))
    kind = {2: "<H", 4: "<I", 8: "<Q"}[width]
    for _ in range(200):
        at = _place(data, rng)
        at -= at % int(rng.choice([1, 2, 4]))
        if at + width > len(data):
            continue
        value = struct.unpack_from(kind, data, at)[0]
        if 0 < value <= 4 * len(data):
            new = [*_HUGE, value + 1, value - 1, value * 2, value * 1000, 0, len(data)]
            chosen = new[int(rng.integers(len(new)))] % (1 << 8 * width)
            out = bytearray(data)
            struct.pack_into(kind, out, at, chosen)
            return bytes(out), f"{value} made {chosen} at {at} ({width} bytes)"
    return data, "no length found"


def shifted(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """Bytes come out, or come in."""
    at, size = _place(data, rng), int(rng.integers(1, 64))
    if rng.random() < 0.5:
        return data[:at] + data[at + size :], f"{size} bytes out at {at}"
    return data[:at] + rng.bytes(size) + data[at:], f"{size} bytes in at {at}"


def crossed(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """A stretch is replaced by a copy of another one of the same file."""
    size = int(2 ** rng.uniform(2.0, 9.0))
    at, start = _place(data, rng), _place(data, rng)
    piece = data[start : start + size]
    return data[:at] + piece + data[at + len(piece) :], f"{size} bytes of {start} at {at}"


DAMAGES = (
    flipped, cut, _overwritten(0x00), _overwritten(0xFF), enlarged, enlarged, enlarged, shifted,
    crossed,
)  # fmt: skip


# --- sound files ----------------------------------------------------------------------------


def _columns() -> dict[str, np.ndarray]:
    t = np.arange(_ROWS) * 1e-3
    x = 0.01 * np.sin(40.0 * t)
    return {
        "t": t,
        "x": x,
        "xdot": 0.4 * np.cos(40.0 * t),
        "duty": np.repeat([0.1, 0.3], _ROWS // 2),
        "force": 100.0 * np.cos(40.0 * t),
    }


def _table() -> pa.Table:
    record = pa.array(["a"] * (_ROWS // 2) + ["b"] * (_ROWS // 2))
    return pa.table({**_columns(), "record": record})


def _arrow(kind: str, compression: str | None, *, coded: bool = False) -> bytes:
    table, stream = _table(), io.BytesIO()
    if coded:
        table = table.set_column(5, "record", table["record"].dictionary_encode())
        table = table.append_column("note", pa.array([None, "ä"] * (_ROWS // 2)))
    options = pa.ipc.IpcWriteOptions(compression=compression)
    new = pa.ipc.new_file if kind == "file" else pa.ipc.new_stream
    with new(stream, table.schema, options=options) as writer:
        writer.write_table(table, max_chunksize=150)
    return stream.getvalue()


def _parquet(compression: str, *, dictionary: bool, version: str = "1.0") -> bytes:
    import pyarrow.parquet as pq

    stream = io.BytesIO()
    pq.write_table(
        _table(),
        stream,
        compression=compression,
        use_dictionary=dictionary,
        data_page_version=version,
        row_group_size=150,
    )
    return stream.getvalue()


def _mat5(*, compressed: bool) -> bytes:
    from scipy.io import savemat

    stream = io.BytesIO()
    savemat(stream, {**_columns(), "units": {"x": "m", "force": "N"}}, do_compression=compressed)
    return stream.getvalue()


def _mat5_records() -> bytes:
    from erdctl.io.formats import Format
    from erdctl.io.tables import container

    return bytes(container(_table(), Format.MAT))


def _mat73() -> bytes:
    from matio import save_to_mat

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.mat"
        save_to_mat(str(path), {k: v.reshape(-1, 1) for k, v in _columns().items()}, version="v7.3")
        return path.read_bytes()


def _hdf5(*, chunked: bool, version: str = "earliest") -> bytes:
    import h5py

    stream = io.BytesIO()
    with h5py.File(stream, "w", libver=(version, "latest")) as file:
        for record in ("run1", "run2"):
            group = file.create_group(record)
            for name, values in _columns().items():
                how = {"chunks": (64,), "compression": "gzip"} if chunked else {}
                made = group.create_dataset(name, data=values, **how)
                made.attrs["units"] = {"x": "m", "force": "N"}.get(name, "")
    return stream.getvalue()


def _mdf(version: str) -> bytes:
    from asammdf import MDF, Signal

    columns = _columns()
    t = columns.pop("t")
    file = MDF(version=version)
    signals = [Signal(samples=v, timestamps=t, name=n, unit="") for n, v in columns.items()]
    counts = (1000.0 * columns["x"]).astype(np.int16)
    linear = {"a": 1e-3, "b": 0.0}
    formula = {"formula": "X1 * 0.001 + 1"}
    table = {"raw_0": -10.0, "raw_1": 10.0, "phys_0": -1.0, "phys_1": 1.0}
    for name, conversion in (("p", linear), ("q", formula), ("r", table)):
        signals.append(
            Signal(samples=counts, timestamps=t, name=name, unit="bar", conversion=conversion)
        )
    file.append(signals, acq_name="bench", common_timebase=True)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / ("log.mf4" if version > "4" else "log.mdf")
        file.save(path)
        file.close()
        return path.read_bytes()


def _tdms() -> bytes:
    from nptdms import ChannelObject, TdmsWriter

    stream = io.BytesIO()
    columns = _columns()
    step = {"wf_increment": 1e-3, "wf_start_offset": 0.0}
    with TdmsWriter(stream) as writer:
        for half in (slice(0, _ROWS // 2), slice(_ROWS // 2, None)):
            writer.write_segment(
                [
                    ChannelObject("log", n, v[half], {"unit_string": "", **step})
                    for n, v in columns.items()
                    if n != "t"
                ]
            )
    return stream.getvalue()


BASES: dict[str, tuple[Callable[[], bytes], str]] = {
    "feather": (lambda: _arrow("file", None), ".feather"),
    "feather lz4": (lambda: _arrow("file", "lz4"), ".feather"),
    "feather with codes": (lambda: _arrow("file", None, coded=True), ".feather"),
    "arrow stream": (lambda: _arrow("stream", None), ".arrow"),
    "arrow stream zstd": (lambda: _arrow("stream", "zstd", coded=True), ".arrow"),
    "parquet": (lambda: _parquet("snappy", dictionary=True), ".parquet"),
    "parquet plain": (lambda: _parquet("none", dictionary=False), ".parquet"),
    "parquet pages v2": (lambda: _parquet("zstd", dictionary=True, version="2.0"), ".parquet"),
    "mat 5": (lambda: _mat5(compressed=False), ".mat"),
    "mat 5 compressed": (lambda: _mat5(compressed=True), ".mat"),
    "mat 5 of erdctl": (_mat5_records, ".mat"),
    "mat 7.3": (_mat73, ".mat"),
    "hdf5": (lambda: _hdf5(chunked=False), ".h5"),
    "hdf5 chunked": (lambda: _hdf5(chunked=True), ".h5"),
    "hdf5 latest": (lambda: _hdf5(chunked=True, version="latest"), ".h5"),
    "mdf 4": (lambda: _mdf("4.10"), ".mf4"),
    "mdf 3": (lambda: _mdf("3.30"), ".mdf"),
    "tdms": (_tdms, ".tdms"),
}


# --- bombs ----------------------------------------------------------------------------------


def _arrow_bomb(kind: str) -> bytes:
    """Constant columns, compressed: zstd makes 16 kB of 128 MB, and a batch may come often."""
    rows, batches = 1 << 20, 40
    zeros = pa.array(np.zeros(rows))
    schema = pa.schema([(name, pa.float64()) for name in _columns()])
    batch = pa.record_batch([zeros] * 5, schema=schema)
    stream = io.BytesIO()
    options = pa.ipc.IpcWriteOptions(compression="zstd")
    new = pa.ipc.new_file if kind == "file" else pa.ipc.new_stream
    with new(stream, schema, options=options) as writer:
        for _ in range(batches):
            writer.write_batch(batch)
    return stream.getvalue()


def _parquet_bomb() -> bytes:
    """Runs of one value: a dictionary page with one entry, and indices of no bits."""
    import pyarrow.parquet as pq

    rows, groups = 1 << 21, 24
    table = pa.table({name: np.zeros(rows) for name in _columns()})
    stream = io.BytesIO()
    with pq.ParquetWriter(stream, table.schema, compression="zstd") as writer:
        for _ in range(groups):
            writer.write_table(table, row_group_size=rows)
    return stream.getvalue()


def _text_bomb() -> bytes:
    """A dictionary of one text of 1 MB, said 200,000 times."""
    import pyarrow.parquet as pq

    rows = 20_000
    columns: dict[str, object] = {name: np.zeros(rows) for name in _columns()}
    columns["t"] = np.arange(rows) * 1e-3
    columns["record"] = pa.DictionaryArray.from_arrays(
        pa.array(np.zeros(rows, np.int32)), pa.array(["r" * (1 << 20)])
    )
    stream = io.BytesIO()
    pq.write_table(pa.table(columns), stream, compression="zstd")
    return stream.getvalue()


def _mat_claim() -> bytes:
    """Matrices of 1.2e9 doubles, of which nothing is there: their heads alone say so."""
    out = _mat_head()
    for name in _columns():
        front = bytearray(_matrix(6, (1_200_000_000, 1), name, 8))
        out += bytes(front) + struct.pack("<II", 9, 0xFFFFFFF8)
    return out


def _mat_head() -> bytes:
    return b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"


def _deflated(front: bytes, piece: bytes, times: int) -> bytes:
    """A MAT element of `front` and so many pieces, deflated without the work of deflating them."""
    packer = zlib.compressobj(6)
    head = packer.compress(front) + packer.flush(zlib.Z_FULL_FLUSH)
    once = packer.compress(piece) + packer.flush(zlib.Z_FULL_FLUSH)
    again = packer.compress(piece) + packer.flush(zlib.Z_FULL_FLUSH)
    end = zlib.compressobj(6, zlib.DEFLATED, -15).flush()
    check = zlib.adler32(front)
    for _ in range(times):
        check = zlib.adler32(piece, check)
    packed = head + once + again * (times - 1) + end + struct.pack(">I", check)
    return struct.pack("<II", 15, len(packed)) + packed


def _matrix(kind: int, dims: tuple[int, int], name: str, data: int) -> bytes:
    """The front of a matrix element, up to its data; data : their length."""
    body = struct.pack("<IIII", 6, 8, kind, 0) + struct.pack("<IIii", 5, 8, *dims)
    body += struct.pack("<II", 1, len(name)) + name.encode().ljust((len(name) + 7) // 8 * 8, b"\0")
    return struct.pack("<II", 14, len(body) + data) + body


def _mat_bomb() -> bytes:
    """zlib makes a thousandth of zeros: 1.3 GB of matrices in 1.3 MB."""
    zeros, times = bytes(1 << 20), 256
    size = len(zeros) * times
    return _mat_head() + b"".join(
        _deflated(
            _matrix(6, (size // 8, 1), name, size + 8) + struct.pack("<II", 9, size), zeros, times
        )
        for name in _columns()
    )


def _mat_cells() -> bytes:
    """A cell array of 10 million empty cells: nothing in the file, objects in memory."""
    empty = struct.pack("<II", 14, 48) + struct.pack("<IIII", 6, 8, 6, 0)
    empty += struct.pack("<IIii", 5, 8, 0, 0) + struct.pack("<II", 1, 0) + struct.pack("<II", 9, 0)
    some, times = 10_000, 1_000
    front = _matrix(1, (some * times, 1), "c", len(empty) * some * times)
    return _mat_head() + _deflated(front, empty * some, times)


def _hdf5_bomb(kind: str) -> bytes:
    """Datasets of 1e9 values that are not there: filled, deflated, or virtual."""
    import h5py

    stream = io.BytesIO()
    with h5py.File(stream, "w", libver="latest") as file:
        for name in _columns():
            if kind == "filled":
                file.create_dataset(name, shape=(10**9,), dtype="f8", chunks=(1 << 20,))
            elif kind == "deflated":
                data = file.create_dataset(
                    name, shape=(1 << 28,), dtype="f8", chunks=(1 << 22,), compression="gzip"
                )
                data[:4] = 1.0
            else:
                layout = h5py.VirtualLayout(shape=(10**9,), dtype="f8")
                layout[:10] = h5py.VirtualSource("elsewhere.h5", "x", shape=(10,))
                file.create_virtual_dataset(name, layout)
    return stream.getvalue()


def _tdms_claim() -> bytes:
    """The first segment says that it holds 2^33 values of each channel."""
    data = bytearray(sound("tdms")[0])
    for at in range(28, len(data) - 8):
        if data[at : at + 8] == struct.pack("<Q", _ROWS // 2):
            struct.pack_into("<Q", data, at, 1 << 33)
    return bytes(data)


def _mdf_claim() -> bytes:
    """The channel group says that it has 2^33 samples."""
    data = sound("mdf 4")[0]
    at = data.find(b"##CG")
    cycles = data.find(struct.pack("<Q", _ROWS), at)
    out = bytearray(data)
    struct.pack_into("<Q", out, cycles, 1 << 33)
    return bytes(out)


def _mdf_formula(formula: str) -> Callable[[], bytes]:
    """A conversion by formula that takes its time, or the interpreter with it."""

    def make() -> bytes:
        from asammdf import MDF, Signal

        columns = _columns()
        t = columns.pop("t")
        file = MDF(version="4.10")
        counts = columns.pop("force").astype(np.int16)
        signals = [Signal(samples=v, timestamps=t, name=n, unit="") for n, v in columns.items()]
        mark = "X1" + "+0" * (len(formula) // 2)  # as long as the formula, and harmless
        scaled = {"formula": mark}
        signals.append(Signal(counts, t, name="force", unit="N", conversion=scaled))
        file.append(signals, common_timebase=True)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "log.mf4"
            file.save(path)
            file.close()
            data = path.read_bytes()
        assert mark.encode() in data
        return data.replace(mark.encode(), formula.ljust(len(mark)).encode())

    return make


BOMBS: dict[str, tuple[Callable[[], bytes], str]] = {
    "feather of constants": (lambda: _arrow_bomb("file"), ".feather"),
    "arrow stream of constants": (lambda: _arrow_bomb("stream"), ".arrow"),
    "parquet of constants": (_parquet_bomb, ".parquet"),
    "parquet with one long text": (_text_bomb, ".parquet"),
    "mat that claims": (_mat_claim, ".mat"),
    "mat deflated": (_mat_bomb, ".mat"),
    "mat of cells": (_mat_cells, ".mat"),
    "hdf5 filled": (lambda: _hdf5_bomb("filled"), ".h5"),
    "hdf5 deflated": (lambda: _hdf5_bomb("deflated"), ".h5"),
    "hdf5 virtual": (lambda: _hdf5_bomb("virtual"), ".h5"),
    "tdms that claims": (_tdms_claim, ".tdms"),
    "mdf that claims": (_mdf_claim, ".mf4"),
    "mdf formula power": (_mdf_formula("X1*9**9**9**9**9"), ".mf4"),
    "mdf formula deep": (_mdf_formula("(" * 3000 + "X1" + ")" * 3000), ".mf4"),
    "mdf formula code": (_mdf_formula("__import__('os').system('true')"), ".mf4"),
    "mdf formula long": (_mdf_formula("X1" + "+X1" * 30000), ".mf4"),
}

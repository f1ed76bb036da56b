"""Arrow files and streams in: what they state of themselves is checked before it is believed.

pyarrow hands out the buffers of a file as they are. One with a wrong offset, or an index beyond its
dictionary, makes the first function that uses it crash; one that is compressed opens to whatever
it says.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import Any

import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.core.memory import check_claim
from erdctl.io.formats import ARROW_END, ARROW_FILE, ARROW_STREAM
from erdctl.io.texts import check_texts

_RECORDS, _DICTIONARY = 3, 2  # kinds of a message's header
_MOST = 1 << 26  # bytes of the description of one batch; 100,000 columns need 10 MB


def described(file: Any, name: str, *, held: bool = True) -> tuple[pa.Schema, int]:
    """Schema and number of rows, as a file or stream states them; file : a NativeFile.

    held : whether all of it will be in memory at once

    Raises InputProblem if it opens to more than memory holds or a log can have.
    """
    size = file.size()
    schema = _reader(file).schema
    file.seek(0)
    rows = decoded = largest = 0
    for one, opened in _messages(file, size):
        rows, decoded, largest = rows + one, decoded + opened, max(largest, opened)
    file.seek(0)
    check_claim(decoded, size, name, "its batches", copies=1, held=held)
    if not held:
        check_claim(largest, size, name, "the columns of its largest batch")
    return schema, rows


def read(file: Any, size: int, columns: Sequence[str], names: Sequence[str], name: str) -> pa.Table:
    """The columns `names` of those that it has; sound, whatever the file said.

    Raises InputProblem if it was cut off, or its text opens to more than a log can have.
    """
    reader = _reader(file, [columns.index(n) for n in names])
    table = reader.read_all()
    if isinstance(reader, pa.RecordBatchStreamReader):
        _refuse_cut(file, name)
    # Before anything else: selecting does not look into the buffers, whatever computes does.
    table.validate(full=True)
    table = table.select(list(names))
    check_texts(table, size, name)
    return table


def batches(
    file: Any, size: int, columns: Sequence[str], names: Sequence[str], name: str
) -> Iterator[pa.Table]:
    """The same, batch by batch as it was written."""
    reader = _reader(file, [columns.index(n) for n in names])
    if isinstance(reader, pa.RecordBatchStreamReader):
        for batch in reader:
            yield _sound(batch, size, names, name)
        _refuse_cut(file, name)
    else:
        for i in range(reader.num_record_batches):
            yield _sound(reader.get_batch(i), size, names, name)


def _sound(batch: pa.RecordBatch, size: int, names: Sequence[str], name: str) -> pa.Table:
    batch.validate(full=True)
    table = pa.Table.from_batches([batch]).select(list(names))
    check_texts(table, size, name)
    return table


def _refuse_cut(file: Any, name: str) -> None:
    """Raise InputProblem for a stream, read to its end, without the mark that says so."""
    file.seek(file.tell() - len(ARROW_END))
    if file.read(len(ARROW_END)) != ARROW_END:
        raise InputProblem(
            "the Arrow stream stops without its end mark: its writer was cut off", file=name
        )


def _reader(file: Any, columns: Sequence[int] | None = None) -> Any:
    options = pa.ipc.IpcReadOptions(included_fields=None if columns is None else list(columns))
    head = file.read(len(ARROW_FILE))
    file.seek(0)
    opened = pa.ipc.open_file if head == ARROW_FILE else pa.ipc.open_stream
    return opened(file, options=options)


def _messages(file: Any, size: int) -> Iterator[tuple[int, int]]:
    """Rows and decoded bytes of each batch. What is wrong is left to pyarrow to say."""
    head = file.read(len(ARROW_FILE))
    places = _blocks(file, size) if head == ARROW_FILE else None
    if places is None:
        at = 0
        while at < size:
            found = _message(file, at, size)
            if found is None:
                return
            rows, decoded, at = found
            yield rows, decoded
        return
    for at in places:
        found = _message(file, at, size)
        if found is not None:
            yield found[:2]


def _blocks(file: Any, size: int) -> Sequence[int]:
    """Where the batches of a file are, by its footer."""
    file.seek(max(size - 10, 0))
    (length,) = struct.unpack("<i", file.read(10)[:4])
    if not 0 < length <= min(size - 10, _MOST):
        return []
    file.seek(size - 10 - length)
    footer = _Table.root(file.read(length))
    out: list[int] = []
    for field in (2, 3):  # dictionaries, record batches
        start, count = footer.vector(field, 24)
        out += [struct.unpack_from("<q", footer.data, start + 24 * i)[0] for i in range(count)]
    return [at for at in out if 0 <= at < size]


def _message(file: Any, at: int, size: int) -> tuple[int, int, int] | None:
    """Rows and decoded bytes of the message at a place, and where the next one is."""
    file.seek(at)
    mark = file.read(8)
    if len(mark) < 8:
        return None
    if mark[:4] == ARROW_STREAM:
        (length,), start = struct.unpack("<i", mark[4:]), at + 8
    else:  # before Arrow 0.15 there was no mark
        (length,), start = struct.unpack("<i", mark[:4]), at + 4
    if not 0 < length <= min(size - start, _MOST):
        return None
    file.seek(start)
    message = _Table.root(file.read(length))
    body = message.number(3, "<q")
    after = start + length + body
    if body < 0 or after > size:
        return None
    kind = message.number(1, "<B")
    if kind not in (_RECORDS, _DICTIONARY):
        return 0, 0, after
    batch = message.table(2)
    if kind == _DICTIONARY:
        batch = batch.table(1)
    first, count = batch.vector(2, 16)
    held = 0
    for i in range(count):
        offset, stored = struct.unpack_from("<qq", batch.data, first + 16 * i)
        if stored >= 8 and batch.has(3) and 0 <= offset <= body - 8:
            file.seek(start + length + offset)
            stored = max(struct.unpack("<q", file.read(8))[0], stored)
        held += max(stored, 0)
    rows = max(batch.number(0, "<q"), 0)
    return (rows if kind == _RECORDS else 0), held, after


class _Table:
    """A table of a flat buffer, as far as it is needed; everything it says is checked."""

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at = data, at
        self.fields = at - self._get("<i", at)

    @classmethod
    def root(cls, data: bytes) -> _Table:
        return cls(data, cls._of(data, "<I", 0))

    @staticmethod
    def _of(data: bytes, kind: str, at: int) -> int:
        if not 0 <= at <= len(data) - struct.calcsize(kind):
            raise pa.ArrowInvalid("an offset in the description of a batch points outside of it")
        value: int = struct.unpack_from(kind, data, at)[0]
        return value

    def _get(self, kind: str, at: int) -> int:
        return self._of(self.data, kind, at)

    def _field(self, index: int) -> int | None:
        entry = 4 + 2 * index
        if entry + 2 > self._get("<H", self.fields):
            return None
        offset = self._get("<H", self.fields + entry)
        return self.at + offset if offset else None

    def has(self, index: int) -> bool:
        return self._field(index) is not None

    def number(self, index: int, kind: str) -> int:
        at = self._field(index)
        return 0 if at is None else self._get(kind, at)

    def table(self, index: int) -> _Table:
        at = self._field(index)
        if at is None:
            raise pa.ArrowInvalid("the description of a batch is incomplete")
        return _Table(self.data, at + self._get("<I", at))

    def vector(self, index: int, width: int) -> tuple[int, int]:
        """Where its elements begin, and how many there are."""
        at = self._field(index)
        if at is None:
            return 0, 0
        start = at + self._get("<I", at)
        count = self._get("<I", start)
        if start + 4 + width * count > len(self.data):
            raise pa.ArrowInvalid("a list in the description of a batch is longer than it")
        return start + 4, count

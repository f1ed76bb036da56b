"""MATLAB 5 files walked through before they are loaded: no length is believed that cannot be true.

The library takes the memory that a head states before it looks for the data, opens whatever was
deflated, and follows cells in cells until the stack ends. Here every element has to lie in the one
around it, and what all of them need in memory is summed up.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Callable
from typing import BinaryIO

from erdctl.core.memory import check_claim

HEAD = 128  # bytes before the first element
_MATRIX, _DEFLATED = 14, 15
_CELL, _STRUCT, _OBJECT, _CHAR, _SPARSE, _FUNCTION, _OPAQUE = 1, 2, 3, 4, 5, 16, 17
_ITEM = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8, 16: 1, 17: 2, 18: 4}
_DEEPEST = 50  # structs and cells within one another
_OBJECT_BYTES = 200  # of an array of Python, with nothing in it
_MOST_DIMENSIONS = 32
_MOST_ELEMENTS = 1_000_000
_RATIO = 1040  # deflate does not do more
_CHUNK = 1 << 16


Grant = Callable[[int], None]


class Damaged(Exception):
    """What the file says of itself cannot be true."""


def check(file: BinaryIO, size: int, name: str) -> bool:
    """Whether the file holds objects, handles of functions or sparse matrices.

    Of those SciPy believes what they state, or cannot read them at all.

    file : at its beginning, of `size` bytes
    Raises InputProblem if it opens to more than memory holds or a log can have, Damaged.
    """
    head = file.read(HEAD)
    if len(head) < HEAD or head[126:] not in (b"IM", b"MI"):
        raise Damaged("it has no head")
    order = "<" if head[126:] == b"IM" else ">"
    at, total, strange = HEAD, 0, False

    def grant(more: int) -> None:
        check_claim(total + more, size, name, "its variables")

    while at + 8 <= size:
        file.seek(at)
        kind, length = struct.unpack(f"{order}II", file.read(8))
        at += 8
        if length > size - at:
            raise Damaged(f"a variable of {length} bytes, where {size - at} are left")
        if kind == _DEFLATED:
            packed = _Inflated(file, length)
            kind, inner = struct.unpack(f"{order}II", packed.read(8))
            walk = _Walk(packed, order, grant)
            if inner > _RATIO * max(length, 64):
                raise Damaged(f"{length} bytes that are to open to {inner}")
        else:
            inner, walk = length, _Walk(_Plain(file), order, grant)
        if kind != _MATRIX:
            raise Damaged(f"an element of type {kind} in place of a variable")
        total += walk.matrix(inner, 0, outermost=True)
        grant(0)
        strange |= walk.strange
        at += length if walk.source.packed else -(-length // 8) * 8
    return strange


class _Plain:
    """Bytes of a file, one after the other."""

    packed = False

    def __init__(self, file: BinaryIO) -> None:
        self.file, self.at = file, 0

    def read(self, count: int) -> bytes:
        found = self.file.read(count)
        if len(found) < count:
            raise Damaged("it ends in the middle of a variable")
        self.at += count
        return found

    def skip(self, count: int) -> None:
        if count < 0:
            raise Damaged("an element ends before what it holds")
        self.file.seek(count, 1)
        self.at += count


class _Inflated:
    """Deflated bytes of a file, no more of them opened at a time than are asked for."""

    packed = True

    def __init__(self, file: BinaryIO, length: int) -> None:
        self.file, self.left, self.at = file, length, 0
        self.unpacker, self.held, self.first = zlib.decompressobj(), b"", 0

    def _more(self, most: int) -> bytes:
        while True:
            given = self.unpacker.unconsumed_tail
            if not given:
                given = self.file.read(min(_CHUNK, self.left))
                self.left -= len(given)
            found = self.unpacker.decompress(given, most)
            if found:
                return found
            if not given or self.unpacker.eof:
                raise Damaged("it ends in the middle of a variable")

    def read(self, count: int) -> bytes:
        while len(self.held) - self.first < count:
            self.held, self.first = self.held[self.first :] + self._more(_CHUNK), 0
        found = self.held[self.first : self.first + count]
        self.first += count
        self.at += count
        return found

    def skip(self, count: int) -> None:
        if count < 0:
            raise Damaged("an element ends before what it holds")
        self.at += count
        here = min(count, len(self.held) - self.first)
        self.first += here
        count -= here
        while count > 0:
            count -= len(self._more(min(count, 1 << 20)))


class _Walk:
    """Through one variable.

    strange : whether it is more than numbers and text;  grant : is asked for memory
    """

    def __init__(self, source: _Plain | _Inflated, order: str, grant: Grant) -> None:
        self.source, self.order, self.grant = source, order, grant
        self.strange, self.walked = False, 0

    def tag(self, end: int) -> tuple[int, int, bytes | None]:
        """Type, length, and the data where they stand in the tag itself."""
        if self.source.at + 8 > end:
            raise Damaged("an element ends before what it holds")
        data = self.source.read(8)
        first, second = struct.unpack(f"{self.order}II", data)
        if first >> 16:
            if first >> 16 > 4:
                raise Damaged(f"a short element of {first >> 16} bytes")
            return first & 0xFFFF, first >> 16, data[4 : 4 + (first >> 16)]
        if second > end - self.source.at:
            raise Damaged(f"an element of {second} bytes, where {end - self.source.at} are left")
        return first, second, None

    def small(self, end: int, most: int) -> bytes:
        """The data of an element that cannot be long."""
        _, length, data = self.tag(end)
        if data is not None:
            return data
        if length > most:
            raise Damaged(f"{length} bytes of what has at most {most}")
        found = self.source.read(length)
        self.source.skip(min(-length % 8, end - self.source.at))
        return found

    def matrix(self, length: int, depth: int, *, outermost: bool = False) -> int:
        """Bytes that a matrix element of `length` bytes takes in memory."""
        if depth > _DEEPEST:
            raise Damaged(f"structs and cells more than {_DEEPEST} deep")
        if not length:
            return _OBJECT_BYTES
        end = self.source.at + length
        flags = self.small(end, 8)
        if len(flags) < 8:
            raise Damaged("a variable without its flags")
        (first,) = struct.unpack(f"{self.order}I", flags[:4])
        kind, complex_ = first & 0xFF, bool(first & 0x800)
        if kind == _OPAQUE:
            self.strange = True
            self.finish(end, outermost)
            return 8 * length
        shape = self.small(end, 4 * _MOST_DIMENSIONS)
        dims = struct.unpack(f"{self.order}{len(shape) // 4}i", shape[: len(shape) // 4 * 4])
        if not dims or min(dims) < 0:
            raise Damaged(f"a variable of {' x '.join(map(str, dims)) or 'no'} values")
        count = math.prod(dims)
        self.small(end, 1 << 12)  # its name
        taken = _OBJECT_BYTES + self.content(kind, count, end, depth, complex_=complex_)
        self.finish(end, outermost)
        return taken

    def finish(self, end: int, outermost: bool) -> None:
        """Go to the end of an element; behind the outermost there is nothing to go to."""
        if not outermost:
            self.source.skip(end - self.source.at)

    def content(self, kind: int, count: int, end: int, depth: int, *, complex_: bool) -> int:
        left = end - self.source.at
        self.strange |= kind in (_OBJECT, _FUNCTION, _SPARSE)
        if kind in (_STRUCT, _OBJECT):
            if kind == _OBJECT:
                self.small(end, 1 << 12)  # its class
            width = int.from_bytes(self.small(end, 4), "little" if self.order == "<" else "big")
            names = self.small(end, 1 << 22)
            if not 0 < width <= 1 << 10 or len(names) % width:
                raise Damaged(f"{len(names)} bytes of names of {width} each")
            count *= len(names) // width
            return self.elements(count, end, depth)
        if kind == _CELL:
            return self.elements(count, end, depth)
        if kind in (_FUNCTION, _SPARSE):
            return 4 * left
        item, length, _ = self.tag(end)
        if kind > 15 or item not in _ITEM or (kind != _CHAR and length // _ITEM[item] != count):
            raise Damaged(f"{count} values, of which {length} bytes of type {item} are stored")
        if kind == _CHAR and count > max(length, 1 << 12):
            raise Damaged(f"{count} letters, of which {length} bytes are stored")
        return count * (16 if complex_ else 8)

    def elements(self, count: int, end: int, depth: int) -> int:
        if 8 * count > end - self.source.at:
            raise Damaged(f"{count} elements in {end - self.source.at} bytes")
        self.walked += count
        if self.walked > _MOST_ELEMENTS:
            raise Damaged(f"more than {_MOST_ELEMENTS} cells and fields; save vectors of numbers")
        self.grant(count * _OBJECT_BYTES)
        taken = 8 * count
        for _ in range(count):
            kind, length, data = self.tag(end)
            if kind != _MATRIX or data is not None:
                raise Damaged(f"an element of type {kind} in place of a value")
            taken += self.matrix(length, depth + 1)
        return taken

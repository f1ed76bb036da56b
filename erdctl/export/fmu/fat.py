"""One file for Macs of either kind, of a file for each."""

from __future__ import annotations

import struct
from collections.abc import Sequence

_MAGIC = 0xCAFEBABE
_ALIGN = 14  # power of two at which a part begins: pages of 16 KiB


def universal(parts: Sequence[bytes]) -> bytes:
    """A universal binary of several Mach-O files of 64 bits.

    Header and one row per part (kind of processor, where it begins, how long it is), big-endian;
    then the parts, as they are. Source: Apple, <mach-o/fat.h>.
    """
    if len(parts) == 1:
        return parts[0]
    head = struct.pack(">II", _MAGIC, len(parts))
    at = 8 + 20 * len(parts)
    body = b""
    for part in parts:
        begin = -(-(at + len(body)) // (1 << _ALIGN)) << _ALIGN
        # Of a Mach-O file: its own magic number, then the two numbers of the processor.
        processor, model = struct.unpack_from("<II", part, 4)
        head += struct.pack(">IIIII", processor, model, begin, len(part), _ALIGN)
        body += bytes(begin - at - len(body)) + part
    return head + body

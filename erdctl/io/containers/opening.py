"""A container of any format, opened: its channels as one table, samples still unread."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from typing import TypeVar

from erdctl.core.errors import ErdctlError, InputProblem
from erdctl.core.memory import available, check_claim
from erdctl.io.containers.channels import Layout, arrange
from erdctl.io.formats import HDF5, HDF5_AT, Format

T = TypeVar("T")


def open_container(data: str | bytearray, format: Format, name: str) -> Layout:
    """The channels of a file, or of the bytes of one.

    name : for messages
    Raises InputProblem if it is damaged or too large, ComputationProblem if the library that reads
    it is missing.
    """
    size = os.path.getsize(data) if isinstance(data, str) else len(data)
    have = available()
    if have is not None and size > have:
        raise InputProblem(
            f"too large: {size / 1e9:.3g} GB, read whole, and {have / 1e9:.3g} GB of memory are"
            " free; split it, or export the channels that you need",
            file=name,
        )
    if format is Format.MDF:
        from erdctl.io.containers.mdf import read
    elif format is Format.TDMS:
        from erdctl.io.containers.tdms import read
    elif format is Format.HDF5:
        from erdctl.io.containers.hdf5 import read
    else:
        from erdctl.io.containers.mat_in import read

    groups, notes = guarded(
        name, format, lambda: read(data if isinstance(data, str) else io.BytesIO(data), name)
    )
    return arrange(groups, name, notes)


def is_plain(data: str | bytearray, name: str) -> bool:
    """Whether a MAT file is of version 5 and holds no objects, so that SciPy alone reads it.

    Raises InputProblem if it is damaged, or opens to more than memory holds or a log can have.
    """
    from erdctl.io.containers import mat_check

    file = open(data, "rb") if isinstance(data, str) else io.BytesIO(data)  # noqa: SIM115  # closed by the next line
    with file:
        head = file.read(HDF5_AT + len(HDF5))
        if HDF5 in (head[: len(HDF5)], head[HDF5_AT:]):
            return False
        size = file.seek(0, os.SEEK_END)
        file.seek(0)
        return not guarded(name, Format.MAT, lambda: mat_check.check(file, size, name))


def check_samples(layout: Layout, wanted: Sequence[str], size: int, name: str) -> int:
    """Bytes of the wanted columns of a file of `size` bytes, as far as it states them.

    Raises InputProblem if they do not fit into memory, or nobody can have measured them.
    """
    chosen = [
        member.channel
        for _, members in layout.records
        for column, member in members.items()
        if column in wanted
    ]
    decoded = sum(8 * (c.count or 0) for c in chosen)
    if any(c.timed for c in chosen):
        decoded += 8 * max((c.count or 0) for c in chosen)
    check_claim(decoded, size, name, f"its {len(chosen)} channels")
    return decoded


def guarded(name: str, format: Format, read: Callable[[], T]) -> T:
    """What `read` returns; whatever a library says of a damaged file in one line."""
    try:
        return read()
    except (ErdctlError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001 - no library says what a damaged file makes it raise
        if isinstance(error.__cause__ or error.__context__, MemoryError):
            raise MemoryError from None  # which the library took for a damage
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        raise InputProblem(
            f"damaged, cut off or unusual {format.value} ({reason}); write or copy it again, or"
            " export it as CSV",
            file=name,
        ) from None

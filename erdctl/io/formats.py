"""Formats of tables, recognised by suffix and by content."""

from __future__ import annotations

import os
from enum import Enum

from erdctl.core.errors import InputProblem


class Format(Enum):
    """Formats of tables."""

    CSV = "csv"
    PARQUET = "parquet"
    ARROW = "arrow"
    MAT = "mat"
    HDF5 = "hdf5"
    MDF = "mdf"
    TDMS = "tdms"


# Files that hold channels with their own time bases and units, rather than one table.
CONTAINERS = (Format.MAT, Format.HDF5, Format.MDF, Format.TDMS)

SUFFIXES = {
    ".csv": Format.CSV,
    ".parquet": Format.PARQUET,
    ".pq": Format.PARQUET,
    ".arrow": Format.ARROW,
    ".arrows": Format.ARROW,
    ".ipc": Format.ARROW,
    ".feather": Format.ARROW,
    ".mat": Format.MAT,
    ".h5": Format.HDF5,
    ".hdf5": Format.HDF5,
    ".hdf": Format.HDF5,
    ".mf4": Format.MDF,
    ".mdf": Format.MDF,
    ".tdms": Format.TDMS,
}
ARROW_FILE = b"ARROW1"
ARROW_STREAM = b"\xff\xff\xff\xff"
# The last word of an Arrow stream; without it, its writer was cut off.
ARROW_END = ARROW_STREAM + bytes(4)
HDF5 = b"\x89HDF\r\n\x1a\n"
HDF5_AT = 512  # where it stands behind MATLAB's own head
_MAGIC = {
    b"PAR1": Format.PARQUET,
    ARROW_STREAM: Format.ARROW,
    ARROW_FILE: Format.ARROW,
    b"MATLAB": Format.MAT,
    HDF5: Format.HDF5,
    b"MDF ": Format.MDF,
    b"UnFinMF": Format.MDF,
    b"TDSm": Format.TDMS,
}
# What bench software also writes.
_FOREIGN = {
    b"\x1f\x8b": "compressed with gzip; use gzip -dc FILE | erdctl ... -",
    b"\x28\xb5\x2f\xfd": "compressed with zstd; use zstd -dc FILE | erdctl ... -",
    b"PK\x03\x04": "an Excel or zip file; export it as CSV",
    b"TDSh": "the index of a TDMS file; give the .tdms file itself",
    b"FEA1": "an old Feather file; write it anew as Parquet",
}


def by_suffix(path: str) -> Format | None:
    """Format that a file name promises, or None."""
    return SUFFIXES.get(os.path.splitext(path)[1].lower())


def by_content(head: bytes, path: str, name: str) -> Format:
    """Format of a table whose first bytes are given; what is nothing else is CSV.

    name : for messages
    Raises InputProblem if it is empty, of a format that is not read, or not what its suffix says.
    """
    if not head.strip():
        raise InputProblem("empty; expected a bench log", file=name)
    found = next((f for magic, f in _MAGIC.items() if head.startswith(magic)), None)
    if found is None:
        for magic, what in _FOREIGN.items():
            if head.startswith(magic):
                raise InputProblem(f"this is {what}", file=name)
    found = found or Format.CSV
    promised = by_suffix(path) or found
    if {promised, found} == {Format.MAT, Format.HDF5}:
        return found  # .mat of another program than MATLAB, or the other way round
    if promised is Format.MAT and found is Format.CSV and b"\0\0" in head[:4]:
        raise InputProblem(
            "this is MATLAB 4, which is not read; save it with -v7 from MATLAB", file=name
        )
    if promised is not found:
        raise InputProblem(
            f"not {promised.value}, though its name says so: it begins like {found.value}; if it is"
            f" sound, give it the suffix .{found.value}",
            file=name,
        )
    return found

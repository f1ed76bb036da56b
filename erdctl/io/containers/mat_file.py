"""Variables of a MAT file of any version as plain Python, whatever library read them.

v5 to v7 through scipy; v7.3 (HDF5), and MATLAB objects of any version, through mat-io.
"""

from __future__ import annotations

import io
import os
import warnings
from tempfile import NamedTemporaryFile
from typing import Any

import numpy as np

from erdctl.io.containers.hdf5_walk import check_sizes
from erdctl.io.extras import MissingLibrary, need
from erdctl.io.formats import HDF5, HDF5_AT

_UNREAD = {"MatlabOpaque", "MatlabFunction", "MatlabObject"}  # scipy's names for what it leaves

# dict: struct or object; list: struct array or cell array; str; (n,) or (n, m) array of numbers
Node = Any


def variables(file: str | io.BytesIO) -> tuple[dict[str, Node], list[str]]:
    """The variables, and remarks on those that could not be read.

    Raises MissingLibrary for a v7.3 file without mat-io.
    """
    with warnings.catch_warnings():
        # About names that MATLAB would not have given, and classes that stay unread.
        warnings.simplefilter("ignore")
        if _is_hdf5(file):
            return _through_mat_io(file, "MATLAB 7.3 files"), []
        from scipy.io import loadmat

        found = loadmat(file, mat_dtype=True)
        objects = [k for k, v in found.items() if type(v).__name__ in _UNREAD]
        if objects:
            try:
                return _through_mat_io(file, "MATLAB objects"), []
            except MissingLibrary as error:
                notes = [f"its MATLAB objects (timeseries, string, ...) are not read: {error}"]
                return _tidied({k: v for k, v in found.items() if k not in objects}), notes
    return _tidied(found), []


def _is_hdf5(file: str | io.BytesIO) -> bool:
    if isinstance(file, str):
        with open(file, "rb") as stream:
            return stream.read(HDF5_AT + len(HDF5)).endswith(HDF5)
    return file.getbuffer()[HDF5_AT : HDF5_AT + len(HDF5)] == HDF5


def _through_mat_io(file: str | io.BytesIO, purpose: str) -> dict[str, Node]:
    matio = need("matio", extra="mat73", purpose=purpose)
    if isinstance(file, str):
        return _loaded(matio, file)
    with NamedTemporaryFile(suffix=".mat") as copy:  # it reads files by name only
        copy.write(file.getbuffer())
        copy.flush()
        return _loaded(matio, copy.name)


def _loaded(matio: Any, path: str) -> dict[str, Node]:
    if _is_hdf5(path):
        import h5py

        with h5py.File(path, "r", locking=False) as opened:
            check_sizes(opened, os.path.getsize(path), path)
    return _tidied(matio.load_from_mat(path, add_table_attrs=True))


def _tidied(found: dict[str, Any]) -> dict[str, Node]:
    return {k: tidy(v) for k, v in found.items() if not k.startswith("__")}


def tidy(value: Any) -> Node:
    """A MATLAB value as both libraries give it, without their ways of nesting.

    Structs and objects become dicts, their arrays and cell arrays lists, char arrays str or lists
    of str, tables a dict of columns with their units; numbers lose dimensions of length 1.
    """
    if type(value).__name__ in _UNREAD and not hasattr(value, "properties"):
        return None
    if hasattr(value, "properties") and hasattr(value, "classname"):
        return tidy(value.properties)
    if isinstance(value, dict):
        return {str(k): tidy(v) for k, v in value.items()}
    if hasattr(value, "columns") and hasattr(value, "index"):
        return _table(value)
    if not isinstance(value, np.ndarray):
        return value
    if value.dtype.names:
        items = [{f: tidy(item[f]) for f in value.dtype.names} for item in value.flat]
        return items[0] if value.size == 1 else items
    if value.dtype.kind == "O":
        items = [tidy(item) for item in value.flat]
        is_object = value.size == 1 and hasattr(value.flat[0], "classname")
        return items[0] if is_object else items
    if value.dtype.kind in "UT":  # char arrays; string objects
        texts = [str(v) for v in value.flat]
        return texts[0] if len(texts) == 1 else texts or ""
    return np.squeeze(value)


def _table(frame: Any) -> dict[str, Node]:
    """A MATLAB table or timetable, which mat-io gives as a pandas DataFrame."""
    out = {str(name): _plain(frame[name]) for name in frame.columns}
    if frame.index.dtype.kind == "m":
        out = {"t": frame.index.to_numpy() / np.timedelta64(1, "ns") * 1e-9, **out}
    units = frame.attrs.get("VariableUnits") or frame.attrs.get("varUnits")
    if units and len(units) == len(frame.columns):
        out["units"] = dict(zip(map(str, frame.columns), map(str, units), strict=True))
    return out


def _plain(column: Any) -> Node:
    return [str(v) for v in column] if column.dtype.kind not in "iufb" else column.to_numpy()

"""HDF5 as other programs write it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow as pa
import pytest
from shapes import F, T, X

from erdctl.core.errors import InputProblem
from erdctl.io.containers.hdf5 import read as read_groups

Read = Callable[..., pa.Table]
MM, KN = {"unit": "mm"}, {"units": "kN"}


def put(group: Any, name: str, values: Any, about: dict[str, Any] | None = None) -> None:
    group.create_dataset(name, data=values).attrs.update(about or {})


def holds(table: pa.Table, times: int = 1) -> bool:
    return (
        np.allclose(table["t"], np.tile(T, times), atol=1e-12)
        and np.allclose(table["x"], np.tile(X, times), atol=1e-15)
        and np.allclose(table["force"], np.tile(F, times), rtol=1e-12)
    )


def runs(file: Any) -> int:
    """One group for each run, each with its time."""
    for run in ("cold", "warm"):
        group = file.create_group(f"runs/{run}")
        put(group, "Time", T * 1e3, {"unit": "ms"})
        put(group, "x", X * 1e3, MM)
        put(group, "force", F * 1e-3, KN)
    return 2


def around(file: Any) -> int:
    """The time in the group around that of the channels."""
    put(file, "time", T)
    put(file, "data/x", X.reshape(-1, 1))
    put(file, "data/force", F)
    return 1


def elsewhere(file: Any) -> int:
    """The only time of the file in a group of its own."""
    put(file, "base/t", T)
    put(file, "data/x", X)
    put(file, "data/force", F)
    return 1


def channel_groups(file: Any) -> int:
    """A group for each channel, with data and time."""
    for name, values, unit in (("x", X * 1e3, "mm"), ("force", F * 1e-3, "kN")):
        put(file, f"{name}/data", values)
        put(file, f"{name}/time", T)
        file[name].attrs["unit"] = unit
    return 1


def matrix(file: Any) -> int:
    columns = {"columns": ["t", "x", "force"], "units": ["s", "mm", "kN"]}
    put(file, "log", np.stack([T, X * 1e3, F * 1e-3], 1), columns)
    return 1


def transposed(file: Any) -> int:
    put(file, "log", np.stack([T, X, F]), {"names": "t, x, force"})
    return 1


def compound(file: Any) -> int:
    rows = np.zeros(1000, [("t", "f8"), ("x", "f8"), ("force", "f8"), ("x_n", "i4")])
    rows["t"], rows["x"], rows["force"] = T, X * 1e3, F
    put(file, "log", rows, {"x_unit": "mm"})
    return 1


def rate(file: Any) -> int:
    """No time, but a rate."""
    file.attrs["fs"] = 1000.0
    put(file, "x", X)
    put(file, "force", F)
    return 1


def counts(file: Any) -> int:
    """Whole numbers with a scale, deflated in chunks."""
    put(file, "t", T)
    put(file, "x", X)
    made = file.create_dataset(
        "force", data=np.round(F * 1e7).astype("i4"), chunks=(100,), compression="gzip"
    )
    made.attrs.update(scale_factor=1e-7, units="N")
    return -1


@pytest.mark.parametrize("suffix", ["h5", "hdf5", "mat"])
@pytest.mark.parametrize(
    "shape",
    [runs, around, elsewhere, channel_groups, matrix, transposed, compound, rate, counts],
    ids=lambda s: s.__name__,
)
def test_shapes(tmp_path: Path, converted: Read, shape: Callable[[Any], int], suffix: str) -> None:
    path = tmp_path / f"log.{suffix}"
    with h5py.File(path, "w") as file:
        times = shape(file)
    table = converted(path)
    if times < 0:
        assert np.allclose(table["force"], F, atol=1e-7)
        return
    assert holds(table, times)
    assert ("record" in table.column_names) == (times > 1)
    if times > 1:
        assert table["record"].unique().to_pylist() == ["cold", "warm"]


def test_from_a_pipe(tmp_path: Path, read: Any, stdin: Callable[[bytes], None]) -> None:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        runs(file)
    stdin(path.read_bytes())
    assert np.allclose(read("-").recording.force, np.tile(F, 2))


def test_what_is_not_in_the_file_stays_closed(
    tmp_path: Path, converted: Read, said: list[str]
) -> None:
    secret = tmp_path / "secret.bin"
    secret.write_bytes(F.tobytes())
    other = tmp_path / "other.h5"
    with h5py.File(other, "w") as file:
        put(file, "x", X)
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        around(file)
        file["linked"] = h5py.ExternalLink(str(other), "x")
        file["soft"] = h5py.SoftLink("/soft")
        file["again"] = file["/"]
        file.create_dataset("raw", (1000,), "f8", external=[(str(secret), 0, 8000)])
        layout = h5py.VirtualLayout((1000,), "f8")
        layout[:] = h5py.VirtualSource(str(other), "x", (1000,))
        file.create_virtual_dataset("virtual", layout)
    table = converted(path)
    assert holds(table)
    assert set(table.column_names) == {"t", "x", "force"}
    text = "\n".join(said)
    for name in ("linked", "soft", "again", "raw", "virtual"):
        assert f"'/{name}" in text


@pytest.mark.parametrize("how", [{}, {"chunks": (1 << 20,), "compression": "gzip"}])
def test_a_dataset_that_opens_to_gigabytes(
    tmp_path: Path, converted: Read, how: dict[str, Any]
) -> None:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name in ("t", "x", "force"):
            file.create_dataset(name, (10**9,), "f8", **how)
    with pytest.raises(InputProblem, match=r"open to 2[0-9.]* GB|too large"):
        converted(path)


def test_two_scales_are_refused(tmp_path: Path, converted: Read) -> None:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        put(file, "t", T)
        put(file, "force", F, {"scale": 2.0, "gain": 3.0})
    with pytest.raises(InputProblem, match="'force' has scale and gain; which of them"):
        converted(path)


def test_groups_within_groups_end(tmp_path: Path) -> None:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        group = file
        for _ in range(200):
            group = group.create_group("g")
    _, notes = read_groups(str(path), "log.h5")
    assert len(notes) == 1
    assert "too deep" in notes[0]

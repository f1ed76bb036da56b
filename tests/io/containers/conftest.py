"""Files as the formats' own libraries write them, and what erdctl reads from them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from erdctl.io.convert import read_converted


@pytest.fixture
def converted(said: list[str]) -> Callable[..., pa.Table]:
    def converted(path: Path, *maps: str) -> pa.Table:
        return read_converted(str(path), maps=maps, say=said.append)

    return converted


@pytest.fixture
def mdf(tmp_path: Path) -> Callable[..., Path]:
    """Write an MDF file: groups of (name, time, {channel: values, or keywords of a Signal})."""

    def mdf(groups: Sequence[tuple[str, Any, dict[str, Any]]], version: str = "4.10") -> Path:
        from asammdf import MDF, Signal

        file = MDF(version=version)
        for name, time, channels in groups:
            signals = [
                Signal(name=n, timestamps=time, **(c if isinstance(c, dict) else {"samples": c}))
                for n, c in channels.items()
            ]
            file.append(signals, acq_name=name, common_timebase=True)
        path = tmp_path / ("log.mf4" if version > "4" else "log.mdf")
        file.save(path)
        file.close()
        return path

    return mdf


@pytest.fixture
def tdms(tmp_path: Path) -> Callable[..., Path]:
    """Write a TDMS file: {group: {channel: values, or (values, properties)}}."""

    def tdms(groups: dict[str, dict[str, Any]]) -> Path:
        from nptdms import ChannelObject, TdmsWriter

        path = tmp_path / "log.tdms"
        with TdmsWriter(path) as writer:
            writer.write_segment(
                [
                    ChannelObject(g, n, *(c if isinstance(c, tuple) else (c,)))
                    for g, channels in groups.items()
                    for n, c in channels.items()
                ]
            )
        return path

    return tdms


@pytest.fixture
def mat(tmp_path: Path) -> Callable[..., Path]:
    """Write a MAT file; version "5" through SciPy, others through mat-io."""

    def mat(variables: dict[str, Any], version: str = "5") -> Path:
        path = tmp_path / "log.mat"
        if version == "5":
            from scipy.io import savemat

            savemat(path, variables)
        else:
            from matio import save_to_mat

            save_to_mat(str(path), variables, version=version)
        return path

    return mat

"""The DLL of an FMU, loaded where Windows programs run: under wine, where that is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from fmu_built import Instance, damper, driven, table_2

from erdctl.export.c.source import write_c
from erdctl.export.fmu.compile import cross_compiled
from erdctl.export.fmu.damper import damper_block
from erdctl.export.fmu.package import packaged

WINE = shutil.which("wine64") or shutil.which("wine64", path="/usr/lib/wine")
CROSS = find_spec("ziglang")
LIBRARIES = {
    "ucrtbase": "sin cos fopen fwrite fclose",
    "kernel32": "LoadLibraryA GetProcAddress ExitProcess",
}
pytestmark = pytest.mark.skipif(WINE is None or CROSS is None, reason="needs wine64 and ziglang")


def cross(folder: Path, *words: str) -> None:
    subprocess.run([sys.executable, "-m", "ziglang", *words], cwd=folder, check=True)


def test_the_dll_gives_the_same_force_and_returns_to_a_state(tmp_path: Path) -> None:
    path = tmp_path / "damper.fmu"
    block = damper_block(write_c(table_2(), prefix="damper"), table_2())
    path.write_bytes(packaged(block, build=cross_compiled).data)
    archive = zipfile.ZipFile(path)
    (tmp_path / "damper.dll").write_bytes(archive.read("binaries/win64/damper.dll"))
    token = archive.read("sources/erdctl_block.h").decode().split('TOKEN "')[1].split('"')[0]
    for name, functions in LIBRARIES.items():
        text = "\n".join([f'LIBRARY "{name}.dll"', "EXPORTS", *functions.split(), ""])
        (tmp_path / f"{name}.def").write_text(text)
        cross(tmp_path, "dlltool", "-m", "i386:x86-64", "-d", f"{name}.def", "-l", f"{name}.lib")
    assert CROSS is not None
    assert CROSS.origin is not None
    headers = Path(CROSS.origin).parent / "lib" / "libc" / "include" / "any-windows-any"
    cross(
        tmp_path, "cc", "-target", "x86_64-windows-gnu", "-O1", "-nostdlib", "-Wl,-e,begin",
        "-Wl,--subsystem,console", "-mno-stack-arg-probe", "-isystem", str(headers),
        f'-DGUID="{token}"', "-o", "run.exe", str(Path(__file__).with_name("windows_master.c")),
        *(f"{name}.lib" for name in LIBRARIES),
    )  # fmt: skip
    place = os.environ | {"WINEPREFIX": str(tmp_path / "prefix"), "WINEDEBUG": "-all"}
    subprocess.run([str(WINE), "run.exe"], cwd=tmp_path, env=place, check=True, timeout=120)
    forces = np.fromfile(tmp_path / "forces.bin")

    t = np.arange(2000) * 1e-3
    signals = {
        "x": 0.01 * np.sin(7.0 * t),
        "xdot": 0.07 * np.cos(7.0 * t),
        "duty": np.where(np.arange(2000) < 1000, 0.1, 0.4),
    }
    instance = Instance(damper("2"))
    wanted = driven(instance, signals, t)
    instance.close()
    assert np.max(np.abs(forces[:2000] - wanted)) <= 1e-9 * np.ptp(wanted)
    assert np.array_equal(forces[2000:], forces[1000:2000])

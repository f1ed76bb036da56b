"""What is in an FMU: platforms, the same bytes each time, sources that anybody can build."""

from __future__ import annotations

import io
import json
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmpy.validation import validate_fmu
from fmu_built import NUMBERS, Instance, driven, folder, table_2
from places import FIXTURES, ROOT

from erdctl.cli.app import run
from erdctl.export.c.source import write_c
from erdctl.export.fmu import compile as compiling
from erdctl.export.fmu.block import FmuBlock, FmuVariable
from erdctl.export.fmu.compile import CROSS, Compiled, cross_compiled, host_compiled
from erdctl.export.fmu.damper import damper_block
from erdctl.export.fmu.fat import universal
from erdctl.export.fmu.package import packaged
from erdctl.export.fmu.version import MAC, MAC_ARM, VERSIONS, WINDOWS

COMPILERS = [c for c in ("gcc", "clang") if shutil.which(c)]
STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wmissing-prototypes"]
PLACES = {
    "2": ["linux64/{}.so", "win64/{}.dll", "darwin64/{}.dylib"],
    "3": ["x86_64-linux/{}.so", "x86_64-windows/{}.dll", "x86_64-darwin/{}.dylib",
          "aarch64-darwin/{}.dylib"],
}  # fmt: skip
# First bytes: ELF, MZ, Mach-O of 64 bits or a universal binary.
MAGIC = {".so": b"\x7fELF", ".dll": b"MZ", ".dylib": b"\xcf\xfa\xed\xfe"}
UNIVERSAL = b"\xca\xfe\xba\xbe"


def block(prefix: str = "damper") -> FmuBlock:
    p = table_2()
    return damper_block(write_c(p, prefix=prefix), p)


def opened(data: bytes) -> dict[str, bytes]:
    archive = zipfile.ZipFile(io.BytesIO(data))
    return {name: archive.read(name) for name in archive.namelist()}


def unbuilt(sources: Mapping[str, str]) -> Compiled:
    return Compiled(binaries={}, compiler="", failed={})


@pytest.fixture(scope="module")
def crossed() -> dict[str, bytes]:
    """FMUs of all platforms; a second time nothing is compiled anew."""
    pytest.importorskip("ziglang")
    return {
        number: packaged(block(), version=VERSIONS[number], build=cross_compiled).data
        for number in NUMBERS
    }


@pytest.mark.parametrize("number", NUMBERS)
def test_binaries_for_all_platforms(crossed: dict[str, bytes], number: str) -> None:
    files = opened(crossed[number])
    there = {name: data for name, data in files.items() if name.startswith("binaries/")}
    assert [*there] == [f"binaries/{place.format('damper')}" for place in PLACES[number]]
    for name, data in there.items():
        one = MAGIC[Path(name).suffix]
        assert data.startswith(UNIVERSAL if "darwin64/" in name else one)
        assert f"fmi{number}DoStep".encode() in data
    windows = next(data for name, data in there.items() if name.endswith(".dll"))
    # Of libraries it asks for that which is part of Windows.
    assert b"ucrtbase.dll" in windows
    assert windows.count(b".dll") == 2  # with its own name
    assert str(folder()).encode() not in b"".join(there.values())


@pytest.mark.parametrize("number", NUMBERS)
def test_that_for_this_machine_gives_the_force_of_the_host_compiler(
    crossed: dict[str, bytes], number: str
) -> None:
    t = np.arange(0.0, 2.0, 1e-3)
    x = 0.01 * np.sin(7.0 * t)
    signals = {"x": x, "xdot": 0.07 * np.cos(7.0 * t), "duty": np.where(t < 1.0, 0.1, 0.4)}
    forces = []
    for name, data in (
        ("crossed", crossed[number]),
        ("host", packaged(block(), version=VERSIONS[number], build=host_compiled).data),
    ):
        path = folder() / f"{name}_{number}.fmu"
        path.write_bytes(data)
        instance = Instance(path)
        forces.append(driven(instance, signals, t))
        instance.close()
    assert np.max(np.abs(forces[0] - forces[1])) <= 1e-9 * np.ptp(forces[1])


def test_the_same_block_gives_the_same_bytes(crossed: dict[str, bytes]) -> None:
    again = packaged(block(), version=VERSIONS["2"], build=cross_compiled).data
    assert again == crossed["2"]


def test_another_parameter_gives_another_guid() -> None:
    first = block()
    start = replace(first.parameters[0], start=first.parameters[0].start * 2)
    other = replace(first, parameters=(start, *first.parameters[1:]))
    texts = [
        opened(packaged(b, build=unbuilt).data)["sources/erdctl_block.h"] for b in (first, other)
    ]
    tokens = [text.split(b"#define TOKEN ")[1].split(b"\n")[0] for text in texts]
    assert tokens[0] != tokens[1]


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("compiler", COMPILERS)
def test_sources_build_without_a_warning(tmp_path: Path, compiler: str, number: str) -> None:
    """As they are in the FMU, with nothing but a compiler."""
    zipfile.ZipFile(
        io.BytesIO(packaged(block(), version=VERSIONS[number], build=unbuilt).data)
    ).extractall(tmp_path)
    done = subprocess.run(
        [compiler, *STRICT, "-Werror", "-shared", "-fPIC", "-o", "out.so",
         *(p.name for p in (tmp_path / "sources").glob("*.c")), "-lm"],
        cwd=tmp_path / "sources", capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stderr == ""
    assert done.returncode == 0


MASTER = Path(__file__).with_name("master.c")


def test_linked_statically_under_the_sanitizers(tmp_path: Path) -> None:
    """Functions carry the model's identifier then; every function of FMI 2.0 is called."""
    data = packaged(block(), build=unbuilt).data
    zipfile.ZipFile(io.BytesIO(data)).extractall(tmp_path)
    here = tmp_path / "sources"
    token = (here / "erdctl_block.h").read_text().split('#define TOKEN "')[1].split('"')[0]
    done = subprocess.run(
        [COMPILERS[0], *STRICT, "-Werror", "-g", "-DFMI2_FUNCTION_PREFIX=damper_",
         f'-DGUID="{token}"', "-fsanitize=address,undefined", "-fno-sanitize-recover=all",
         "-o", "run", str(MASTER), *(p.name for p in here.glob("*.c")), "-lm"],
        cwd=here, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    ran = subprocess.run([here / "run"], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert ran.stdout.strip() == "ok"


def test_without_the_cross_compiler_that_of_the_machine_is_taken_and_it_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(compiling, "find_spec", lambda name: None)
    out = tmp_path / "front left.fmu"
    assert run(["export", str(FIXTURES / "table_2.json"), "-o", str(out)]) == 0
    said = capsys.readouterr().err
    assert "linux64" in said
    assert "win64" not in said
    assert "erdctl[fmu]" in said
    assert validate_fmu(str(out)) == []
    names = [*opened(out.read_bytes())]
    assert "binaries/linux64/front_left.so" in names


def test_without_any_compiler_there_are_sources(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(compiling, "find_spec", lambda name: None)
    monkeypatch.setattr(compiling.shutil, "which", lambda name: None)
    out = tmp_path / "damper.fmu"
    assert run(["export", str(FIXTURES / "table_2.json"), "-o", str(out), "--fmi", "3"]) == 0
    assert "sources only" in capsys.readouterr().err
    names = [*opened(out.read_bytes())]
    assert "sources/damper.c" in names
    assert not [name for name in names if name.startswith("binaries/")]


def test_a_compiler_that_fails_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(compiling, "find_spec", lambda name: None)
    monkeypatch.setenv("CC", f"{sys.executable} -c 'raise SystemError'")
    out = tmp_path / "damper.fmu"
    assert run(["export", str(FIXTURES / "table_2.json"), "-o", str(out)]) == 4
    assert "linux64" in capsys.readouterr().err
    assert [*tmp_path.iterdir()] == []


def test_a_platform_that_fails_does_not_take_the_others_with_it() -> None:
    def build(sources: Mapping[str, str]) -> Compiled:
        done = host_compiled(sources)
        return replace(done, failed={WINDOWS: "no such header"})

    made = packaged(block(), build=build)
    assert made.platforms == ("linux64",)
    assert made.failed == {"win64": "no such header"}


def test_a_universal_binary_holds_both_as_they_are() -> None:
    """Header big-endian; each part begins at a multiple of 16 KiB."""
    parts = [
        b"\xcf\xfa\xed\xfe" + bytes([7, 0, 0, 1, 3, 0, 0, 0]) + b"intel" * 5000,
        b"\xcf\xfa\xed\xfe" + bytes([12, 0, 0, 1, 0, 0, 0, 0]) + b"arm",
    ]
    made = universal(parts)
    assert made[:8] == UNIVERSAL + bytes([0, 0, 0, 2])
    for i, part in enumerate(parts):
        row = np.frombuffer(made, ">u4", 5, 8 + 20 * i).tolist()
        assert row[:2] == [[0x01000007, 3], [0x0100000C, 0]][i]
        assert row[2] % 16384 == 0
        assert made[row[2] : row[2] + row[3]] == part
    assert universal(parts[:1]) == parts[0]


def test_what_blocks_call_is_linked_for_windows() -> None:
    """Functions are called by macros in capitals, defined in the fixed parts of either block."""
    called = set()
    for room in ("c", "emulator"):
        for path in (ROOT / "erdctl" / "export" / room / "parts").iterdir():
            called |= set(re.findall(r"#define [A-Z0-9]+ ([a-z0-9]+)\n", path.read_text()))
    plain = {name for name in called if not (name[-1] == "f" and name[:-1] in called)}
    assert {"exp", "expm1", "pow"} <= plain
    assert plain <= set(compiling._FUNCTIONS.split())


def test_targets_are_those_of_the_issue() -> None:
    assert {t.name for t in CROSS} == {"linux64", "win64", MAC.name, MAC_ARM.name}


def test_a_block_that_is_no_damper(tmp_path: Path) -> None:
    """Nothing of the wrapping knows a damper: a block that doubles, without any parameter."""
    header = (
        "typedef double twice_real;\ntypedef struct { double none; } twice_params;\n"
        "typedef struct { twice_params p; double last; int calls; } twice_state;\n"
        "void twice_defaults(twice_params *p);\n"
        "void twice_init(twice_state *s, const twice_params *p);\n"
    )
    source = (
        '#include "twice.h"\nvoid twice_defaults(twice_params *p) { p->none = 0.0; }\n'
        "void twice_init(twice_state *s, const twice_params *p)"
        " { s->p = *p; s->last = 0.0; s->calls = 0; }\n"
    )
    twice = FmuBlock(
        prefix="twice", title="Twice", header=header, source=source,
        inputs=(FmuVariable(name="a", start=1.5),), outputs=(FmuVariable(name="b"),),
        calls="s->calls++;\nb = 2.0 * a + (double)(s->calls - 1);", status="0", words={},
    )  # fmt: skip
    for number in NUMBERS:
        path = tmp_path / f"twice{number}.fmu"
        made = packaged(twice, version=VERSIONS[number], build=host_compiled)
        path.write_bytes(made.data)
        assert validate_fmu(str(path)) == []
        instance = Instance(path).start()
        assert instance.get("b") == 3.0
        assert instance.step(0.1, a=2.0) == 5.0
        instance.close()


def test_a_parameter_file_is_read(tmp_path: Path) -> None:
    """Identified values are the start values, to the last digit."""
    parameters = json.loads((FIXTURES / "table_2.json").read_text())
    out = tmp_path / "damper.fmu"
    out.write_bytes(packaged(block(), build=unbuilt).data)
    text = opened(out.read_bytes())["modelDescription.xml"].decode()
    value = parameters["release"]["beta"]
    assert f'start="{float(value["value"] if isinstance(value, dict) else value)!r}"' in text

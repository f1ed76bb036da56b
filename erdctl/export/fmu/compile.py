"""Binaries of an FMU: by a packaged cross-compiler for all platforms, or by the host's for one."""

from __future__ import annotations

import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from erdctl.core.errors import ComputationProblem
from erdctl.export.fmu.version import LINUX, LINUX_ARM, MAC, MAC_ARM, WINDOWS, Platform

_PACKAGE = "ziglang"  # of the extra `fmu`
CROSS = (LINUX, WINDOWS, MAC, MAC_ARM)

# The same numbers on every processor: no fused multiply-add, which one has and another has not.
_FLAGS = ("-std=c99", "-O2", "-shared", "-fvisibility=hidden", "-ffp-contract=off", "-g0")

# What the C of a block may use of a library. A DLL asks the C runtime that is part of Windows for
# it by name: the cross-compiler would otherwise build a runtime of its own first, for minutes.
_RUNTIME = "ucrtbase.dll"
_FUNCTIONS = """
acos acosh asin asinh atan atan2 atanh calloc cbrt ceil copysign cos cosh erf erfc exp exp2 expf
expm1 expm1f fabs floor fma fmax fmin fmod free hypot lgamma log log10 log1p log2 lround malloc
memcmp memcpy memmove memset modf nearbyint pow powf remainder rint round sin sinh sqrt strcmp
strlen tan tanh tanhf tgamma trunc
"""


@dataclass(frozen=True, kw_only=True)
class Compiled:
    """Shared libraries by platform, what built them, and what failed (platform and reason)."""

    binaries: Mapping[Platform, bytes]
    compiler: str
    failed: Mapping[Platform, str]


def compiled(sources: Mapping[str, str]) -> Compiled:
    """Shared libraries of C files, for as many platforms as there is a compiler for.

    sources : text of all files by name
    Raises ComputationProblem if there is a compiler, and it fails on every platform.
    """
    return cross_compiled(sources) if find_spec(_PACKAGE) is not None else host_compiled(sources)


def cross_compiled(sources: Mapping[str, str]) -> Compiled:
    """Shared libraries for the platforms of `CROSS`, by the packaged cross-compiler."""
    with _written(sources) as folder:
        return _cross(folder, _of_c(sources))


def host_compiled(sources: Mapping[str, str]) -> Compiled:
    """The shared library for this machine, by its own compiler; none without one."""
    with _written(sources) as folder:
        return _host(folder, _of_c(sources))


@contextmanager
def _written(sources: Mapping[str, str]) -> Iterator[str]:
    with tempfile.TemporaryDirectory(prefix="erdctl-") as folder:
        for name, text in sources.items():
            Path(folder, name).write_text(text, "utf-8", newline="\n")
        yield folder


def _of_c(sources: Mapping[str, str]) -> list[str]:
    return [name for name in sources if name.endswith(".c")]


def _cross(folder: str, files: Sequence[str]) -> Compiled:
    command = [sys.executable, "-m", _PACKAGE]
    spec = find_spec(_PACKAGE)
    assert spec is not None
    assert spec.origin is not None
    headers = Path(spec.origin).parent / "lib" / "libc" / "include" / "any-windows-any"

    def build(system: Platform) -> bytes:
        out = f"{system.triple}{system.suffix}"
        link = ["-s", "-fPIC", "-lm"]
        if system is WINDOWS:
            named = "\n".join([f'LIBRARY "{_RUNTIME}"', "EXPORTS", *_FUNCTIONS.split(), ""])
            Path(folder, "runtime.def").write_text(named, "utf-8")
            tool = ["dlltool", "-m", "i386:x86-64", "-d", "runtime.def", "-l", "runtime.lib"]
            _run([*command, *tool], folder)
            link = ["-s", "-nostdlib", "-Wl,--no-entry", "-mno-stack-arg-probe"]
            link += ["-isystem", str(headers), "runtime.lib"]
        _run([*command, "cc", "-target", system.triple, *_FLAGS, "-o", out, *files, *link], folder)
        return Path(folder, out).read_bytes()

    return _all(CROSS, build, "the cross-compiler")


def _host(folder: str, files: Sequence[str]) -> Compiled:
    names = [os.environ.get("CC", ""), "cc", "gcc", "clang"]
    commands = [shlex.split(name) for name in names if name]
    command = next((c for c in commands if shutil.which(c[0])), None)
    system = _here()
    if command is None or system is None:
        return Compiled(binaries={}, compiler="", failed={})

    def build(system: Platform) -> bytes:
        out = f"built{system.suffix}"
        position = [] if system is WINDOWS else ["-fPIC"]
        _run([*command, *_FLAGS, *position, "-o", out, *files, "-lm"], folder)
        return Path(folder, out).read_bytes()

    return _all([system], build, command[0])


def _all(
    systems: Sequence[Platform], build: Callable[[Platform], bytes], compiler: str
) -> Compiled:
    """What can be built; a platform that fails does not take the others with it."""
    binaries, failed = {}, {}
    with ThreadPoolExecutor(max_workers=min(len(systems), os.cpu_count() or 1)) as pool:
        for system, work in [(t, pool.submit(build, t)) for t in systems]:
            try:
                binaries[system] = work.result()
            except (OSError, subprocess.CalledProcessError) as error:
                failed[system] = _reason(error)
    if failed and not binaries:
        system, reason = next(iter(failed.items()))
        raise ComputationProblem(f"{compiler} could not build for {system.name}: {reason}")
    return Compiled(binaries=binaries, compiler=compiler, failed=failed)


def _run(command: Sequence[str], folder: str) -> None:
    # Names of files are relative: no path of this machine gets into a binary.
    subprocess.run(
        command, cwd=folder, check=True, capture_output=True, text=True, errors="replace"
    )


def _reason(error: OSError | subprocess.CalledProcessError) -> str:
    if isinstance(error, OSError):
        return error.strerror or str(error)
    lines = [line for line in error.stderr.splitlines() if "error" in line] or ["it failed"]
    return str(lines[0])


def _here() -> Platform | None:
    """The platform of this machine; None for one that no FMU knows."""
    arm = platform.machine().lower() in {"arm64", "aarch64"}
    if sys.maxsize < 2**32 or not (arm or platform.machine().lower() in {"amd64", "x86_64"}):
        return None
    system = platform.system()
    if system == "Windows":
        return None if arm else WINDOWS
    if system == "Darwin":
        return MAC_ARM if arm else MAC
    return (LINUX_ARM if arm else LINUX) if system == "Linux" else None

"""The two versions of FMI, and the platforms that an FMU has a binary for."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Platform:
    """A platform that a binary is built for.

    name : for people;  suffix : of its shared libraries
    triple : as the packaged cross-compiler names it; glibc 2.17 is that of 2012
    """

    name: str
    suffix: str
    triple: str


LINUX = Platform(name="linux64", suffix=".so", triple="x86_64-linux-gnu.2.17")
WINDOWS = Platform(name="win64", suffix=".dll", triple="x86_64-windows-gnu")
MAC = Platform(name="macOS x86_64", suffix=".dylib", triple="x86_64-macos")
MAC_ARM = Platform(name="macOS arm64", suffix=".dylib", triple="aarch64-macos")
LINUX_ARM = Platform(name="linux arm64", suffix=".so", triple="aarch64-linux-gnu.2.17")


@dataclass(frozen=True, kw_only=True)
class Version:
    """A version of FMI.

    number : as modelDescription.xml says it;  shim : the C file with its functions
    folders : under binaries/, for each platform
    """

    number: str
    shim: str
    folders: dict[Platform, str]


# FMI 2.0 has one folder for a Mac of either kind: its file there holds both. Linux on arm is not in
# the standard; importers look for it where that on x86 is.
TWO = Version(
    number="2.0",
    shim="erdctl_fmi2.c",
    folders={
        LINUX: "linux64",
        WINDOWS: "win64",
        MAC: "darwin64",
        MAC_ARM: "darwin64",
        LINUX_ARM: "linux64",
    },
)
THREE = Version(
    number="3.0",
    shim="erdctl_fmi3.c",
    folders={
        LINUX: "x86_64-linux",
        WINDOWS: "x86_64-windows",
        MAC: "x86_64-darwin",
        MAC_ARM: "aarch64-darwin",
        LINUX_ARM: "aarch64-linux",
    },
)
VERSIONS = {"2": TWO, "3": THREE}

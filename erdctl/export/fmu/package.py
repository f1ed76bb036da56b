"""An FMU: the zip file of a block's description, its sources and its binaries."""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from erdctl.export.fmu.binding import sources
from erdctl.export.fmu.block import Block
from erdctl.export.fmu.compile import Compiled, compiled
from erdctl.export.fmu.description import build_description, model_description, page
from erdctl.export.fmu.fat import universal
from erdctl.export.fmu.version import TWO, Version

Builder = Callable[[Mapping[str, str]], Compiled]  # of the text of all sources by name

_EARLIEST = (1980, 1, 1, 0, 0, 0)  # of a zip file: the same content gives the same bytes
_UNIX = 3  # the system whose modes a zip file states: anybody may read


@dataclass(frozen=True, kw_only=True)
class Package:
    """A whole FMU, and what is to be said of it.

    platforms : that it has a binary for;  failed : platforms left out, and why
    compiler : what built them, empty if there was none
    """

    data: bytes
    platforms: tuple[str, ...]
    failed: Mapping[str, str]
    compiler: str


def packaged(block: Block, *, version: Version = TWO, build: Builder = compiled) -> Package:
    """The FMU of a block for co-simulation.

    Its sources are in it; its binaries are those that can be built here.
    Raises ComputationProblem if no compiler that is there builds it for any platform.
    """
    token = _token(block, version)
    texts = sources(block, version, token)
    built = build(texts)
    return Package(
        data=_zip(_files(block, version, token, texts, built)),
        platforms=tuple(target.name for target in built.binaries),
        failed={target.name: reason for target, reason in built.failed.items()},
        compiler=built.compiler,
    )


def _token(block: Block, version: Version) -> str:
    """GUID of an FMU, out of everything that it is made of."""
    texts = sources(block, version, "")
    said = model_description(block, version, "", _compiled(texts))
    whole = hashlib.sha256(said)
    for name, text in texts.items():
        whole.update(f"\0{name}\0{text}".encode())
    h = whole.hexdigest()
    return f"{{{h[:8]}-{h[8:12]}-{h[12:16]}-{h[16:20]}-{h[20:32]}}}"


def _compiled(texts: Mapping[str, str]) -> list[str]:
    return [name for name in texts if name.endswith(".c")]


def _files(
    block: Block, version: Version, token: str, texts: Mapping[str, str], built: Compiled
) -> dict[str, bytes]:
    files = {
        "modelDescription.xml": model_description(block, version, token, _compiled(texts)),
        "documentation/index.html": page(block),
    }
    files |= {f"sources/{name}": text.encode() for name, text in texts.items()}
    if version is not TWO:
        files["sources/buildDescription.xml"] = build_description(block, _compiled(texts))
    parts: dict[str, list[bytes]] = {}
    for target, data in built.binaries.items():
        name = PurePosixPath("binaries", version.folders[target], block.prefix + target.suffix)
        parts.setdefault(str(name), []).append(data)
    return files | {name: universal(data) for name, data in parts.items()}


def _zip(files: Mapping[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            info = zipfile.ZipInfo(name, _EARLIEST)
            info.create_system, info.external_attr = _UNIX, 0o644 << 16
            archive.writestr(info, data, zipfile.ZIP_DEFLATED)
    return stream.getvalue()

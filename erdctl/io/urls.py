"""Logs by URL in object storage or on a shared disk, through the file systems of Arrow.

`s3://`, `gs://`, `hdfs://`, `abfs://` and `file://` come with pyarrow; `fsspec+PROTOCOL://` takes
any file system of fsspec that is installed.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, TypeVar

from erdctl.core.errors import UsageProblem

T = TypeVar("T")

_URL = re.compile(r"[a-z][a-z0-9+.-]*://", re.IGNORECASE)
_WILD = re.compile(r"[*?]")


def is_url(path: str) -> bool:
    """Whether a path names a file by its protocol.

    Check: a drive of Windows is none.
    >>> is_url("s3://bench/fl.parquet"), is_url("C:/bench/fl.parquet"), is_url("fl.parquet")
    (True, False, False)
    """
    return _URL.match(path) is not None


def is_pattern(path: str) -> bool:
    """Whether a path stands for the files that it matches."""
    return _WILD.search(path) is not None


def fetch(url: str) -> bytearray:
    """All bytes behind a URL.

    Raises UsageProblem for a protocol that is not known, and for what cannot be read.
    """

    def read(files: Any, path: str) -> bytearray:
        with files.open_input_file(path) as stream:
            out = bytearray(stream.size())
            # Not read(): its bytes would be in memory twice until they are in the array.
            stream.readinto(out)
        return out

    return _tried(url, read)


def matching(url: str) -> list[str]:
    """URLs of the files that a URL with `*`, `?` or `**` matches, in order."""
    from pyarrow import fs

    head = url[: _WILD.search(url).start()].rpartition("/")[0]  # type: ignore[union-attr]  # a pattern

    def found(files: Any, path: str) -> list[str]:
        listed = files.get_file_info(fs.FileSelector(path, recursive=True, allow_not_found=True))
        there = [i.path[len(path) :].lstrip("/") for i in listed if i.type == fs.FileType.File]
        wanted = re.compile(translated(url[len(head) :].lstrip("/")))
        return sorted(f"{head}/{name}" for name in there if wanted.fullmatch(name))

    return _tried(head, found)


def translated(pattern: str) -> str:
    """A pattern of paths as a regular expression.

    Check: one star stays in its folder.
    >>> [bool(re.fullmatch(translated(p), "a/b/c.csv")) for p in ("a/*.csv", "a/**/*.csv")]
    [False, True]
    """
    forms = {"**/": "(?:.*/)?", "**": ".*", "*": "[^/]*", "?": "[^/]"}
    parts = re.split(r"(\*\*/|\*\*|\*|\?)", pattern)
    return "".join(forms.get(part, re.escape(part)) for part in parts)


def _tried(url: str, work: Callable[[Any, str], T]) -> T:
    import pyarrow as pa
    from pyarrow import fs

    try:
        return work(*fs.FileSystem.from_uri(url))
    except FileNotFoundError:
        raise UsageProblem(f"'{url}' does not exist") from None
    except ImportError as error:
        raise UsageProblem(f"cannot read '{url}': {error}") from None
    except (OSError, ValueError, pa.ArrowException) as error:
        reason = str(error).splitlines()[0][:200]
        raise UsageProblem(f"cannot read '{url}': {reason}") from None

"""Which project file holds in a folder."""

from __future__ import annotations

import os
import stat

FILE = "erdctl.toml"


def find(start: str) -> str | None:
    """The nearest project file, in a folder or above it; None if there is none.

    start : absolute path of the folder
    The search ends at the user's home, or at the root where that is not above. A file of somebody
    else in a folder into which everybody may write, as /tmp is, is passed over.
    """
    home = os.path.realpath(os.path.expanduser("~"))
    here = os.path.realpath(start)
    while True:
        path = os.path.join(here, FILE)
        if os.path.isfile(path) and _trusted(here, path):
            return path
        above = os.path.dirname(here)
        if here in (home, above):
            return None
        here = above


def _trusted(folder: str, path: str) -> bool:
    if not hasattr(os, "getuid"):  # Windows has other rights
        return True
    try:
        shared = os.stat(folder).st_mode & stat.S_IWOTH
        return not shared or os.stat(path).st_uid in (os.getuid(), 0)
    except OSError:
        return False

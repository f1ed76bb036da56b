"""Outcomes of cases on disk, so that a proof that was ended is taken up where it stood."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import msgspec

from erdctl.core.errors import UsageProblem
from erdctl.prove.case import Wish
from erdctl.prove.catalogued import nameable
from erdctl.prove.judge import Result

RESULTS, MARK = "results", "proof.txt"


@dataclass(frozen=True)
class Kept:
    """The outcomes in one folder, all of one proof."""

    folder: Path

    @classmethod
    def of(cls, folder: Path, wish: Wish, first: int) -> Kept:
        """Those of a proof with some wish and first seed; the folder is marked as its own.

        Raises UsageProblem where it holds something else: cases of other options, another seed,
        another catalogue or other code would be counted as this one's.
        """
        place = folder / RESULTS
        mark = _mark(wish, first)
        if place.is_dir():
            if (place / MARK).read_text() != mark:
                raise UsageProblem(
                    f"--keep {folder}: it holds a proof with other options, another seed or another"
                    " erdctl; name a new directory"
                )
        elif folder.is_dir() and any(folder.iterdir()):
            raise UsageProblem(f"--keep {folder}: the directory is not empty; name a new one")
        else:
            place.mkdir(parents=True)
            (place / MARK).write_text(mark)
        return cls(place)

    def read(self, number: int) -> Result | None:
        """The outcome of a case that was scored."""
        place = self._place(number)
        try:
            return msgspec.json.decode(place.read_bytes(), type=Result)
        except (FileNotFoundError, msgspec.ValidationError):
            return None  # not scored, or with an error that is no number and so not in JSON: anew

    def write(self, result: Result) -> None:
        """Keep an outcome; whole or not at all."""
        place = self._place(result.number)
        new = place.with_suffix(".new")
        new.write_bytes(msgspec.json.encode(result))
        new.replace(place)

    def _place(self, number: int) -> Path:
        return self.folder / f"case-{number:03d}.json"


def _mark(wish: Wish, first: int) -> str:
    """What outcomes depend on: options, seeds, catalogue and code."""
    package = Path(__file__).parents[1]
    code = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        code.update(path.relative_to(package).as_posix().encode() + path.read_bytes())
    return repr((wish, first, sorted(nameable()), code.hexdigest()))

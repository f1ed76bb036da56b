"""A diagnosis against the key of its case: named, located, and the error reduction reached."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from erdctl.plant.regions import MOST_WIDTH, MisfitRegion, overlap

OVERLAP = 0.3  # intersection over union from which a region is the true one
EXTRA = 2  # names after the first that a finding may hold: at most three in all
BANDS = (2.0, 1.0, 0.2)  # misfit over noise, lower edges, the strongest first
BAND_NAMES = (">= 2", "1 to 2", "0.2 to 1", "< 0.2")


@dataclass(frozen=True)
class HiddenEffect:
    """One hidden effect; level : misfit that it leaves alone, over noise."""

    effect: str
    level: float
    equivalent: tuple[str, ...] = ()


@dataclass(frozen=True)
class Found:
    """One finding, as the diagnosis' document has it."""

    effect: str
    equivalent: tuple[str, ...] = ()


@dataclass(frozen=True)
class Interval:
    """An interval of one variable that the diagnosis points at."""

    variable: str
    low: float
    high: float


@dataclass(frozen=True)
class Printed:
    """A parameter that a diagnosis prints with a 95 % interval, and what it is in the plant."""

    parameter: str
    low: float
    high: float
    truth: float

    @property
    def holds(self) -> bool:
        """Whether the truth lies within."""
        return self.low <= self.truth <= self.high


@dataclass(frozen=True)
class Errors:
    """Root mean square errors on the fresh records [N], and the range that scales them.

    best : of the true structure refitted on the log, None where erdctl has no such structure
    span : range of the true force [N]
    """

    paper: float
    corrected: float
    best: float | None
    span: float

    @property
    def removed(self) -> float | None:
        """Attainable reduction: the error removed, over what the true structure, fitted, removes.

        Check: paper 5 N, corrected 1.4 N, best 1 N gives 3.6 / 4 = 0.9.
        >>> round(Errors(paper=5.0, corrected=1.4, best=1.0, span=20.0).removed, 9)
        0.9
        """
        if self.best is None or self.best >= self.paper:
            return None
        return (self.paper - self.corrected) / (self.paper - self.best)

    @property
    def cut(self) -> float:
        """The part of the paper's error that the corrected model removes [1]; below 0 it adds.

        Check: paper 5 N, corrected 1 N gives 0.8.
        >>> Errors(paper=5.0, corrected=1.0, best=None, span=20.0).cut
        0.8
        """
        return 1.0 - self.corrected / self.paper if self.paper > 0.0 else 0.0

    def nrmse(self, rms: float | None) -> float | None:
        """An error over the range of the true force."""
        return None if rms is None else rms / self.span


@dataclass(frozen=True)
class LawPlace:
    """Slot and coordinates of a law, so written that what is the same compares equal."""

    slot: str
    coordinates: frozenset[str]

    @staticmethod
    def of(slot: str, names: Iterable[str]) -> LawPlace:
        """A curve over x can be any over its size; a force that turns with the motion is friction.

        Check: a force of x that has another course for either direction is friction, and more.
        >>> LawPlace.of("force", ["x", "direction"]) == LawPlace.of("friction", ["abs_x"])
        True
        """
        plain = {name.removeprefix("abs_") for name in names}
        if slot == "force" and "direction" in plain:
            return LawPlace("friction", frozenset(plain - {"direction"}))
        return LawPlace(slot, frozenset(plain))


@dataclass(frozen=True)
class Naming:
    """How findings and truth match.

    first : whether the first finding is right;  matched : hidden effects that have their finding
    spurious : findings that match nothing hidden
    redundant : findings that match something hidden which another finding has matched already
    """

    first: bool
    matched: int
    spurious: int
    redundant: int


def band(level: float) -> str:
    """Name of the band of a level.

    Check: 2.0 is in ">= 2", 1.99 in "1 to 2".
    >>> band(2.0), band(1.99)
    ('>= 2', '1 to 2')
    """
    for name, edge in zip(BAND_NAMES, BANDS, strict=False):
        if level >= edge:
            return name
    return BAND_NAMES[-1]


def matches(found: Found, hidden: HiddenEffect) -> bool:
    """Whether a finding names a hidden effect.

    By its own name, by one that is the same to a force channel at the rod, or as one of at most
    three names that the diagnosis says it cannot tell apart.
    """
    if found.effect == hidden.effect or found.effect in hidden.equivalent:
        return True
    return hidden.effect in found.equivalent and len(found.equivalent) <= EXTRA


def naming(findings: Sequence[Found], hidden: Sequence[HiddenEffect]) -> Naming:
    """Findings against truth; one finding stands for one hidden effect at most."""
    useful = [any(matches(f, h) for h in hidden) for f in findings]
    matched = _paired(findings, hidden)
    return Naming(
        first=bool(useful) and useful[0],
        matched=matched,
        spurious=useful.count(False),
        redundant=useful.count(True) - matched,
    )


def _paired(findings: Sequence[Found], hidden: Sequence[HiddenEffect]) -> int:
    """Most hidden effects that can have a finding each."""
    if not hidden:
        return 0
    first, rest = hidden[0], hidden[1:]
    best = _paired(findings, rest)
    for k, finding in enumerate(findings):
        if matches(finding, first):
            best = max(best, 1 + _paired([*findings[:k], *findings[k + 1 :]], rest))
    return best


def located(places: Sequence[Interval], regions: Sequence[Mapping[str, Any]]) -> bool | None:
    """Whether a reported place is a true one; None if the misfit is everywhere.

    The key gives each region's width as a part of the variable's range, which says how wide a
    reported place is: one that covers most of the range points at nothing.
    """
    if not regions:
        return None
    return any(_points_at(place, MisfitRegion(**r)) for place in places for r in regions)


def _points_at(place: Interval, region: MisfitRegion) -> bool:
    if place.variable != region.variable:
        return False
    span = (region.high - region.low) / region.width
    narrow = place.high - place.low <= MOST_WIDTH * span
    return narrow and overlap(region, (place.low, place.high)) >= OVERLAP

"""Which parameters and effects a log can show, before anything is fitted.

`identify`, `diagnose` and `inspect` all ask here, so that they cannot disagree. A demand that is
met means "can be tested", one that is not "cannot be identified from this log", never "absent".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import Generic, TypeVar

from erdctl.bench.excitation import ENOUGH, NO_STEP, SAME_LEVEL, Excitation, Survey
from erdctl.core.recording import DIRECTIONS, Recording
from erdctl.model.effect import Effect, Requirement

S = TypeVar("S")
Recipe = Callable[["Bench"], str]


@dataclass(frozen=True)
class Bench:
    """What a log shows its bench to be capable of, for drives that it can run.

    stroke, speed : half the range of x [m], highest speed [m/s];  duty : highest duty [1]
    """

    stroke: float
    speed: float
    duty: float

    @classmethod
    def of(cls, survey: Survey) -> Bench:
        """The bench of a log; a plain small test where the log shows nothing."""
        return cls(
            stroke=survey.stroke / 2 or 0.01, speed=survey.speed or 0.05, duty=survey.duty or 0.3
        )

    def sine(self, duty: str = "", most: float = 1.0) -> str:
        """A sine at up to `most` Hz that uses stroke and speed."""
        frequency = min(most, self.speed / (2 * pi * self.stroke))
        return (
            f"sine:freq={frequency:.3g},amp={self.stroke:.3g}{duty},duration={12 / frequency:.3g}"
        )

    @property
    def field(self) -> str:
        """A sine at the highest duty."""
        return self.sine(f",duty={self.duty:.3g}")

    @property
    def levels(self) -> str:
        """A sine at three levels of duty."""
        parts = "|".join(f"{self.duty * i / 3:.3g}" for i in (1, 2, 3))
        return self.sine(f",duty={parts},hold=2")

    @property
    def steps(self) -> str:
        """A sine while the duty steps, out of time with the motion."""
        return self.sine(f",duty=0|{self.duty:.3g},hold=0.37")

    @property
    def sweep(self) -> str:
        """Frequencies from slow to fast, in the stroke that leaves the speed as it was."""
        fast = max(5.0, 2 * self.speed / (2 * pi * self.stroke))
        stroke = min(self.stroke, self.speed / (2 * pi * fast))
        return f"sweep:f0=0.5,f1={fast:.3g},amp={stroke:.3g},duration=20"


@dataclass(frozen=True)
class Demand(Generic[S]):
    """One measure and how much of it is needed.

    found : the measure of a log, or of one direction of it;  reason : why it is needed, in words
    drive : a `--drive` that offers it;  spared : what makes it unnecessary
    confounded : without it the data fix the parameter, but only together with another, then held
    slight : whether a log without it may hold something of the parameter, but too little to tell
        a value
    """

    what: str
    unit: str
    least: float
    found: Callable[[S], float]
    drive: Recipe
    reason: str = ""
    spared: Callable[[S], bool] = lambda _: False
    confounded: bool = False
    slight: Callable[[S], bool] = lambda _: False

    def check(self, subject: S, bench: Bench) -> Check:
        """The demand, checked on a log."""
        found = self.found(subject)
        met = found >= self.least or self.spared(subject)
        return Check(self.what, self.unit, self.least, found, met, self.drive(bench))


@dataclass(frozen=True)
class Check:
    """A measure of a log against what is needed; drive : one that would offer it."""

    what: str
    unit: str
    needed: float
    found: float
    met: bool
    drive: str

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"{self.what}: {self.found:.3g}{unit}, at least {self.needed:g}{unit} needed"


@dataclass(frozen=True)
class Lack:
    """Why a log cannot show something; confounded, slight : see `Demand`."""

    reason: str
    confounded: bool = False
    slight: bool = False


@dataclass(frozen=True)
class Cover:
    """Whether a log can show one parameter or effect, with every measure that it takes."""

    name: str
    checks: tuple[Check, ...]
    lack: Lack | None

    @property
    def drives(self) -> tuple[str, ...]:
        """Drives that would offer what is missing."""
        return tuple(dict.fromkeys(c.drive for c in self.checks if not c.met))


_MOVES = Demand[Excitation](
    "samples that move this way", "1", ENOUGH, lambda e: e.moving, lambda b: b.sine(),
    f"the log has no motion in this direction, or too little (under {ENOUGH} samples)",
)  # fmt: skip
# Of one direction, as all of these: a control that follows the motion gives a field to one alone.
_FIELD = Demand[Excitation](
    "samples that move this way with a duty above zero", "1", ENOUGH, lambda e: e.field,
    lambda b: b.field,
    "the log has no sample with a duty above zero in this direction, or too few (under"
    f" {ENOUGH})",
)  # fmt: skip
_STEPS = Demand[Excitation](
    "change of the duty within a record that moves this way", "1", 0.02, lambda e: e.steps,
    lambda b: b.steps,
    "the duty is constant within every record that moves this way, or nearly, so the lag of Eq. 12"
    " shows at reversals alone, by as much as the yield forces of the two directions differ; record"
    " steps of the duty while the piston moves",
    # One state serves both directions: held at 0, the lag after a reversal can be a misfit.
    slight=lambda _: True,
)  # fmt: skip
_STROKE = Demand[Excitation](
    "range of the deflection while it moves this way", "m", 1e-6, lambda e: e.stroke,
    lambda b: b.sine(), "the deflection is constant, or nearly, while it moves this way",
)  # fmt: skip
_SPEEDS = Demand[Excitation](
    "spread of the speed this way over its mean", "1", 0.01, lambda e: e.speeds, lambda b: b.sine(),
    "the speed this way is constant, or nearly, so viscous and yield force cannot be separated",
    spared=lambda e: e.null >= ENOUGH or e.field < ENOUGH,
)  # fmt: skip


def _levels(*, confounded: bool) -> Demand[Excitation]:
    return Demand(
        "highest over lowest duty above zero while it moves this way", "1", SAME_LEVEL,
        lambda e: e.ratio, lambda b: b.levels,
        "the log has one duty level above zero in this direction (or none"
        f" {100 * (SAME_LEVEL - 1):g} % apart), which fixes sigma*v^beta at that level but neither"
        " of the two; record at least two levels",
        confounded=confounded, slight=lambda e: e.ratio > NO_STEP,
    )  # fmt: skip


PARAMETERS: dict[str, tuple[Demand[Excitation], ...]] = {
    "k_nom": (_MOVES, _STROKE),
    "c_vis": (_MOVES, _SPEEDS),
    "T_d": (_MOVES, _FIELD, _STEPS),
    "sigma": (_MOVES, _FIELD, _levels(confounded=True)),
    "beta": (_MOVES, _FIELD, _levels(confounded=False)),
}
REQUIREMENTS: dict[Requirement, Demand[Survey]] = {
    Requirement.REVERSALS: Demand(
        "reversals of the motion", "1", 5, lambda s: s.reversals, lambda b: b.sine()
    ),
    Requirement.FIELD: Demand(
        "samples with a duty above zero", "1", ENOUGH, lambda s: s.field, lambda b: b.field
    ),
    Requirement.LEVELS: Demand(
        f"duty levels above zero, {100 * (SAME_LEVEL - 1):g} % apart", "1", 3,
        lambda s: s.levels, lambda b: b.levels,
    ),
    Requirement.STEPS: Demand(
        "change of the duty within a record", "1", 0.02, lambda s: s.steps, lambda b: b.steps
    ),
    Requirement.SPEEDS: Demand(
        "spread of the speed over its mean", "1", 0.01, lambda s: s.speeds, lambda b: b.sine()
    ),
    Requirement.STROKE: Demand(
        "range of the deflection", "m", 1e-6, lambda s: s.stroke, lambda b: b.sine()
    ),
    # With this even a mass that weighs as much as the whole force range makes but 0.1 % of that,
    # about the least that a bench resolves.
    Requirement.FREQUENCIES: Demand(
        "acceleration that no spring makes, rms", "m/s^2", 0.01,
        lambda s: s.acceleration, lambda b: b.sweep,
    ),
    Requirement.TEMPERATURE: Demand(
        "range of a column temperature", "degC", 2.0, lambda s: s.warming, lambda b: b.sine()
    ),
    Requirement.TIME: Demand(
        "length of the longest record", "s", 2.0, lambda s: s.longest,
        lambda b: b.sine(),
    ),
}  # fmt: skip


def parameters(survey: Survey) -> list[Cover]:
    """Whether the log can show each parameter of the paper's model, in their order."""
    bench = Bench.of(survey)
    out = []
    for direction in DIRECTIONS:
        excitation = survey.directions[direction]
        for symbol, demands in PARAMETERS.items():
            checks = tuple(d.check(excitation, bench) for d in demands)
            first = next((d for d, c in zip(demands, checks, strict=True) if not c.met), None)
            lack = (
                None
                if first is None
                else Lack(first.reason, first.confounded, first.slight(excitation))
            )
            out.append(Cover(f"{direction}.{symbol}", checks, lack))
    return out


def effects(survey: Survey, candidates: Iterable[Effect]) -> list[Cover]:
    """Whether the log can show each of some effects."""
    bench = Bench.of(survey)
    checks: dict[Requirement, Check] = {}
    out = []
    for effect in candidates:
        for r in effect.requires:
            if r not in checks:
                checks[r] = REQUIREMENTS[r].check(survey, bench)
        own = tuple(checks[r] for r in effect.requires)
        missing = [str(c) for c in own if not c.met]
        lack = Lack("; ".join(missing)) if missing else None
        out.append(Cover(effect.name, own, lack))
    return out


def unmet(recording: Recording) -> dict[str, Lack]:
    """Parameters of the paper's model that a log cannot identify, each with the reason."""
    return {c.name: c.lack for c in parameters(Survey.of(recording)) if c.lack is not None}


def untestable(survey: Survey, candidates: Sequence[Effect]) -> dict[str, str]:
    """Effects that a log cannot show, each with what is missing."""
    return {c.name: c.lack.reason for c in effects(survey, candidates) if c.lack is not None}


def held_values(needs: Mapping[str, Lack]) -> dict[str, float]:
    """Values for parameters that the data cannot identify, chosen so that the rest can be fitted.

    With one level of duty any beta will do, since sigma takes up the difference; without a field
    there is no yield force, and no lag of it; where the lag would show but slightly, a fit to that
    may run far from what a step of the duty would show.
    """
    return {
        name: 1.0 if name.endswith(".beta") else 0.0
        for name, need in needs.items()
        if not need.confounded
    }

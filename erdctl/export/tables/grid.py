"""At which speeds and duties a table is taken, and by which motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array
from erdctl.model.effect import Requirement
from erdctl.model.learned.law import LearnedEffect
from erdctl.model.parameters import Parameters

POINTS = 20  # speeds in each direction
MOST_POINTS = 500
LEVELS = 10  # steps of the duty over the range that was seen
# Where the parameters do not say on what they were identified; the duty is the paper's highest.
SPEED, STROKE, DUTY = 0.2, 0.02, 0.45
# What a damper can have: speeds [m/s] and amplitudes [m]. What is said beyond is no range.
SLOWEST, FASTEST = 1e-6, 100.0
SMALLEST, LARGEST = 1e-6, 1.0
COLDEST, HOTTEST = -100.0, 500.0  # degC, of any damper's fluid
BEYOND = 0.05  # as a simulation's remark: how far beyond a range is worth one


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What the user says of a table; None and () stand for what the provenance says.

    duty : levels [1];  speed : highest [m/s];  points : speeds in each direction
    amplitude : of the sines whose peaks are taken [m];  temperature : [degC], for laws of it
    extension : whether a damper property file counts extension as positive, as Adams Car does
    """

    duty: tuple[float, ...] = ()
    speed: float | None = None
    points: int = POINTS
    amplitude: float | None = None
    temperature: float | None = None
    extension: bool = True

    def __post_init__(self) -> None:
        for level in self.duty:
            if not 0.0 <= level <= 1.0:
                raise UsageProblem(f"--duty {level:g} is outside 0..1 (a fraction: 30 % is 0.3)")
        if self.speed is not None and not SLOWEST <= self.speed <= FASTEST:
            raise UsageProblem(f"--speed {self.speed:g}: expected {SLOWEST:g} to {FASTEST:g} m/s")
        if not 2 <= self.points <= MOST_POINTS:
            raise UsageProblem(f"--points {self.points}: expected 2 to {MOST_POINTS}")
        if self.amplitude is not None and not SMALLEST <= self.amplitude <= LARGEST:
            raise UsageProblem(
                f"--amplitude {self.amplitude:g}: expected {SMALLEST:g} to {LARGEST:g} m"
            )
        if self.temperature is not None and not COLDEST <= self.temperature <= HOTTEST:
            raise UsageProblem(
                f"--temperature {self.temperature:g}: expected {COLDEST:g} to {HOTTEST:g} degC"
            )


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid:
    """The places of a table.

    speed : (2 n,) with sign, rising, none at 0 [m/s];  duty : (m,) rising [1]
    centre, amplitude : of the sines whose peaks are taken [m]
    temperature : [degC], None where no law depends on it
    remarks : what was assumed, and where it goes beyond what was identified
    """

    speed: Array
    duty: Array
    centre: float
    amplitude: float
    temperature: float | None = None
    remarks: tuple[str, ...] = ()


def grid(parameters: Parameters, asked: Asked) -> Grid:
    """The places that are asked for, else those that the parameters were identified on.

    Speeds lie the closer the nearer they are to 0, where a damper's curve bends most:

        v_k = v_max (k / n)^2,  k = 1..n

    There is none at 0: the force jumps there (Eq. 18), and a spline of a vehicle program through a
    point on the jump can overshoot its ends.
    Check: 0.1 m/s and 2 points give -0.1, -0.025, 0.025 and 0.1 m/s.
    >>> from erdctl.model.composed import Model
    >>> nothing = Parameters(model=Model(), estimates={})
    >>> grid(nothing, Asked(speed=0.1, points=2)).speed.round(9).tolist()
    [-0.1, -0.025, 0.025, 0.1]
    """
    given = dict(parameters.provenance.get("ranges", {}))
    seen = {name: _within(given.get(name), *ends) for name, ends in POSSIBLE.items()}
    remarks: list[str] = []
    temperature = asked.temperature if _of_temperature(parameters) else None
    if temperature is None and _of_temperature(parameters):
        raise UsageProblem("the force depends on the temperature; --temperature says on which")
    fastest = _speeds(seen["xdot"], asked.speed, remarks)
    part = (np.arange(1, asked.points + 1) / asked.points) ** 2
    duty = _duties(seen["duty"], asked.duty, remarks)
    centre, amplitude = _stroke(seen["x"], asked.amplitude, remarks)
    speed = np.concatenate([-fastest[0] * part[::-1], fastest[1] * part])
    return Grid(
        speed=speed, duty=duty, centre=centre, amplitude=amplitude, temperature=temperature,
        remarks=tuple(remarks),
    )  # fmt: skip


def _of_temperature(parameters: Parameters) -> bool:
    """Whether a law is one of a temperature that logs have."""
    return any(
        Requirement.TEMPERATURE in e.requires
        or (isinstance(e, LearnedEffect) and any(a.kind.logged for a in e.law.curve.axes))
        for e in parameters.model.effects
    )


POSSIBLE = {"x": (-LARGEST, LARGEST), "xdot": (-FASTEST, FASTEST), "duty": (0.0, 1.0)}


def _within(ends: Sequence[float] | None, low: float, high: float) -> tuple[float, float] | None:
    """A range that can be; None for one that is not known, or that no damper has."""
    if ends is None or not low <= ends[0] <= ends[1] <= high:
        return None
    return float(ends[0]), float(ends[1])


def _speeds(
    seen: tuple[float, float] | None, asked: float | None, remarks: list[str]
) -> tuple[float, float]:
    """Highest speed of release and of compression [m/s]."""
    if seen is None or not (seen[0] <= -SLOWEST and seen[1] >= SLOWEST):
        if asked is None:
            remarks.append(
                "the parameters do not say which speeds they were identified on: the table goes"
                f" to {SPEED:g} m/s; --speed gives another"
            )
        return (asked or SPEED,) * 2
    if asked is None:
        return -seen[0], seen[1]
    if asked > (1.0 + BEYOND) * min(-seen[0], seen[1]):
        remarks.append(
            f"the table goes to {asked:.3g} m/s, but the parameters were identified on"
            f" {seen[0]:.3g}..{seen[1]:.3g} m/s"
        )
    return asked, asked


def _duties(seen: tuple[float, float] | None, asked: Sequence[float], remarks: list[str]) -> Array:
    if not asked:
        if seen is None:
            remarks.append(
                "the parameters do not say which duties they were identified on: the table goes"
                f" to {DUTY:g}; --duty gives others"
            )
        low, high = (0.0, DUTY) if seen is None else seen
        if low == high:
            return np.array([low])
        return np.linspace(low, high, LEVELS + 1).round(12)
    levels = np.unique(np.array(asked, dtype=float))
    if seen is not None:
        margin = BEYOND * (seen[1] - seen[0])
        if levels[0] < seen[0] - margin or levels[-1] > seen[1] + margin:
            remarks.append(
                f"duties of the table span {levels[0]:.3g}..{levels[-1]:.3g}, but the parameters"
                f" were identified on {seen[0]:.3g}..{seen[1]:.3g}"
            )
    return levels


def _stroke(
    seen: tuple[float, float] | None, asked: float | None, remarks: list[str]
) -> tuple[float, float]:
    """Centre and amplitude: half the way to the nearer end of what was seen, about 0 if it can."""
    known, (low, high) = seen is not None, seen or (-STROKE, STROKE)
    centre = 0.0 if low < 0.0 < high else 0.5 * (low + high)
    reach = min(centre - low, high - centre)
    if reach < 2.0 * SMALLEST:
        known, centre, reach = False, 0.5 * (low + high), STROKE
    if not known and asked is None:
        remarks.append(
            "the parameters do not say which stroke they were identified on: the sines of the"
            f" table have {0.5 * reach:g} m; --amplitude gives another"
        )
    if asked is not None and seen is not None and asked > (1.0 + BEYOND) * reach:
        remarks.append(
            f"the sines of the table have {asked:.3g} m, but the parameters were identified on"
            f" {low:.3g}..{high:.3g} m"
        )
    return centre, 0.5 * reach if asked is None else asked

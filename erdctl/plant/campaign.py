"""What the laboratory drove: records of motions and duty programmes, drawn without a look at the
damper's secret."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.plant.trajectory import Trajectory

Array = npt.NDArray[np.float64]
Random = np.random.Generator

RATES = (100.0, 200.0, 250.0, 400.0, 500.0, 800.0, 1000.0)  # Hz
RATE_SHARES = (0.08, 0.15, 0.2, 0.12, 0.2, 0.1, 0.15)
MOST_SAMPLES, LEAST_SAMPLES = 60_000, 15_000
LONGEST, SHORTEST = 60.0, 2.5  # s
PER_RECORD = 1500  # samples that a record needs for a few cycles


@dataclass(frozen=True)
class DutyProgramme:
    """Levels [1], each held from its first sample on."""

    levels: tuple[float, ...]
    starts: tuple[int, ...]

    def at(self, samples: int) -> Array:
        """(samples,) duty."""
        which = np.searchsorted(np.array(self.starts), np.arange(samples), side="right") - 1
        held: Array = np.array(self.levels)[which]
        return held


@dataclass(frozen=True)
class CampaignRecord:
    """One test."""

    name: str
    rate: float
    samples: int
    motion: Trajectory
    duty: DutyProgramme


@dataclass(frozen=True)
class Rating:
    """What damper and rig are built for: stroke to either side [m], speed [m/s]."""

    stroke: float
    speed: float


@dataclass(frozen=True)
class Campaign:
    """Records, and what they are drawn within.

    reach_x, reach_v : part of the rated stroke and speed that is used;  top : highest duty
    levels : duties of the constant and stepped records, the first one 0
    """

    rating: Rating
    rate: float
    low: float
    high: float
    reach_x: float
    reach_v: float
    top: float
    levels: tuple[float, ...]
    records: tuple[CampaignRecord, ...]


def draw_campaign(random: Random) -> Campaign:
    """A campaign of 6 to 24 records and 15,000 to 60,000 samples at 100 to 1000 Hz."""
    rate = float(random.choice(RATES, p=RATE_SHARES))
    least = max(LEAST_SAMPLES, 6 * SHORTEST * rate)
    samples = float(np.exp(random.uniform(np.log(least), np.log(MOST_SAMPLES))))
    fewest = max(6, int(np.ceil(samples / (LONGEST * rate))))
    most = int(min(24, samples / PER_RECORD, samples / (SHORTEST * rate)))
    count = int(random.integers(fewest, max(most, fewest) + 1))
    # Slow enough that a period has 50 samples or more, fast enough that inertia is felt.
    low = float(np.exp(random.uniform(np.log(0.1), np.log(0.4))))
    high = min(rate / random.uniform(50, 120), float(random.uniform(5.0, 12.0)))
    stroke = float(np.exp(random.uniform(np.log(0.008), np.log(0.06))))
    rating = Rating(stroke, 2 * np.pi * float(np.sqrt(low * high)) * stroke)
    return _fill(random, rating, rate, low, high, samples / count, count)


def draw_short(random: Random, *, samples: int = 8_000, count: int = 10) -> Campaign:
    """A campaign of few samples, for questions that need many draws and no long logs."""
    rate = float(random.choice((100.0, 200.0, 250.0)))
    mean = max(samples / count, SHORTEST * rate)
    low = max(float(np.exp(random.uniform(np.log(0.3), np.log(0.6)))), 2.0 * rate / mean)
    high = max(rate / random.uniform(50, 80), 2.0 * low)
    stroke = float(np.exp(random.uniform(np.log(0.008), np.log(0.06))))
    rating = Rating(stroke, 2 * np.pi * float(np.sqrt(low * high)) * stroke)
    return _fill(random, rating, rate, low, high, mean, count)


def draw_other(random: Random, campaign: Campaign, *, count: int = 6) -> Campaign:
    """Records of other motions and duties on the same rig, as long as those of the campaign, or a
    fault that sets in late and slow heat would not show in them."""
    mean = float(np.mean([r.samples for r in campaign.records]))
    like = campaign
    return _fill(random, like.rating, like.rate, like.low, like.high, mean, count)


def _fill(
    random: Random, rating: Rating, rate: float, low: float, high: float, mean: float, count: int
) -> Campaign:
    reach_x, reach_v = float(random.uniform(0.5, 1.0)), float(random.uniform(0.5, 1.0))
    top = float(random.uniform(0.35, 1.0))
    steps = int(random.integers(3, 6))
    levels = (0.0, *(round(top * (k + 1) / steps, 3) for k in range(steps)))
    # Whatever else is tested, there are a record without control, one with steps, and one in which
    # the duty jumps at random.
    programmes = ["null", "steps", "hold"]
    programmes += [str(p) for p in random.choice(PROGRAMMES, count - 3, p=SHARES)]
    random.shuffle(programmes)
    records = []
    for i, programme in enumerate(programmes):
        longest = min(LONGEST, 1.3 * mean / rate)
        duration = float(np.clip(mean / rate * random.uniform(0.7, 1.3), SHORTEST, longest))
        n = max(round(duration * rate), 300)
        motion = draw_motion(random, rating, n / rate, low, high, reach_x, reach_v)
        duty = _duty(random, programme, levels, top, n, rate)
        records.append(CampaignRecord(f"r{i + 1:02d}", rate, n, motion, duty))
    return Campaign(rating, rate, low, high, reach_x, reach_v, top, levels, tuple(records))


PROGRAMMES = ("null", "constant", "steps", "hold")
SHARES = (0.1, 0.45, 0.2, 0.25)
MOTIONS = ("sine", "random", "sweep", "triangle")
MOTION_SHARES = (0.45, 0.25, 0.15, 0.15)


def draw_motion(
    random: Random, rating: Rating, duration: float,
    low: float, high: float, reach_x: float, reach_v: float,
) -> Trajectory:  # fmt: skip
    """A motion of some duration [s] between two frequencies [Hz], within parts of the rating."""
    kind = str(random.choice(MOTIONS, p=MOTION_SHARES))
    most_x = reach_x * rating.stroke * float(random.uniform(0.4, 1.0))
    most_v = reach_v * rating.speed * float(random.uniform(0.4, 1.0))
    offset = rating.stroke * float(np.clip(random.normal(0.0, 0.05), -0.1, 0.1))
    phase = float(random.uniform(0, 2 * np.pi))
    low = min(max(low, 2.0 / duration), high)  # at least two periods
    f = float(np.exp(random.uniform(np.log(low), np.log(high))))
    ramp = float(random.uniform(0.1, 0.3)) / f if random.random() < 0.25 else 0.0
    if kind == "random":
        tones = int(random.integers(6, 16))
        fs = np.sort(np.exp(random.uniform(np.log(low), np.log(high), tones)))
        phases = random.uniform(0, 2 * np.pi, tones)
        unit = Trajectory(
            "tones", tuple((1 / fs).tolist()), tuple(fs.tolist()), tuple(phases.tolist())
        )
        x, v, _ = unit.at(0.0, 0.05 / high, int(duration * high / 0.05))
        scale = 1.0 / max(np.abs(x).max() / most_x, np.abs(v).max() / most_v)
        return Trajectory(
            "tones", tuple((scale / fs).tolist()), unit.frequencies, unit.phases, offset, 1.0, ramp
        )
    if kind == "sweep":
        f_1 = float(np.exp(random.uniform(np.log(max(low, 0.4 * high)), np.log(high))))
        amplitude = min(most_x, most_v / (2 * np.pi * f_1))
        first, last = (low, f_1) if random.random() < 0.5 else (f_1, low)
        return Trajectory("sweep", (amplitude,), (first, last), (phase,), offset, duration, ramp)
    amplitude = min(most_x, most_v / (2 * np.pi * f))
    shape = "tones" if kind == "sine" else "triangle"
    return Trajectory(shape, (amplitude,), (f,), (phase,), offset, 1.0, ramp)


def _duty(
    random: Random, programme: str, levels: tuple[float, ...], top: float, n: int, rate: float
) -> DutyProgramme:
    if programme == "null":
        return DutyProgramme((0.0,), (0,))
    if programme == "constant":
        return DutyProgramme((float(random.choice(levels[1:])),), (0,))
    hold = float(np.exp(random.uniform(np.log(0.15), np.log(1.5))))
    if programme == "steps":
        starts = np.arange(0, n, max(round(hold * rate), 2))
        first = int(random.integers(len(levels)))
        order = random.permutation(len(levels))
        chosen = [levels[order[(first + k) % len(levels)]] for k in range(len(starts))]
        return DutyProgramme(tuple(chosen), tuple(int(s) for s in starts))
    lengths = hold * random.uniform(0.4, 1.6, int(np.ceil(n / rate / hold)) * 2 + 4)
    edges = np.concatenate([[0], np.cumsum(np.maximum(np.round(lengths * rate), 2))])
    starts = edges[edges < n].astype(int)
    drawn = np.round(random.uniform(0.0, top, len(starts)), 3)
    return DutyProgramme(tuple(drawn.tolist()), tuple(int(s) for s in starts))

"""What an effect adds to the force of a real damper: on the motion and the duty of its own log.

    D = F(plain damper with the effect) - F(plain damper)

simulated in fine steps between the samples. The speed is a cubic spline through that of the log;
the deflection is its integral, held to that of the log by what changes slowly of their difference,
so that the noise of a deflection channel does not become motion. Before and after a record the
motion goes on as its mirror image. D is what an independent simulation of the effect gives; added
to a recording, it is an effect under that recording's own noise. What the damper of the log has by
all that is known (`also_with`) is in both simulations: behind a soft mount a friction adds another
force than before it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.ndimage import uniform_filter1d
from scipy.optimize import minimize
from scipy.signal import savgol_filter

from erdctl.plant.campaign import CampaignRecord, DutyProgramme
from erdctl.plant.channel import recorded
from erdctl.plant.hooks import Hooks
from erdctl.plant.own import Applied
from erdctl.plant.plant import ForceChannel, Plant, Side
from erdctl.plant.simulate import (
    LEAD_IN,
    LEAD_OUT,
    LEAST_SUBSTEPS,
    LONGEST_STEP,
    Ride,
    fine_grid,
    forces,
)
from erdctl.plant.trajectory import Trajectory
from erdctl.plant.twin import Scales, Twin

Array = npt.NDArray[np.float64]
Random = np.random.Generator

SLOW = 0.25  # s, over which the deflection holds the integral of the speed
BENT = 0.02  # s, over which the acceleration is the slope of the speed
NEAR = 0.05  # of the values of a law that a plant's effect is to have
FAR = 100.0  # times the largest force of the damper so far
NO_LAG = 1e-6  # s
FURTHER = 1e5  # times a shape's least and largest, as it is drawn, that a law may have
STILL = Trajectory("tones", (), (), ())  # in place of the closed form that a recording has not


@dataclass(frozen=True, eq=False)
class Logged:
    """One record of a log: (n,) time [s], deflection [m], speed [m/s] and duty [1]."""

    name: str
    t: Array
    x: Array
    xdot: Array
    duty: Array


@dataclass(frozen=True, eq=False)
class OnLog:
    """A plain damper on the records of a log, ready for effects.

    over : the records on the fine grid;  at : (n,) times of the log's samples, by record
    plain : forces of the plain damper at the samples of `over` [N]
    """

    base: Plant
    over: tuple[Ride, ...]
    at: tuple[Array, ...]
    plain: Array
    scales: Scales

    def added(self, twin: Twin, s: float, shape: Mapping[str, float]) -> Array:
        """(n,) force that an effect of a strength adds at the samples of the log [N]."""
        force = forces(twin.build(self.base, s, shape, self.scales), self.over) - self.plain
        ends = np.cumsum([r.record.samples for r in self.over])[:-1]
        return self._on_samples(np.split(force, ends))

    def with_effect(self, twin: Twin, s: float, shape: Mapping[str, float], force: Array) -> Array:
        """(n,) the force of the log (n,) as it would be with an effect of a strength [N].

        What a force channel does, it does to all that was recorded, to steps and noise that no
        damper here has as well; an average of the plain damper's force alone would leave them
        standing. All else adds its force.
        """
        channel = _channel(twin.build(self.base, s, shape, self.scales), self.base)
        if channel is None:
            return force + self.added(twin, s, shape)
        own = channel.own
        changed = []
        for r, t, f in zip(self.over, self.at, self._by_record(force), strict=True):
            fine = np.interp((np.arange(len(r.x)) - r.lead_in) * r.h, t, f)
            through = Applied(own, fine_grid(r, 0.0, 0.0)).recorded(fine) if own else fine
            grid = r.h, r.lead_in, r.substeps, r.record.samples
            changed.append(
                recorded(through, *grid, channel.channel) - recorded(fine, *grid, ForceChannel())
            )
        return force + self._on_samples(changed)

    def _by_record(self, values: Array) -> list[Array]:
        """Values (n,) at the samples of the log, by record."""
        return np.split(values, np.cumsum([len(t) for t in self.at])[:-1])

    def _on_samples(self, parts: Sequence[Array]) -> Array:
        """(n,) values at the samples of the log of what is given at even steps, by record."""
        return np.concatenate([
            np.interp(t, np.arange(r.record.samples) / r.record.rate, part)
            for t, r, part in zip(self.at, self.over, parts, strict=True)
        ])  # fmt: skip

    def also_with(self, twin: Twin, values: Mapping[str, float]) -> OnLog | None:
        """The stage with an effect in its damper whose law has some values, by their symbols.

        None where this effect's law is another one, never has such values, or gives with them a
        force that no log has.
        """
        plant = _with_law(self.base, twin, values, self.scales)
        if plant is None:
            return None
        plain = forces(plant, self.over)
        if not np.abs(plain).max() < FAR * np.abs(self.plain).max():
            return None
        return replace(self, base=plant, plain=plain, scales=_scales(self.over, plain))

    def parameters(self, twin: Twin, s: float, shape: Mapping[str, float]) -> dict[str, float]:
        """What a twin shows of itself at a strength, in SI units."""
        plant = twin.build(self.base, s, shape, self.scales)
        out = {}
        for path in twin.shows:
            part, name = path.split(".")
            if part == "own":
                own = next(dict(o.values) for o in plant.own if o.hooks.name == twin.name)
                out[name] = float(own[name])
            else:
                out[name] = float(getattr(getattr(plant, part), name))
        return out


def stage(records: Sequence[Logged], sides: Sequence[Mapping[str, float]]) -> OnLog:
    """A damper on a log.

    sides : k_nom, c_vis, T_d, sigma and beta in compression and in release
    """
    # A log without a step of its duty tells no lag; a damper has one, from which others are drawn.
    told = [{f: float(side[f]) for f in Side._fields} for side in sides]
    up, down = (Side(**{**side, "T_d": max(side["T_d"], NO_LAG)}) for side in told)
    base = Plant(up, down)
    over = tuple(_ride(r) for r in records)
    plain = forces(base, over)
    at = tuple(r.t - r.t[0] for r in records)
    return OnLog(base, over, at, plain, _scales(over, plain))


def _with_law(plant: Plant, twin: Twin, values: Mapping[str, float], by: Scales) -> Plant | None:
    """A plant with the effect whose law comes nearest to some values, if that is near."""
    law, names = twin.law, list(twin.shape)
    if law is None:
        return None
    # What is drawn to be hidden is one thing, what a log shows another: of all sizes.
    ratio = [twin.shape[n][0] > 0.0 for n in names]
    ends = [
        (math.log(a / FURTHER), math.log(b * FURTHER)) if r else (a, b)
        for r, (a, b) in zip(ratio, (twin.shape[n] for n in names), strict=True)
    ]

    def built(at: Array) -> Plant:
        own = [min(max(u, a), b) for u, (a, b) in zip(at[1:].tolist(), ends, strict=True)]
        shape = {n: math.exp(u) if r else u for n, u, r in zip(names, own, ratio, strict=True)}
        return twin.build(plant, math.exp(at[0]), shape, by)

    def off(at: Array) -> float:
        try:
            found = law(built(at))[1]
        except ArithmeticError:
            return 1e300  # shapes of which no number can be told are near none
        return max((abs(found.get(k, 0.0) / v - 1.0) for k, v in values.items() if v), default=0.0)

    # A shape may be a choice, as of a sign, which no simplex walks across: one from every corner.
    corners = product((0.05, 0.95), repeat=len(names))
    starts = [
        [math.log(twin.start), *(a + c * (b - a) for c, (a, b) in zip(at, ends, strict=True))]
        for at in corners
    ]
    best = min((minimize(off, s, method="Nelder-Mead") for s in starts), key=lambda m: m.fun)
    return built(best.x) if best.fun < NEAR else None


def _channel(plant: Plant, base: Plant) -> Plant | None:
    """Of two plants that differ in the force channel alone, one with what they differ by."""
    new = tuple(o for o in plant.own if o not in base.own)
    others = plant._replace(channel=base.channel, own=base.own)
    more = (replace(o.hooks, recorded=None) != Hooks(o.hooks.name) for o in new)
    if others != base or any(more):
        return None
    fields = zip(ForceChannel._fields, plant.channel, base.channel, strict=True)
    differ = {name: value for name, value, before in fields if value != before}
    return base._replace(channel=ForceChannel(**differ), own=new)


def _scales(over: Sequence[Ride], plain: Array) -> Scales:
    """Sizes of the log with its plain damper; its records may differ in rate."""
    x, v = (np.concatenate([r.sampled()[i] for r in over]) for i in (1, 2))
    ends = np.cumsum([r.record.samples for r in over])[:-1]
    power = np.split(np.maximum(plain * v, 0.0), ends)
    spans = [r.record.samples / r.record.rate for r in over]
    inside = [slice(r.lead_in, r.lead_in + r.record.samples * r.substeps) for r in over]
    return Scales(
        x=float(np.abs(x).max()),
        v=float(np.abs(v).max()),
        a=max(float(np.abs(r.a[at]).max()) for r, at in zip(over, inside, strict=True)),
        stroke=float(np.ptp(x)) / 2,
        force=float(np.ptp(plain)) / 2,
        duty=max(float(r.duty.max()) for r in over) or 1.0,
        shortest=min(spans),
        longest=max(spans),
        energy=max(float(p.sum()) / r.record.rate for p, r in zip(power, over, strict=True)),
        tick=max(r.h for r in over),
    )


def _ride(r: Logged) -> Ride:
    """A record on the fine grid."""
    t = r.t - r.t[0]
    dt = float(np.median(np.diff(t)))
    n = round(float(t[-1]) / dt) + 1
    even = dt * np.arange(n)
    substeps = max(LEAST_SUBSTEPS, math.ceil(dt / LONGEST_STEP))
    h = dt / substeps
    before, after = round(LEAD_IN / h), round(LEAD_OUT / h)
    fine = h * np.arange((n - 1) * substeps + 1)
    speed = CubicSpline(t, r.xdot)
    v = speed(fine)
    path = speed.antiderivative()
    slow = uniform_filter1d(np.interp(even, t, r.x - path(t)), max(round(SLOW / dt), 1))
    x = path(fine) + CubicSpline(even, slow)(fine)
    wide = max(2 * round(0.5 * BENT / h) + 1, 5)
    a = savgol_filter(v, min(wide, 2 * ((len(v) - 1) // 2) - 1), 2, deriv=1, delta=h)
    duty = r.duty[np.maximum(np.searchsorted(t, even + 0.5 * dt, side="right") - 1, 0)]
    record = CampaignRecord(r.name, 1.0 / dt, n, STILL, DutyProgramme((0.0,), (0,)))
    return Ride(
        record, substeps, before, h, _mirrored(x, before, after, odd=True),
        _mirrored(v, before, after, odd=False), _mirrored(a, before, after, odd=True), duty,
    )  # fmt: skip


def _mirrored(values: Array, before: int, after: int, *, odd: bool) -> Array:
    """Values that go on before and after as their mirror image; `odd` turns that about its end."""
    if odd:
        return np.pad(values, (before, after), mode="reflect", reflect_type="odd")
    return np.pad(values, (before, after), mode="reflect", reflect_type="even")

"""What a page's figures are drawn from: thinned samples, binned misfits, as compact JSON."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose.residual.localisation import UNITS
from erdctl.model.effect import Variable
from erdctl.report import style
from erdctl.report.page.thin import keep, lines, reversals
from erdctl.score.nrmse import MAX_LEVELS, duty_levels

SAMPLES = 40_000  # samples that a page holds: more lie on top of each other, and are slow to zoom
RECORDS = 200  # that can be chosen from one by one
CELLS = 25  # of velocity in the misfit map; odd, so that one lies around reversal
BINS = 60  # of a profile
LOOSE = 0.02  # change of a duty within a record that still counts as held

Json = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Levels:
    """The PWM levels of a log.

    duty : (l,) ascending [1];  at : (n,) number of the level of each sample
    """

    duty: Array
    at: Index

    @classmethod
    def of(cls, recording: Recording) -> Levels:
        """As scores are split."""
        codes, duty = duty_levels(recording.duty)
        return cls(duty, codes.astype(np.intp))

    @property
    def names(self) -> list[str]:
        """As engineers say them."""
        return [percent(d) for d in self.duty.tolist()]


def percent(duty: float) -> str:
    """A duty in per cent."""
    return f"{100 * duty:.3g} %"


def encoded(values: npt.ArrayLike, kind: str = "f4") -> Json:
    """An array as base64 of little-endian numbers; a tenth of the time of JSON to read."""
    return {kind: b64encode(np.ascontiguousarray(values, dtype=f"<{kind}").tobytes()).decode()}


def samples(recording: Recording, levels: Levels, models: Mapping[str, Array]) -> Json:
    """Thinned samples for loops, in mm, mm/s and N; `models` are modelled forces (n,) by name."""
    r = recording
    assert r.force is not None
    misfits = [r.force - model for model in models.values()]
    rows = keep([r.x, r.xdot, r.force, *misfits], SAMPLES, reversals(r.xdot))
    record = np.searchsorted(r.starts, rows, side="right") - 1
    joined = lines(rows, t=r.t, xdot=r.xdot, level=levels.at, starts=r.starts)
    columns = {"t": r.t, "x": 1e3 * r.x, "xdot": 1e3 * r.xdot, "force": r.force, **models}
    return {
        "of": len(r),
        "count": len(rows),
        "columns": {name: encoded(values[rows]) for name, values in columns.items()},
        "level": encoded(levels.at[rows], "u1"),
        "record": encoded(record, "u4"),
        "joined": encoded(joined, "u1"),
        "models": list(models),
        "levels": levels.names,
        "colours": level_colours(len(levels.duty)),
        "choices": _choices(r, levels, misfits[0]),
    }


def level_colours(count: int) -> Json:
    """The colours of so many PWM levels as pictures have them, and lighter ones on dark paper."""
    found = style.shades(count)
    return {
        "light": [style.hexadecimal(c) for c in found],
        "dark": [style.hexadecimal(style.on_dark(c)) for c in found],
    }


def _choices(r: Recording, levels: Levels, misfit: Array) -> list[Json]:
    """What may be drawn by itself: one record per level, all, and records, the worst first."""
    whole: Json = {"name": f"all {len(r.names)} records", "records": None}
    if len(r.names) == 1:
        return [whole | {"name": f"the whole log ({r.names[0]})"}]
    count = np.diff(r.starts)
    rms = np.sqrt(np.add.reduceat(misfit**2, r.starts[:-1]) / count)
    out = [whole]
    typical = _typical(r, levels)
    if len(typical) > 1:
        out.insert(0, {"name": "one record for each PWM level that is held", "records": typical})
    worst = np.argsort(-rms, kind="stable")[:RECORDS].tolist()
    return out + [{"name": f"{r.names[i]}: {rms[i]:.3g} N rms", "records": [i]} for i in worst]


def _typical(r: Recording, levels: Levels) -> list[int]:
    """For each level held through a record, the one whose speed is nearest to all of these."""
    first = r.starts[:-1]
    held = np.maximum.reduceat(r.duty, first) - np.minimum.reduceat(r.duty, first) < LOOSE
    speed = np.sqrt(np.add.reduceat(r.xdot**2, first) / np.diff(r.starts))
    if not held.any():
        return []
    middle = np.sort(speed[held])[held.sum() // 2]
    level = levels.at[first]
    out = []
    for i in range(len(levels.duty)):
        ours = np.flatnonzero(held & (level == i))
        if len(ours):
            out.append(int(ours[np.argmin(np.abs(speed[ours] - middle))]))
    return out


def misfit_maps(
    recording: Recording, levels: Levels, misfits: Mapping[str, Array], noise: float | None
) -> dict[str, Json]:
    """Root mean square misfit [N] over velocity and duty level, on one scale for all.

    misfits : (n,) by name, NaN where a sample has weight zero, the same samples in each
    """
    v = 1e3 * recording.xdot
    top = float(np.abs(v).max()) or 1.0
    edges = np.linspace(-top, top, CELLS + 1)
    column = np.clip(((v + top) / (2 * top) * CELLS).astype(np.intp), 0, CELLS - 1)
    cell = levels.at * CELLS + column
    shape = (len(levels.duty), CELLS)
    use = np.isfinite(next(iter(misfits.values())))
    cell = cell[use]
    count = np.bincount(cell, minlength=shape[0] * shape[1])
    out: dict[str, Json] = {}
    tops = [3 * (noise or 0.0)]  # nothing but noise should look calm
    for name, misfit in misfits.items():
        square = np.bincount(cell, misfit[use] ** 2, minlength=len(count))
        rms = np.sqrt(square / np.maximum(count, 1)).reshape(shape)
        tops.append(float(rms.max()))
        out[name] = {
            "kind": "map",
            "colours": list(style.HEAT),
            "x": {"label": "Velocity", "unit": "mm/s", "edges": edges.tolist()},
            "y": {"label": "PWM level", "unit": "", "names": levels.names},
            "value": {"label": "RMS misfit", "unit": "N"},
            "values": [[float(f"{x:.4g}") for x in row] for row in rms.tolist()],
            "counts": count.reshape(shape).tolist(),
            "noise": noise,
        }
    return {name: m | {"most": max(tops)} for name, m in out.items()}


def profile(
    variable: Variable,
    values: Array,
    misfits: Mapping[str, Array],
    *,
    noise: float | None,
    region: tuple[float, float, str] | None = None,
) -> Json:
    """Root mean square misfit [N] along one variable, in bins of equal time.

    values : (n,) in SI units, not finite where there is none
    misfits : (n,) by name, NaN where a sample has weight zero;  region : low, high [SI], words
    """
    scale, unit = UNITS[variable]
    label, logarithmic = LABELS[variable]
    use = np.isfinite(values) & np.isfinite(next(iter(misfits.values())))
    use &= (values > 0) | (not logarithmic)
    v = values[use] * scale
    edges = _edges(v)
    at = np.clip(np.searchsorted(edges, v, side="right") - 1, 0, len(edges) - 2)
    count = np.bincount(at, minlength=len(edges) - 1)
    filled = np.repeat(count > 0, 2)
    corners = np.repeat(edges, 2)[1:-1][filled]
    series = []
    for name, misfit in misfits.items():
        mean = np.bincount(at, misfit[use] ** 2, minlength=len(count)) / np.maximum(count, 1)
        steps = np.repeat(np.sqrt(mean), 2)[filled]
        series.append({"name": name, "style": "line", "y": encoded(steps)})
    bands = [] if region is None else [
        {"low": region[0] * scale, "high": region[1] * scale, "text": region[2]}
    ]  # fmt: skip
    marks = [] if noise is None else [{"value": noise, "text": f"noise {noise:.3g} N"}]
    return {
        "kind": "lines",
        "x": {"label": label, "unit": unit, "log": logarithmic, "values": encoded(corners)},
        "y": {"label": "RMS misfit", "unit": "N", "zero": True},
        "series": series, "bands": bands, "marks": marks,
    }  # fmt: skip


def _edges(v: Array) -> Array:
    """Bins of equal time, or one around each of a few levels.

    From at most about 200,000 samples: a quantile of ten million costs a second.
    """
    some = v[:: max(1, len(v) // 200_000)]
    found = np.unique(np.round(some, 9))  # 30 % is not always 100 times 0.3
    if len(found) <= MAX_LEVELS:
        half = np.diff(found, prepend=found[0] - 1.0, append=found[-1] + 1.0) / 2
        half[[0, -1]] = half[1:-1].min() if len(found) > 1 else 0.5
        return np.concatenate([found - half[:-1], found[-1:] + half[-1]])
    edges = np.unique(np.quantile(some, np.linspace(0, 1, BINS + 1)))
    edges[[0, -1]] = v.min(), v.max()
    return edges


LABELS = {
    Variable.XDOT: ("Velocity", False),
    Variable.X: ("Deflection", False),
    Variable.DUTY: ("Duty", False),
    Variable.TIME: ("Time in the record", False),
    Variable.SINCE_REVERSAL: ("Time since reversal", True),
    Variable.SINCE_DUTY_STEP: ("Time since duty step", True),
    Variable.ENERGY: ("Dissipated energy", False),
}


def loops(x: str, model: str | None, link: str) -> Json:
    """Force over deflection or velocity, from the page's samples."""
    axes = {
        "x": {"column": "x", "label": "Deflection", "unit": "mm"},
        "xdot": {"column": "xdot", "label": "Velocity", "unit": "mm/s"},
    }
    return {
        "kind": "loops",
        "x": axes[x],
        "y": {"column": "force", "label": "Force", "unit": "N"},
        "model": model,
        "link": link,
    }


def traces(
    t: Array,
    columns: Sequence[tuple[str, Array]],
    *,
    label: str,
    unit: str,
    link: str,
    bands: Sequence[Json] = (),
    marks: Sequence[Json] = (),
    zero: bool = False,
) -> Json:
    """Signals over time, thinned without losing their extremes."""
    rows = keep([values for _, values in columns], SAMPLES // 4)
    return {
        "kind": "lines",
        "x": {"label": "Time", "unit": "s", "values": encoded(t[rows])},
        "y": {"label": label, "unit": unit, "zero": zero},
        "series": [
            {"name": name, "style": "line", "y": encoded(values[rows])} for name, values in columns
        ],
        "bands": list(bands),
        "marks": list(marks),
        "link": link,
    }

"""One parameter over time: constant, a step, a ramp since a date, or a line; rate and forecast."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from erdctl.compare.history import YEAR, Series
from erdctl.compare.robust import BEND, Data, fit
from erdctl.compare.scan import Scan, appears, scan
from erdctl.compare.scatter import least, spread
from erdctl.compare.shape import Course, bend_edges, bends, columns, step_edges
from erdctl.core.recording import Array

FEWEST = 8  # logs with a value that a trend can be seen in
LEAST_NAMED = 3  # logs that name an effect, of many that do not
# Loss within which a date is as good as the best: of a parabola 3.84 would hold 95 %; the loss over
# the date of a bend has several dips, and of 60 drawn ramps 3.84 held 90, 6 held 95 %.
AS_GOOD = 6.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Trend:
    """How one parameter of one damper went.

    form : the simplest one that the logs allow;  scan : the test that it changes at all
    since : (date, first and last one by the logs at 95 %) of a step or a ramp [days since 1970]
    start, now : value and standard error at the first and the last date
    rate : change a year and its standard error, of a line or a ramp
    spread : of one log around the form [unit], median
    absent_before, absent_after : whether the effect was not there before, or is not any more
    fitted : (n,) the form at the dates of the logs
    """

    series: Series
    form: Course
    scan: Scan
    start: tuple[float, float]
    now: tuple[float, float]
    spread: float
    fitted: Array
    since: tuple[float, float, float] | None = None
    rate: tuple[float, float] | None = None
    absent_before: bool = False
    absent_after: bool = False
    model: _Fitted

    @property
    def changed(self) -> bool:
        """Whether it is no constant."""
        return self.form is not Course.CONSTANT

    @property
    def size(self) -> float:
        """Change from the first to the last date, in spreads of one log."""
        return abs(self.now[0] - self.start[0]) / self.spread if self.changed else 0.0

    def at(self, t: Array) -> tuple[Array, Array]:
        """Value (m,) and its standard error (m,) at any dates, also to come."""
        return self.model.at(t)

    def band(self, t: Array) -> tuple[Array, Array]:
        """Ends (m,) within which 95 % of single logs lie at these dates, if all goes on so."""
        f, error = self.at(t)
        half = 1.96 * np.hypot(error, self.spread)
        return f - half, f + half

    @property
    def ahead(self) -> float:
        """Days of a forecast: a year, or a quarter of the time that the logs span."""
        return float(min(YEAR, 0.25 * (self.series.t[-1] - self.series.t[0])))


@dataclass(frozen=True, eq=False, kw_only=True)
class _Fitted:
    """One form with its numbers.

    level : whether the value before is free; else it is `fixed`, the value of an absent effect
    coefficients : (k,), level first;  covariance : (k', k') of them, and of the date of a change
    """

    form: Course
    since: float
    fixed: float
    level: bool
    t0: float
    coefficients: Array
    loss: float
    covariance: Array
    interval: tuple[float, float]

    def design(self, t: Array) -> Array:
        """(n, k)"""
        begin = np.concatenate([[self.t0], t])
        grows = columns(self.form, begin, self.since)[1:]
        return np.hstack([np.ones((len(t), int(self.level))), grows])

    def gradient(self, t: Array) -> Array:
        """(n, k') of the value by the coefficients, and by the date of a bend [days]."""
        x = self.design(t)
        if self.form is not Course.RAMP:
            return x
        moved = -self.coefficients[-1] / YEAR * (t > self.since)
        return np.hstack([x, moved[:, None]])

    def at(self, t: Array) -> tuple[Array, Array]:
        """Value (n,) and standard error (n,)."""
        g = self.gradient(t)
        var = np.einsum("ni,ij,nj->n", g, self.covariance, g)
        f = self.fixed + self.design(t) @ self.coefficients
        return f, np.sqrt(np.maximum(var, 0.0))


def trend(series: Series, p_most: float) -> Trend | None:
    """The trend of a series; None where too few logs tell it, or none has a date.

    p_most : chance of a change where there is none, beyond which none is told
    """
    named = series.named
    if not np.isfinite(series.t).all() or named.sum() < (FEWEST if named.all() else LEAST_NAMED):
        return None
    if len(series) < FEWEST or series.t[0] == series.t[-1]:
        return None
    data = _data(series)
    found = _scan(series, data)
    forms = list(Course) if found.p <= p_most else [Course.CONSTANT]
    return _described(series, data, found, forms)


def _data(series: Series) -> Data:
    """The series with what is known of logs that do not name the effect."""
    named, v = series.named, series.value
    off = series.off or 0.0
    floor = least(v[named])
    s = np.empty(len(v))
    s[named] = spread(v[named], series.error[named], floor)
    if named.all():
        ends = np.full(len(v), np.nan)
        return Data(t=series.t, value=v, spread=s, named=named, low=ends, high=ends)
    s[~named] = np.median(s[named])
    known = series.limit if len(series.limit) else np.full(len(v), np.nan)
    size = np.where(np.isfinite(known), np.abs(known - off), _missed(np.abs(v - off)))
    return Data(
        t=series.t, value=np.where(named, v, off), spread=s, named=named, low=off - size,
        high=off + size,
    )  # fmt: skip


def _missed(size: Array) -> float:
    """From which size about an effect is named, where no log says it.

    size : (n,) NaN where it is not named
    The smallest that is named; or what logs between others that name it have missed, nine in ten.
    Check: named at 2 and 4, and missed between them, it may have been 3 there.
    >>> _missed(np.array([np.nan, 2.0, np.nan, 4.0]))
    3.0
    """
    named = np.flatnonzero(np.isfinite(size))
    between = np.arange(named[0], named[-1])
    between = between[np.isnan(size[between])]
    missed = np.interp(between, named, size[named])
    most = float(np.quantile(missed, 0.9)) if len(missed) else 0.0
    return max(float(size[named].min()), most)


def _scan(series: Series, data: Data) -> Scan:
    """The values where all logs have one; else also how often there is one."""
    named = data.named
    by_value = Scan(0.0, 1.0)
    if named.sum() >= FEWEST:
        by_value = scan(series.t[named], data.value[named], data.spread[named])
    if named.all():
        return by_value
    p = min(1.0, 2.0 * min(appears(named), by_value.p))
    return Scan(max(by_value.statistic, float(stats.norm.isf(max(p, 1e-300) / 2))), p)


def _described(series: Series, data: Data, found: Scan, forms: list[Course]) -> Trend:
    best = _best(data, forms, series.off)
    data = _respread(data, best.at(data.t)[0])
    best = _best(data, forms, series.off)
    data = _respread(data, best.at(data.t)[0])
    best = _finer(data, best)
    best = _with_errors(data, best, _shared(data, best.at(data.t)[0], series.error))
    f, _ = best.at(data.t)
    ends, errors = best.at(data.t[[0, -1]])
    since = None
    if best.form in (Course.STEP, Course.RAMP):
        since = (best.since, *best.interval)
    rate = None
    if best.form in (Course.LINEAR, Course.RAMP):
        k = len(best.coefficients) - 1
        rate = (float(best.coefficients[k]), float(np.sqrt(best.covariance[k, k])))
    absent = [False, False]
    if series.off is not None and not data.named.all() and since is not None:
        before = data.t <= best.since
        absent[0] = bool(before.any() and not data.named[before].mean() > 0.5)
        absent[1] = bool((~before).any() and not data.named[~before].mean() > 0.5)
    return Trend(
        series=series, form=best.form, scan=found, start=(float(ends[0]), float(errors[0])),
        now=(float(ends[1]), float(errors[1])), spread=float(np.median(data.spread[data.named])),
        fitted=f, since=since, rate=rate, absent_before=absent[0], absent_after=absent[1],
        model=best,
    )  # fmt: skip


def _respread(data: Data, f: Array) -> Data:
    """The spread from what a form leaves: that of single logs, or what their errors say."""
    rest = np.where(data.named, data.value - f, 0.0)[data.named] / data.spread[data.named]
    # Half of all normal values lie within 0.6745 standard deviations.
    ratio = float(np.median(np.abs(rest))) / 0.6745 if len(rest) > 2 else 1.0
    ratio = float(np.clip(ratio, 0.5, 2.0))
    return replace(data, spread=np.maximum(data.spread * ratio, least(data.value)))


def _best(data: Data, forms: list[Course], off: float | None) -> _Fitted:
    """By BIC: twice the log-likelihood against log(n) for each number, the date included."""
    found = []
    for form in forms:
        for fixed in [None] if off is None or data.named.all() else [None, off]:
            one = _fitted(data, form, fixed)
            if one is not None:
                numbers = len(one.coefficients) + (form in (Course.STEP, Course.RAMP))
                found.append((one.loss + numbers * np.log(len(data)), one))
    return min(found, key=lambda f: f[0])[1]


def _finer(data: Data, found: _Fitted) -> _Fitted:
    """The same form with its last digits: a bend also between two logs."""
    places = None
    if found.form is Course.RAMP:
        places = bends(data.t, *found.interval)
    again = _fitted(data, found.form, None if found.level else found.fixed, places)
    return found if again is None else again


def _fitted(
    data: Data, form: Course, fixed: float | None, places: Array | None = None
) -> _Fitted | None:
    """The best date of one form out of some places, and all dates that are about as good."""
    t = data.t
    if places is None:
        places = t[:1]
        if form in (Course.STEP, Course.RAMP):
            places = step_edges(t) if form is Course.STEP else bend_edges(t)
    if not len(places) or (fixed is not None and form is Course.LINEAR):
        return None
    level = fixed is None
    ones = np.ones((len(t), int(level)))
    models = np.array([np.hstack([ones, columns(form, t, at)]) for at in places.tolist()])
    coefficients, loss = fit(data, models, fixed or 0.0)
    if level and form in (Course.STEP, Course.RAMP):
        # A level at which hardly a log names the effect is told by none: it is absent there.
        before = np.array([data.named[t <= at].mean() for at in places.tolist()])
        loss = np.where(before < 0.5, np.inf, loss)
    i = int(loss.argmin())
    if not np.isfinite(loss[i]):
        return None
    near = np.flatnonzero(loss <= loss[i] + AS_GOOD)
    first, last = float(places[near[0]]), float(places[near[-1]])
    if form is Course.STEP:
        first, last = float(t[t < first].max()), float(t[t > last].min())
    k = coefficients.shape[1] + (form is Course.RAMP)
    return _Fitted(
        form=form, since=float(places[i]), fixed=fixed or 0.0, level=level, t0=float(t[0]),
        coefficients=coefficients[i], loss=float(loss[i]), covariance=np.zeros((k, k)),
        interval=(first, last),
    )  # fmt: skip


def _shared(data: Data, f: Array, error: Array) -> float:
    """What all logs may err by alike: their own errors, of which less than half shows as scatter.

    error : (n,) standard errors of the logs, NaN where none is known
    A play that falls between samples is off the same way in every log of the same drive.
    """
    known = data.named & np.isfinite(error)
    if known.sum() < FEWEST:
        return 0.0
    scatter = float(np.median(np.abs(data.value - f)[known])) / 0.6745
    own = float(np.median(error[known]))
    return float(np.sqrt(own**2 - scatter**2)) if own > 2.0 * scatter else 0.0


def _with_errors(data: Data, found: _Fitted, shared: float) -> _Fitted:
    """With the covariance of its numbers, from the logs that have a value.

    shared : standard error that the values of all logs have in common, as a level where that is
        free, and of what has grown at the last of them
    """
    g = found.gradient(data.t)[data.named]
    if not g.shape[1]:
        return found
    s, y = data.spread[data.named], data.value[data.named]
    z = np.abs(y - found.at(data.t)[0][data.named]) / s
    # Outliers tell nothing more of the slope beyond the bend of the loss (Huber's covariance).
    psi, flat = np.minimum(z, BEND), z < BEND
    dof = max(len(y) - g.shape[1], 1)
    factor = float((psi**2).sum() / dof) / max(float(flat.mean()), 0.5) ** 2
    information = (g / s[:, None]).T @ (g / s[:, None])
    scale = np.sqrt(np.maximum(np.diag(information), np.finfo(float).tiny))
    inverse = np.linalg.pinv(information / np.outer(scale, scale)) / np.outer(scale, scale)
    covariance = factor * inverse
    if found.level:
        covariance[0, 0] += shared**2
    if len(found.coefficients) > found.level:
        grown = found.design(data.t[data.named])[-1, -1]
        covariance[int(found.level), int(found.level)] += (shared / grown) ** 2 if grown else 0.0
    return replace(found, covariance=covariance)

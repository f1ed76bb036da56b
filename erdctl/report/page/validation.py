"""The page of a validation: does the model hold at every PWM level, and if not, where."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import TypeVar

from erdctl.core.messages import counted
from erdctl.core.recording import Array, Recording
from erdctl.model.effect import Variable
from erdctl.report.page import data
from erdctl.report.page.data import Json, Levels
from erdctl.report.page.render import Run, digits, render
from erdctl.report.page.words import extent, joined, logs_text, peak_of
from erdctl.report.readable import percent_of, with_unit
from erdctl.score.nrmse import Score, Validation

K = TypeVar("K")
AT_NOISE = 0.45  # misfit over noise up to which an error counts as noise, itself known to a tenth


def validation_page(
    found: Validation,
    recording: Recording,
    modelled: Array,
    *,
    noise: float | None,
    limit: float | None,
    run: Run,
    rig: Sequence[str] = (),
) -> str:
    """The page.

    modelled : (n,) [N];  noise : of the force of this recording [N], where known
    limit : highest NRMSE that a PWM level may have, where one was asked for
    rig : what is wrong with the recording, a line each
    """
    assert recording.force is not None
    levels = Levels.of(recording)
    misfit = recording.force - modelled
    samples = data.samples(recording, levels, {"model": modelled})
    samples["words"] = {"measured": "measured", "modelled": "model"}
    misfits = {"model": misfit}
    figures = {
        "loop-xdot": {**data.loops("xdot", "model", "loop-xdot"), "title": "Force–velocity"},
        "loop-x": {**data.loops("x", "model", "loop-x"), "title": "Force–deflection"},
        "map": {
            **data.misfit_maps(recording, levels, misfits, noise)["model"],
            "title": "Misfit over velocity and PWM level",
        },
    }
    for variable, values in ((Variable.XDOT, recording.xdot), (Variable.X, recording.x)):
        title = f"Misfit over {data.LABELS[variable][0].lower()}"
        profile = data.profile(variable, values, misfits, noise=noise)
        figures[f"profile-{variable.value}"] = {**profile, "title": title}
    over = _over(found, noise, limit)
    return render(
        "validation.html",
        title=f"Validation on {logs_text(recording)}",
        run=run,
        figures=figures,
        samples=samples,
        logs=logs_text(recording),
        extent=extent(recording, len(levels.duty)),
        **_answers(found, over, noise, limit, peak_of(recording.force)),
        levels=_levels(found, noise, limit),
        rig=[*rig],
        tables=_tables(found, peak_of(recording.force)),
    )


def _over(found: Validation, noise: float | None, limit: float | None) -> list[str] | None:
    """PWM levels above the limit, or above the noise; None where neither is known."""
    if limit is not None:
        return [data.percent(d) for d, s in found.by_duty.items() if s.nrmse > limit]
    if noise:
        most = noise * sqrt(1.0 + AT_NOISE**2)
        return [data.percent(d) for d, s in found.by_duty.items() if s.rms > most]
    return None


def _answers(
    found: Validation,
    over: list[str] | None,
    noise: float | None,
    limit: float | None,
    peak: float,
) -> Json:
    whole = found.overall
    bar = f"the limit of {limit:g}" if limit is not None else "the noise"
    if over is None:
        mood, head = "mid", f"The model misses {digits(whole.rms, 3)} N rms of the measured force."
        holds = "Neither a limit (--fail-above) nor the noise of the force is known, so you decide."
    elif over:
        mood, head = "bad", f"The model does not hold: its error is above {bar} at {joined(over)}."
        are = "is" if len(over) == 1 else "are"
        holds = f"No: {len(over)} of {counted(len(found.by_duty), 'PWM level')} {are} above {bar}."
    else:
        mood = "good"
        head = f"The model holds: its error is within {bar} at every PWM level."
        levels = len(found.by_duty)
        holds = f"Yes: {f'all {levels} PWM levels are' if levels > 1 else 'it is'} within {bar}."
    compared = ""
    if noise:
        compared = f"; {whole.rms / noise:.2f} × the noise of the force, {digits(noise, 3)} N"
    duty, level = _worst(found.by_duty)
    side, direction = _worst(found.by_direction) if found.by_direction else ("", whole)
    where = f"At {data.percent(duty)} PWM: NRMSE {level.nrmse:.4f}"
    if side:
        where += f"; in {side}: {direction.nrmse:.4f}"
    if len(found.by_record) > 1:
        name, record = _worst(found.by_record)
        where += f"; in record {name}: {record.nrmse:.4f}"
    return {
        "mood": mood,
        "head": head,
        "holds": holds,
        "where": f"{where}.",
        "nrmse": f"{whole.nrmse:.4f}",
        "normalise": found.normalise.words,
        "rms": f"{with_unit(whole.rms, 'N', 3)} rms ({percent_of(whole.rms, peak)})",
        "words": f"per cent of the peak force of {with_unit(peak, 'N', 3)}{compared}.",
    }


def _worst(scores: Mapping[K, Score]) -> tuple[K, Score]:
    return max(scores.items(), key=lambda item: item[1].nrmse)


def _levels(found: Validation, noise: float | None, limit: float | None) -> Json:
    rows: list[Json] = []
    for duty, s in found.by_duty.items():
        mark: float | None = limit
        if limit is None and noise is not None and s.rms > 0.0:
            mark = s.nrmse * noise / s.rms
        rows.append({"label": data.percent(duty), "before": 0.0, "after": s.nrmse, "noise": mark})
    most = max([v for row in rows for v in (row["after"], row["noise"]) if v], default=1.0)
    meaning = "limit" if limit is not None else "noise" if noise is not None else ""
    return {"rows": rows, "most": most, "mark": meaning}


def _tables(found: Validation, peak: float) -> list[Json]:
    header = ["samples", "RMSE [N]", "NRMSE", f"of {with_unit(peak, 'N', 3)} peak"]

    def rows(scores: Mapping[str, Score]) -> list[list[str]]:
        return [
            [k, str(s.samples), digits(s.rms), f"{s.nrmse:.4f}", percent_of(s.rms, peak)]
            for k, s in scores.items()
        ]

    levels = {data.percent(d): s for d, s in found.by_duty.items()} | {"all": found.overall}
    out = [
        {"caption": "Per PWM level", "header": ["PWM level", *header], "rows": rows(levels)},
        {
            "caption": "Per direction",
            "header": ["direction", *header],
            "rows": rows(found.by_direction),
        },
    ]
    if len(found.by_record) > 1:
        worst = dict(sorted(found.by_record.items(), key=lambda item: -item[1].nrmse))
        named = {"caption": "Per record, the worst first", "header": ["record", *header]}
        out.append({**named, "rows": rows(worst)})
    return out

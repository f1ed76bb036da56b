"""The page of a PWM sequence: the duty to push, the force to expect, and what is out of reach."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.mimic import Plan
from erdctl.mimic.outcome import Flags, Reach
from erdctl.report.page import data
from erdctl.report.page.data import Json, Levels
from erdctl.report.page.render import Run, digits, render
from erdctl.report.page.words import extent, logs_text

STRETCHES = 2000  # drawn at most: shorter gaps between them are closed
REACHED = 0.001  # part of the time out of reach that is a matter of a few samples


def mimic_page(
    plans: Mapping[str, Plan], recording: Recording, healthy: Array, *, static: bool, run: Run
) -> str:
    """The page.

    plans : of the dampers that mimic a fault;  healthy : (n,) duty of a healthy damper
    static : the paper's inverse was written in place of the compensated sequence
    """
    levels = Levels.of(recording)
    channel, first = next(iter(plans.items()))
    expected = {k: p.expected_paper if static else p.expected for k, p in plans.items()}
    ideal = replace(recording, force=first.ideal.copy())
    samples = data.samples(ideal, levels, {"expected": expected[channel]})
    samples["words"] = {"measured": "ideal faulty force", "modelled": "expected force"}
    figures: dict[str, Json] = {}
    clock = _clock(recording)
    for name, plan in plans.items():
        duty = plan.duty_paper if static else plan.duty
        bands = _bands(recording, clock, plan)
        link = f"time-{name}"
        figures[f"duty-{name}"] = {
            **data.traces(
                clock, [("healthy", 100 * healthy), ("to push", 100 * duty)],
                label="Duty", unit="%", zero=True, link=link, bands=bands,
            ),
            "title": f"Duty, damper {name}",
        }  # fmt: skip
        figures[f"force-{name}"] = {
            **data.traces(
                clock, [("ideal faulty force", plan.ideal), ("expected force", expected[name])],
                label="Force", unit="N", link=link, bands=bands,
            ),
            "title": f"Force, damper {name}",
        }  # fmt: skip
        figures[f"error-{name}"] = {
            **data.traces(
                clock, [("expected less ideal", expected[name] - plan.ideal)],
                label="Difference", unit="N", link=link, bands=bands,
            ),
            "title": f"Expected less ideal force, damper {name}",
        }  # fmt: skip
    for x, title in (("xdot", "Force–velocity"), ("x", "Force–deflection")):
        spec = data.loops(x, "expected", f"loop-{x}")
        figures[f"loop-{x}"] = {**spec, "title": f"{title}, damper {channel}"}
    reaches = [(name, r) for name, plan in plans.items() for r in plan.reaches]
    return render(
        "mimic.html",
        title=f"PWM sequence for {logs_text(recording)}",
        run=run,
        figures=figures,
        samples=samples,
        logs=logs_text(recording),
        extent=extent(recording, len(levels.duty)),
        channels=list(plans),
        **_answers(plans, reaches, static),
        faults=_faults(reaches, static),
        table=_table(reaches, static),
    )


def _answers(plans: Mapping[str, Plan], reaches: Sequence[tuple[str, Reach]], static: bool) -> Json:
    if not reaches:
        return {
            "mood": "mid", "head": "No fault acts during this log.", "near": "Nothing to mimic.",
            "where": "Nothing to mimic.", "why": "Look at the start times of the faults.",
            "before": "–", "after": "–", "better": "",
        }  # fmt: skip
    errors = [r.paper if static else r.compensated for _, r in reaches]
    worst = max(errors)
    out = [(n, r) for n, r in reaches if r.out_of_reach > REACHED]
    parts = {n: p.limited_paper if static else p.limited for n, p in plans.items()}
    limited = {name: part for name, part in parts.items() if part > REACHED}
    near = f"Within {100 * worst:.2g} % rms of the range of the ideal faulty force."
    if out:
        mood, head = "bad", f"Part of {' and '.join(str(r.fault) for _, r in out)} is out of reach."
        where = "; ".join(
            f"{r.fault}: no duty gives the force {100 * r.out_of_reach:.1f} % of the time,"
            f" {digits(r.missing_rms, 3)} N rms, at most {digits(r.missing_max, 3)} N are missing"
            for _, r in out
        )
        why = "There the force is too large with no field at all: a field only adds to it."
    else:
        mood, where = "good", "Nowhere: some duty gives the faulty force at all times."
        head = f"The healthy damper acts the faults to within {100 * worst:.2g} %."
        why = "Nothing is out of reach of the yield force."
    if limited:
        mood = "bad" if out else "mid"
        part = ", ".join(f"{100 * v:.1f} % of the time on {k}" for k, v in limited.items())
        why += f" The amplifier's highest duty holds the sequence back {part}."
    paper = max(r.paper for _, r in reaches)
    return {
        "mood": mood, "head": head, "near": near, "where": f"{where.rstrip('.')}.", "why": why,
        "before": f"{paper:.4f}", "after": "" if static else f"{worst:.4f}",
        "better": "the paper's static inverse, as asked for"
        if static
        else "the paper's static inverse → the sequence written; NRMSE of the worst fault",
    }  # fmt: skip


def _faults(reaches: Sequence[tuple[str, Reach]], static: bool) -> Json:
    rows: list[Json] = [
        {
            "label": str(r.fault),
            "before": r.paper, "after": r.paper if static else r.compensated, "noise": None,
        }
        for _, r in reaches
    ]  # fmt: skip
    most = max((v for row in rows for v in (row["before"], row["after"])), default=1.0) or 1.0
    return {"rows": rows, "most": most, "before": "" if static else "paper's inverse"}


def _table(reaches: Sequence[tuple[str, Reach]], static: bool) -> Json:
    plain = not static and any(r.plain is not None for _, r in reaches)
    header = ["fault", "damper", "NRMSE", *(["without effects"] if plain else [])]
    header += [*([] if static else ["paper's inverse"]), "out of reach"]
    header += ["missing, rms [N]", "missing, max [N]"]
    rows = []
    for name, r in reaches:
        rows.append([
            str(r.fault), name, *r.figures(static=static),
            f"{100 * r.out_of_reach:.1f} %", digits(r.missing_rms, 3), digits(r.missing_max, 3),
        ])  # fmt: skip
    return {"header": header, "rows": rows}


def _clock(r: Recording) -> Array:
    """(n,) time as logged, or one that runs on where there are several records [s]."""
    if len(r.names) == 1:
        return r.t
    out, end = np.empty(len(r)), 0.0
    for part in r.slices:
        out[part] = r.t[part] - r.t[part][0] + end
        end = float(out[part][-1])
    return out


def _bands(r: Recording, clock: Array, plan: Plan) -> list[Json]:
    """When each fault acts, and where no duty reaches it."""
    out: list[Json] = []
    for reach in plan.reaches:
        f = reach.fault
        for part in r.slices:
            t = r.t[part]
            low = max(float(t[0]), -np.inf if f.start is None else f.start)
            high = min(float(t[-1]), np.inf if f.end is None else f.end)
            if low < high:
                shift = float(clock[part][0] - t[0])
                out.append({"low": low + shift, "high": high + shift, "text": f.kind.short})
    missed = _stretches(clock, plan.out_of_reach)
    return out + [{"low": low, "high": high, "bad": True} for low, high in missed]


def _stretches(clock: Array, flags: Flags) -> list[tuple[float, float]]:
    """Intervals in which a flag holds, joined where the gap could not be seen."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    least = float(clock[-1] - clock[0]) / STRETCHES
    out: list[tuple[float, float]] = []
    for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        low, high = float(clock[a]), float(clock[b - 1])
        if out and low - out[-1][1] < least:
            out[-1] = out[-1][0], high
        else:
            out.append((low, high))
    return out

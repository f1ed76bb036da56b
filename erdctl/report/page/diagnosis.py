"""The page of a diagnosis: its document in words and tables, the log's samples in figures."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.residual.localisation import variables
from erdctl.effects import get
from erdctl.model.corrected_equation import corrected_equation
from erdctl.model.effect import Variable
from erdctl.model.paper import EQUATIONS
from erdctl.report.page import data
from erdctl.report.page.data import Json, Levels
from erdctl.report.page.diagnosis_tables import (
    heldout_table,
    notes_of,
    paper_table,
    record_table,
)
from erdctl.report.page.render import Run, digits, render
from erdctl.report.page.words import (
    extent,
    joined,
    logs_text,
    peak_of,
    plain,
    rig_line,
    shown_value,
)
from erdctl.report.readable import headline, percent_of, with_unit
from erdctl.report.undetected import HEADER, undetected_rows

MOOD = {"adequate": "good", "explained": "mid", "unexplained": "bad"}


def diagnosis_page(
    document: Json, recording: Recording, *, before: Array, after: Array, run: Run
) -> str:
    """The page.

    document : as `diagnose` writes it;  recording : that was diagnosed
    before, after : (n,) force [N] of `baseline.params` and of `corrected.params`
    """
    assert recording.force is not None
    doc, levels = document, Levels.of(recording)
    changed = _changed(doc)
    given = "params" in doc["provenance"]
    name = "the given model's structure" if given else "the paper's model"
    plain_name = "given" if given else "paper's model"
    models = {"before": before, "after": after} if changed else {"before": before}
    samples = data.samples(recording, levels, models)
    samples["words"] = {"measured": "measured", "modelled": "model"}
    figures = _figures(doc, recording, levels, models, plain_name)
    return render(
        "diagnosis.html",
        title=f"Diagnosis of {logs_text(recording)}: {doc['verdict']}",
        run=run,
        figures=figures,
        samples=samples,
        doc=doc,
        mood=MOOD[doc["verdict"]],
        logs=logs_text(recording),
        extent=extent(recording, len(levels.duty)),
        model_name=name,
        loops=[key for key in figures if key.startswith("loop")],
        maps=[key for key in figures if key.startswith("map")],
        profiles=[key for key in figures if key.startswith("profile")],
        **_answers(doc, name, peak_of(recording.force)),
        rig=[rig_line(f) for f in doc["rig"]],
        levels=_levels(doc, recording, levels, "refitted" if given else plain_name),
        misfit_words=_misfit_words(doc),
        findings=[_finding(f) for f in doc["findings"]],
        paper_equations=EQUATIONS,
        corrected=corrected_equation([get(f["effect"]) for f in doc["findings"]]),
        shared=_shared(doc),
        paper=paper_table(doc),
        notes=notes_of(doc),
        records=record_table(doc.get("records")),
        heldout=heldout_table(doc, peak_of(recording.force)),
        unseen=[_sentence(u["text"]) for u in doc.get("unseen", [])],
        remaining=_sentence(doc["remaining"]["text"]),
        undetected_header=HEADER,
        untestable=[[k, v] for k, v in doc["not_testable"].items()],
        undetected=undetected_rows(doc.get("undetected", [])),
    )


def _figures(
    doc: Json, r: Recording, levels: Levels, models: Mapping[str, Array], plain_name: str
) -> dict[str, Json]:
    assert r.force is not None
    names = {"before": plain_name, "after": "corrected"}
    noise = doc["noise_rms"]
    # Samples that have weight zero in the diagnosis are left out here, too.
    sure = prepare(r).block.weight > 0.0
    misfits = {key: np.where(sure, r.force - model, np.nan) for key, model in models.items()}
    out: dict[str, Json] = {}
    for x, words in (("xdot", "Force–velocity"), ("x", "Force–deflection")):
        for key in models:
            title = f"{words}, {names[key]}"
            out[f"loop-{x}-{key}"] = {**data.loops(x, key, f"loop-{x}"), "title": title}
    for key, found in data.misfit_maps(r, levels, misfits, noise).items():
        title = f"Misfit over velocity and PWM level, {names[key]}"
        out[f"map-{key}"] = {**found, "title": title, "link": "map"}
    named = {names[key]: misfit for key, misfit in misfits.items()}
    values = variables(Signals.of(r), r.force)
    regions: dict[str, tuple[float, float, str] | None] = {"xdot": None}
    for m in reversed(doc["mismatch"]):
        where = m["where"]
        if where["variable"] == Variable.RECORD.value:
            continue  # a number of a record is no axis
        regions[where["variable"]] = where["low"], where["high"], f"{100 * m['share']:.0f} %"
    for variable, region in reversed(regions.items()):  # the sharpest first
        v = Variable(variable)
        found = data.profile(v, values[v], named, noise=noise, region=region)
        title = f"Misfit over {data.LABELS[v][0].lower()}"
        out[f"profile-{variable}"] = {**found, "title": title}
    return out


def _answers(doc: Json, name: str, peak: float) -> Json:
    """The first screen's answers, in words; peak : of the measured force [N]."""
    verdict, noise = doc["verdict"], doc["noise_rms"]
    rms = doc["heldout"]["before"]["rms"]
    named = [plain(f["effect"]) for f in doc["findings"]]
    missed = float(np.sqrt(max(rms**2 - noise**2, 0.0)))
    start = name[0].upper() + name[1:]
    many = "explain" if len(named) > 1 else "explains"
    match verdict:
        case _ if any(f["blocks"] and f["record"] is None for f in doc["rig"]):
            head = "The recording is at fault, so nothing can be said of the damper."
        case "adequate":
            head = f"{start} holds: the residual is measurement noise."
        case "explained":
            head = f"{start} does not hold; {joined(named)} {many} what it misses."
        case _ if _cut(doc):
            head = f"{start} holds within the limits of the channels, and beyond nothing is known."
        case _ if doc.get("cannot_tell"):
            head = (
                f"{start} does not hold, but the log has too few conditions to tell what it misses."
            )
        case _ if named:
            head = (
                f"{start} does not hold; {joined(named)} {many} part of what it misses,"
                " and nothing in the catalogue the rest."
            )
        case _:
            head = f"{start} does not hold, and nothing in the catalogue explains what it misses."
    if _laws(doc):
        head += " What the data say of that was learned, and has no name."
    if verdict == "adequate" or _cut(doc):
        sure = "Yes" if verdict == "adequate" else "As far as was recorded"
        holds = f"{sure}. Its error is {digits(rms, 3)} N rms, the noise {digits(noise, 3)} N rms."
        where = "Nowhere: no misfit beyond the noise."
        why = (
            "Nothing that these data show: of the effects that were asked for none has earned a"
            " name on data that no fit has seen. From which size each would have shown is under"
            " What stays open."
        )
    else:
        holds = f"No. It misses {digits(missed, 3)} N rms beyond {digits(noise, 3)} N rms of noise."
        first = doc["mismatch"][:1]
        where = _sentence(first[0]["text"]) if first else (
            "In no one place: no interval of speed, deflection, duty, time or energy holds so much"
            " more of it than of the time as to point there."
        )  # fmt: skip
        why = _sentence(doc["remaining"]["text"])
    if "refitted" in doc:
        holds += (
            f" That is fitted to these logs; as given, {digits(doc['baseline']['rms'], 3)} N rms."
        )
    if "as_fault" in doc:
        holds += f" The given parameters do not hold: {doc['as_fault']['text']}."
    return {
        "head": head, "holds": holds, "where": where, "why": why,
        "causes": [
            *(_cause(f) for f in doc["findings"]),
            *({"number": f["equation"], "text": _sentence(f["text"])} for f in _laws(doc)),
        ],
        "better": _better(doc, peak),
    }  # fmt: skip


def _laws(doc: Json) -> list[Json]:
    """What was learned of a misfit that no effect explains."""
    return list(doc.get("learned", []))


def _changed(doc: Json) -> bool:
    """Whether the corrected model is another one."""
    return bool(doc["findings"] or _laws(doc))


def _cause(f: Json) -> Json:
    """An effect with its main number, and what it is."""
    effect = get(f["effect"])
    text = f"{plain(effect.name)}, {effect.title}"
    if f["equivalent"]:
        text += f"; or {joined([plain(e) for e in f['equivalent']], 'or')}, which would look alike"
    values = {symbol: v["value"] for symbol, v in f["parameters"].items()}
    return {"number": headline(effect, values), "text": f"{text}."}


def _shared(doc: Json) -> bool:
    """Whether two findings have a parameter of the same symbol."""
    symbols = [s for f in doc["findings"] for s in f["parameters"]]
    return len(symbols) > len(set(symbols))


def _better(doc: Json, peak: float) -> Json:
    before, after = doc["heldout"]["before"], doc["heldout"]["after"]
    noise = with_unit(doc["noise_rms"], "N", 3)

    def size(rms: float) -> str:
        """An error as people judge it."""
        return f"{with_unit(rms, 'N', 3)} rms ({percent_of(rms, peak)})"

    of_peak = f"per cent of the peak force of {with_unit(peak, 'N', 3)}; noise {noise} rms"
    unit = "NRMSE on data that the fit has not seen"
    if not _changed(doc):
        return {
            "question": "How well does it predict?", "before": "",
            "after": f"{before['nrmse']:.4f}", "unit": unit,
            "errors": [size(before["rms"])], "words": f"{of_peak}. Nothing was corrected.",
        }  # fmt: skip
    part = 1.0 - after["nrmse"] / before["nrmse"]
    return {
        "question": "How much better is the corrected model?",
        "before": f"{before['nrmse']:.4f}", "after": f"{after['nrmse']:.4f}", "unit": unit,
        "errors": [size(before["rms"]), size(after["rms"])],
        "words": f"{of_peak}. {100 * part:.0f} % less.",
    }  # fmt: skip


def _levels(doc: Json, r: Recording, levels: Levels, plain_name: str) -> Json:
    """Held-out NRMSE per PWM level for the first screen, with the noise on the same scale."""
    assert r.force is not None
    spans = {}
    for i, duty in enumerate(levels.duty.tolist()):
        spans[duty] = float(np.ptp(r.force[levels.at == i]))
    before, after = (_by_duty(doc["heldout"][k]) for k in ("before", "after"))
    rows = [
        {
            "label": data.percent(duty), "before": before[duty], "after": value,
            "noise": doc["noise_rms"] / spans[duty] if spans.get(duty) else None,
        }
        for duty, value in after.items()
    ]  # fmt: skip
    most = max(v for row in rows for v in (row["before"], row["after"], row["noise"]) if v)
    return {
        "rows": rows, "most": most, "noise": "noise",
        "before": plain_name if _changed(doc) else "",
        "after": "corrected" if _changed(doc) else plain_name,
    }  # fmt: skip


def _cut(doc: Json) -> bool:
    """Whether nothing is missed but what lies beyond the limit of a channel."""
    cut = any(fault["code"].endswith("_clipped") for fault in doc["rig"])
    return bool(doc.get("cannot_tell")) and not doc["findings"] and cut


def _by_duty(scores: Json) -> dict[float, float]:
    return {level["duty"]: level["nrmse"] for level in scores["nrmse_by_duty"]}


def _misfit_words(doc: Json) -> str:
    words = (
        "Root mean square of measured less modelled force. As in the diagnosis, samples of"
        " uncertain direction and the first 0.3 s of a record, in which its state settles, are"
        " left out."
    )
    if not doc["mismatch"]:
        return f"{words} No interval of any variable stands out by its part of the misfit."
    places = "; ".join(m["text"] for m in doc["mismatch"])
    return f"{_sentence(places)} These intervals are shaded in the profiles. {words}"


def _finding(f: Json) -> Json:
    effect = get(f["effect"])
    titles = {q.symbol: q.title for q in effect.quantities}
    e = f["evidence"]
    evidence = f"t statistic of the gain over the log: {digits(e['gain_over_scatter'], 2)}."
    if e["runner_up"]:
        evidence += f" Next best effect: {e['runner_up']}."
    return {
        **f,
        "title": plain(effect.name).capitalize(),
        "text": _sentence(f["text"])[:-1],
        "equals": joined([plain(e) for e in f["equivalent"]], "or"),
        "test": f.get("test"),
        "evidence": evidence,
        "parameters": [
            {"symbol": symbol, "title": titles[symbol], **shown_value(value)}
            for symbol, value in f["parameters"].items()
        ],
    }


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}".rstrip(".") + "."

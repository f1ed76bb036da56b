"""Templates, styles, scripts and data put together to one file that needs nothing else."""

from __future__ import annotations

import shlex
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from hashlib import sha256
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from erdctl.core.messages import counted
from erdctl.core.recording import Source
from erdctl.core.version import __version__
from erdctl.export.serves import ONLINE, served
from erdctl.report.page.mathml import equation, flowing, prose, symbol
from erdctl.report.readable import typeset

RAISED = str.maketrans("−0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
SCRIPTS = ("d3.min.js", "plot.js", "kinds.js", "page.js")


@dataclass(frozen=True, kw_only=True)
class Run:
    """How a result came about: command, logs, other files, remarks, labels of the test."""

    words: Sequence[str]
    logs: Sequence[Source] = ()
    details: Sequence[tuple[str, str]] = ()
    labels: Mapping[str, str] = field(default_factory=dict)

    @property
    def command(self) -> str:
        """As it would be typed again."""
        return shlex.join(["erdctl", *self.words])

    @property
    def rows(self) -> list[tuple[str, str]]:
        """Provenance, for a table."""
        out = [*self.labels.items(), ("erdctl", __version__), ("command", self.command)]
        for log in self.logs:
            out.append(
                (
                    f"log {log.name}",
                    f"{counted(log.rows, 'row')}, SHA-256 {log.sha256 or 'unknown'}",
                )
            )
        return [*out, *self.details]


def render(
    template: str,
    *,
    title: str,
    run: Run,
    figures: Mapping[str, Mapping[str, Any]],
    samples: Mapping[str, Any] | None = None,
    **context: Any,
) -> str:
    """The page. `figures` are drawn where the template has a figure of that name.

    Names in logs are foreign text: the templates escape everything, and the page's own policy lets
    no script run but those whose hashes it lists, and nothing be fetched.
    """
    scripts = [_asset(name) for name in SCRIPTS]
    style = _asset("page.css")
    return (
        _environment()
        .get_template(template)
        .render(
            title=title,
            run=run,
            figures=figures,
            data={"samples": samples, "figures": figures},
            scripts=scripts,
            style=style,
            served=list(served().items()),
            online=ONLINE,
            policy=_policy(scripts, style),
            **context,
        )
    )


@cache
def _asset(name: str) -> str:
    return (files(__package__) / "assets" / name).read_text(encoding="utf-8")


def _policy(scripts: Sequence[str], style: str) -> str:
    def allowed(texts: Sequence[str]) -> str:
        digests = (b64encode(sha256(text.encode()).digest()).decode() for text in texts)
        return " ".join(f"'sha256-{digest}'" for digest in digests)

    return f"default-src 'none'; script-src {allowed(scripts)}; style-src {allowed([style])}"


@cache
def _environment() -> Environment:
    out = Environment(
        loader=PackageLoader(__package__),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    out.filters |= {
        "equation": equation,
        "flowing": flowing,
        "symbol": symbol,
        "prose": prose,
        "unit": typeset,
    }
    out.filters["digits"] = digits
    return out


def digits(value: float | None, count: int = 4) -> str:
    """A number with so many significant digits, a dash for none.

    Check: 0.25 is "0.25", 32659 is "32660", -5.4e-8 is "−5.4×10⁻⁸".
    >>> digits(0.25), digits(32659.0), digits(-5.4e-8)
    ('0.25', '32660', '−5.4×10⁻⁸')
    """
    if value is None:
        return "–"
    text = f"{value + 0.0:.{count}g}"
    if "e+" in text and abs(value) < 1e6:
        text = f"{float(text):.0f}"
    number, _, power = text.replace("-", "−").partition("e")
    if power:
        number += "×10" + power.replace("+", "").lstrip("0").translate(RAISED).replace("⁻⁰", "⁻")
    return number

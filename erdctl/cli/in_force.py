"""The project file that holds for a command, and the one line that says what it changed."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from typer.core import TyperOption

if TYPE_CHECKING:
    from erdctl.io.identity import Named
    from erdctl.io.project.project import Project
    from erdctl.io.project.reading import ProjectReading

VARIABLE = "ERDCTL_PROJECT"
CORNERS = ("fl", "fr", "rl", "rr")


@dataclass
class InForce:
    """A project while a command runs.

    damper, corner : as the user gave them;  used : what the project changed so far
    """

    project: Project
    damper: str | None
    corner: str | None
    used: list[str] = field(default_factory=list)
    told: bool = False

    def use(self, what: str) -> None:
        """Remember what the project changed, once."""
        if what not in self.used:
            self.used.append(what)

    @property
    def reading(self) -> ProjectReading:
        """How logs are read by it."""
        from erdctl.io.project.reading import ProjectReading

        return ProjectReading(self.project, self.damper, self.corner, self.use)

    def label(self) -> dict[str, str]:
        """For provenance: which file, by its hash, and what it changed."""
        if not self.used:
            return {}
        name = os.path.basename(self.project.name)
        return {"project": f"{name}, SHA-256 {self.project.sha256}: {'; '.join(self.used)}"}

    def tell(self) -> None:
        """Say it, unless it was said already or nothing was changed."""
        from erdctl.report.text import say

        if self.used and not self.told:
            self.told = True
            say(f"by {self.project.name}: {'; '.join(self.used)}")


IN_FORCE: ContextVar[InForce | None] = ContextVar("project", default=None)


def names(project: InForce | None) -> list[Named]:
    """The project's file among those that a command reads, so that it is not written over."""
    from erdctl.io.identity import Named

    return [] if project is None else [Named(project.project.name, "the project file", reads=True)]


@contextmanager
def force(project: InForce | None) -> Iterator[None]:
    """The project holds in this block; at its end it is said what it changed."""
    before = IN_FORCE.set(project)
    try:
        yield
    finally:
        IN_FORCE.reset(before)
        if project is not None:
            project.tell()


def options(parameters: list[Any]) -> list[TyperOption]:
    """The options of a command that choose a project, and a damper of it."""
    names = {p.name for p in parameters}
    out = [
        _option("project", "--project", metavar="FILE", help="Project file, in place of what"
                f" {VARIABLE} names, or the nearest erdctl.toml."),
        TyperOption(
            param_decls=["no_project", "--no-project"], is_flag=True, expose_value=False,
            callback=_keep, help="Use no project file.",
        ),
    ]  # fmt: skip
    if names & {"maps", "duty_max", "shown"}:
        out.append(_option("corner", "--corner", metavar="|".join(CORNERS), callback=_corner,
                           help="The corner whose part of the project file holds."))  # fmt: skip
        if "damper" not in names:
            out.append(_option("damper", "--damper", metavar="TEXT", help="The damper whose part of"
                               " the project file holds; by default from the path."))  # fmt: skip
    return out


def _option(name: str, flag: str, *, callback: Any = None, **words: Any) -> TyperOption:
    return TyperOption(
        param_decls=[name, flag], expose_value=False, callback=callback or _keep, **words
    )


def _keep(context: Any, parameter: Any, value: Any) -> Any:
    context.meta[f"erdctl.{parameter.name}"] = value
    return value


def _corner(context: Any, parameter: Any, value: str | None) -> str | None:
    from erdctl.core.errors import UsageProblem

    found = None if value is None else value.casefold()
    if found is not None and found not in CORNERS and not context.resilient_parsing:
        raise UsageProblem(f"--corner takes {', '.join(CORNERS)}, not '{value}'")
    _keep(context, parameter, found)
    return found


def asked(context: Any, name: str) -> Any:
    """What the user gave for one of these options, or for a command's own `--damper`."""
    return context.meta.get(f"erdctl.{name}") or context.params.get(name)


def file_of(context: Any) -> str | None:
    """The project file of a call; None for none.

    Raises UsageProblem where the call names one and wants none.
    """
    from erdctl.core.errors import UsageProblem

    named, none = asked(context, "project"), asked(context, "no_project")
    if named and none:
        raise UsageProblem("--project and --no-project: give one of the two")
    if none:
        return None
    if named:
        return str(named)
    if VARIABLE in os.environ:
        return os.environ[VARIABLE] or None
    return nearest()


def nearest() -> str | None:
    """The project file of this folder."""
    from erdctl.io.project.find import find

    try:
        return find(os.getcwd())
    except OSError:  # the folder is gone
        return None

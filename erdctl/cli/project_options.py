"""Options out of a project file: which there are, what they mean, and how they reach a command."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from erdctl.cli.files import FOLDERS, READS, WRITES
from erdctl.cli.in_force import InForce, asked, file_of, nearest

if TYPE_CHECKING:
    from erdctl.io.project.labels import Labels
    from erdctl.io.project.project import At, Project, Said

# By the names of parameters: what belongs to one run, or has a table of its own in the file.
ELSEWHERE = {
    "damper": "[labels]", "date": "[labels]",
    "maps": "[columns]", "text": "[text]", "where": "[where]",
    **dict.fromkeys(("duty_max", "resolution", "slew", "update_rate", "carrier", "full_scale"),
                    "[amplifier]"),
    **dict.fromkeys(("max_temperature", "accept", "strict"), "[rig]"),
}  # fmt: skip
OF_ONE_RUN = {
    *READS, *WRITES, *FOLDERS, "on", "as_json", "force", "ignore_temperature", "format", "emulate",
    "nulls", "quiet", "project", "no_project", "corner", "help", "new_name",
}  # fmt: skip
# Options of a project that mean nothing, or would be refused, without or beside another option.
ONLY_WITH = {
    ("inspect", "noise"): "forecast", ("plot", "fault"): "params", ("effects", "law"): "source",
    ("prove", "sizes"): "on", ("prove", "thin"): "on",
}  # fmt: skip
NOT_WITH = {
    ("simulate", "drive"): ("log",),
    **{("prove", name): ("on", "nulls")
       for name in ("level", "kind", "concealment", "motion", "colour")},
    ("prove", "only"): ("nulls",),
}  # fmt: skip
# Which way a limit is looser: upward, or downward; None where any other value is another device.
LOOSER: Mapping[str, int | None] = {
    "duty_max": 1, "slew": 1, "update_rate": 1, "max_temperature": 1, "resolution": -1,
    "carrier": None, "full_scale": None,
}  # fmt: skip
# By the first letters of what Click calls the types of options, plain or with a range.
TYPES: Mapping[str, tuple[str, tuple[type, ...]]] = {
    "int": ("a whole number", (int,)), "float": ("a number", (int, float)),
    "bool": ("true or false", (bool,)), "": ("a text", (str,)),
}  # fmt: skip


def applied(context: Any, commands: Callable[[], Mapping[str, Any]]) -> InForce | None:
    """The project of a call, whose options have taken the place of defaults in `context.params`.

    commands : all of them by name, to check the file's options
    Raises UsageProblem for what is wrong with the file, with its line and key.
    """
    path = file_of(context)
    if path is None:
        _left_aside(context)
        return None
    from erdctl.io.project.file import read_project

    project = read_project(path)
    check(project, commands)
    found = InForce(project, asked(context, "damper"), asked(context, "corner"))
    of = labels(found, context.params)
    limited = _limits(found, context, of)
    given = {p.name: p for p in context.command.params if p.name not in limited}
    values = {}
    from erdctl.io.project.labels import common

    for name, said in project.options(context.info_name, common(of)).items():
        parameter = next((p for p in given.values() if name in option_names(p)), None)
        if parameter is not None and _applies(context, parameter.name):
            values[parameter.name] = ((name,), said)
    _put(found, context, {**limited, **values})
    return found


def labels(found: InForce, given: Mapping[str, Any]) -> list[Labels]:
    """What the files are of that a call reads, as far as paths and the user tell it."""
    paths = [
        path for name in ("logs", "log", "arguments", "on", "params")
        for path in _listed(given.get(name)) if path != "-"
    ]  # fmt: skip
    return [found.reading.labels(path) for path in paths or ["-"]]


def option_names(parameter: Any) -> list[str]:
    """An option as a project file writes it: `--max-effects` is max_effects.

    Those that cannot stand there have none.
    """
    if parameter.param_type_name != "option":
        return []
    return [o[2:].replace("-", "_") for o in parameter.opts if o.startswith("--")]


def check(project: Project, commands: Callable[[], Mapping[str, Any]]) -> None:
    """Raise UsageProblem for an option that no command has, or of another type."""
    sections = [(at, s.options) for at, s in project.sections() if s.options]
    if not sections:
        return
    known = {name: own for name, c in commands().items() for own in [_own(c)]}
    for table, said in sections:
        for key, value in said.items():
            at = (*table, "options", key)
            if not isinstance(value, dict):
                having = [own[key] for own in known.values() if key in own]
                _check_one(project, at, key, value, having, {n for o in known.values() for n in o})
            elif key not in known:
                raise _problem(project, at, f"no command{_close(key, known)}")
            else:
                for name, one in value.items():
                    own = known[key]
                    having = [own[name]] if name in own else []
                    _check_one(project, (*at, name), name, one, having, set(own))


def _check_one(
    project: Project, at: At, name: str, value: Any, having: Sequence[Any], names: set[str]
) -> None:
    if not having:
        raise _problem(project, at, f"no option of the command{_close(name, names)}")
    for parameter in having:
        if parameter.name in ELSEWHERE:
            raise _problem(project, at, f"belongs to the table {ELSEWHERE[parameter.name]}")
        if parameter.name in OF_ONE_RUN:
            raise _problem(project, at, "is said of one run, on the command line")
    if not any(_fits(value, p) for p in having):
        kind = _type(having[0])[0]
        many = f"{kind}, or a list of such" if having[0].multiple else kind
        raise _problem(project, at, f"is {value!r}, expected {many}")


def _type(parameter: Any) -> tuple[str, tuple[type, ...]]:
    return next(known for start, known in TYPES.items() if parameter.type.name.startswith(start))


def _fits(value: Any, parameter: Any) -> bool:
    types = _type(parameter)[1]
    values = value if isinstance(value, list) and parameter.multiple else [value]
    return all(isinstance(v, types) and (bool in types or not isinstance(v, bool)) for v in values)


def _own(command: Any) -> dict[str, Any]:
    return {name: p for p in command.params for name in option_names(p)}


def _close(name: str, known: Any) -> str:
    from difflib import get_close_matches

    close = get_close_matches(name.replace("-", "_"), list(known), 1, 0.6)
    return f"; did you mean '{close[0]}'?" if close else ""


def _problem(project: Project, key: At, message: str) -> Exception:
    from erdctl.io.project.file import problem_of

    return problem_of(project, key, message)


def _applies(context: Any, name: str) -> bool:
    """Whether an option means something in this call."""
    command, given = context.info_name, context.params
    other = ONLY_WITH.get((command, name))
    if other is not None and not given.get(other):
        return False
    if any(given.get(n) not in (None, (), []) for n in NOT_WITH.get((command, name), ())):
        return False
    if command != "export":
        return True
    from erdctl.export.targets import EMULATOR, TARGETS

    flag = f"--{name.replace('_', '-')}"
    target = TARGETS.get("." + given["output"].rpartition(".")[2].lower())
    return target is not None and flag in target.options and (
        flag not in EMULATOR or bool(given.get("emulate"))
    )  # fmt: skip


Chosen = dict[str, "tuple[At, Said]"]


def _put(found: InForce, context: Any, values: Chosen) -> None:
    """In place of defaults only, so that the command line wins; as the option would be read."""
    own = {p.name: p for p in context.command.params}
    for name, (keys, said) in values.items():
        if is_given(context, name):
            continue
        parameter = own[name]
        value = said.value
        if parameter.multiple and not isinstance(value, list):
            value = [value]
        context.default_map = {name: value}
        try:
            parameter.handle_parse_result(context, {}, [])
        except Exception as error:  # of whichever Click Typer has; raised again if not
            message = getattr(error, "message", None)
            if message is None:
                raise
            raise _problem(found.project, (*said.at, *keys), str(message)) from None
        finally:
            context.default_map = None
        found.use(f"{keys[-1]} {_shown(value)}")


def is_given(context: Any, name: str) -> bool:
    """Whether the user gave an option."""
    source = context.get_parameter_source(name)
    return source is not None and source.name in ("COMMANDLINE", "ENVIRONMENT")


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return ",".join(map(str, value))
    return f"{value:g}" if isinstance(value, float) else str(value)


def _limits(found: InForce, context: Any, of: Sequence[Labels]) -> Chosen:
    """Limits for the options that a command has; the tightest, where files are of several dampers.

    What is looser is said: on the command line, and of a damper beside what holds of all.
    """
    from erdctl.io.project.labels import Labels
    from erdctl.report.text import say

    project, out = found.project, Chosen()
    own = {p.name for p in context.command.params}
    general = project.limits(Labels())
    for one in of:
        for key, said in project.limits(one).items():
            name = key.split(".")[1]
            if name not in own or not _applies(context, name):
                continue
            last = out[name][1].value if name in out else None
            # Of two resolutions that do not fit into each other the coarser.
            if last is None or (looser(name, last, said.value)
                                and not _off_steps(name, last, said.value)):  # fmt: skip
                out[name] = (tuple(key.split(".")), said)
    for name, (keys, said) in out.items():
        flag, value = f"--{name.replace('_', '-')}", context.params.get(name)
        limit = f"{said.key(*keys)} = {_shown(said.value)} of {project.name}"
        key = ".".join(keys)
        if said.at and key in general and looser(name, said.value, general[key].value):
            how = _how(name, said.value, general[key].value)
            say(f"{limit} is {how} {key} = {_shown(general[key].value)}, and holds", "warning")
        if is_given(context, name) and looser(name, value, said.value):
            how = _how(name, value, said.value)
            say(f"{flag} {_shown(value)} is {how} {limit}; the command line holds", "warning")
        if name == "max_temperature" and context.params.get("ignore_temperature"):
            say(f"--ignore-temperature sets {limit} aside", "warning")
    if own & LOOSER.keys() and _limited(context):
        apart = project.with_limits_of_their_own()
        unknown = [w for w in apart if all(getattr(o, w[0]) is None for o in of)]
        if unknown:
            names = ", ".join(map(" ".join, unknown))
            say(
                f"limits of {names} in {project.name} are left aside: nothing says"
                " which damper this is; --damper and --corner do", "warning",
            )  # fmt: skip
    return out


def _limited(context: Any) -> bool:
    return any(_applies(context, name) for name in ("duty_max", "max_temperature"))


def looser(name: str, value: Any, limit: Any) -> bool:
    """Whether a value lets through what a limit does not.

    >>> looser("duty_max", 0.5, 0.4), looser("resolution", 0.0, 0.01), looser("slew", 5.0, 9.0)
    (True, True, False)
    """
    if name not in LOOSER:
        return False
    way = LOOSER[name]
    if way is None:
        return bool(value != limit)
    return not way * value <= way * limit or _off_steps(name, value, limit)


def _off_steps(name: str, value: float, limit: float) -> bool:
    """Whether a resolution is coarser than another, but not made of its steps.

    An amplifier with steps of 0.01 knows no duty of 0.015.
    """
    if name != "resolution" or not 0.0 < limit < value:
        return False
    steps = value / limit
    return abs(steps - round(steps)) > 1e-6 * steps


def _how(name: str, value: float, limit: float) -> str:
    """How a looser value stands to its limit, in words."""
    return "no multiple of" if _off_steps(name, value, limit) else "beyond"


def _left_aside(context: Any) -> None:
    """Say that limits may be missing where a project was declined that lies here."""
    names = {p.name for p in context.command.params}
    if not names & {"duty_max"} or not _limited(context):
        return
    from erdctl.report.text import say

    path = nearest()
    if path is not None:
        say(f"no project file is used, nor the limits in {path}", "warning")


def _listed(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif value is not None:
        yield from value

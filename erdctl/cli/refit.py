"""`erdctl compare --refit`: the logs that parameter files came from, fitted with one model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from erdctl.core.recording import Recording
    from erdctl.model.parameters import Parameters


def refitted(found: dict[str, Parameters], options: dict[str, Any]) -> dict[str, Parameters]:
    """The same by a model that all have; those that have it stay as they are.

    found : by the name of their file;  options : how logs are read
    Raises InputProblem where a file names no log, or another one lies in its place.
    """
    from erdctl.diagnose.refit_alike import common_model, refit_alike
    from erdctl.report.text import progress, say

    common = {e.name for e in common_model([*found.values()]).effects}
    lacking = {
        name: sorted(common - {e.name for e in p.model.effects}) for name, p in found.items()
    }
    if not any(lacking.values()):
        say("all have the same model: there is nothing to refit")
        return found
    logs = [_log(name, p, options) if lacking[name] else None for name, p in found.items()]
    with progress() as step:
        again = refit_alike([*found.values()], logs, step)
    for name, effects in lacking.items():
        if effects:
            say(f"{name}: refitted to its log with {', '.join(effects)}, which another one has")
    return dict(zip(found, again, strict=True))


def _log(name: str, parameters: Parameters, options: dict[str, Any]) -> Recording:
    from erdctl.bench.rig import look
    from erdctl.cli.reading import read_logs
    from erdctl.core.errors import InputProblem
    from erdctl.report.text import say

    told = parameters.provenance.get("logs")
    logs = [log for log in told if isinstance(log, dict)] if isinstance(told, list) else []
    paths = [str(log.get("name", "-")) for log in logs]
    if not paths or "-" in paths:
        raise InputProblem("names no log in a file, which --refit would read", file=name)
    recording = read_logs(paths, need_force=True, want_hash=True, report=say, **options).recording
    for log, source in zip(logs, recording.sources, strict=True):
        if log.get("sha256") not in (None, "", source.sha256):
            raise InputProblem(f"has changed since {name} was fitted to it", file=source.name)
    rig = look(recording)
    rig.refuse()
    return rig.usable()

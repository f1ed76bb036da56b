"""Which parameters may drive an amplifier."""

from __future__ import annotations

from erdctl.core.errors import InputProblem
from erdctl.model.parameters import Parameters


def refuse_untrusted(parameters: Parameters, file: str) -> None:
    """Raise InputProblem for parameters of a recording that was wrong as a whole.

    `diagnose` writes them down, so that its document is complete, with what is wrong beside them.
    """
    rig = parameters.provenance.get("rig")
    for fault in rig if isinstance(rig, list) else []:
        if isinstance(fault, dict) and fault.get("blocks") and fault.get("record") is None:
            raise InputProblem(
                f"these parameters come from a recording that is at fault: {fault.get('text')};"
                " mend that, identify again, and mimic with the new ones",
                file=file,
            )

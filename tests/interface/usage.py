"""What a user writes, for a type checker: only `wrong` has errors, two of them."""

from __future__ import annotations

import erdctl


def right() -> str:
    """The public functions, by their types."""
    log = erdctl.read("bench.csv", map={"x": "Defl FL[mm]"})
    damper = erdctl.identify(log, method="two-step")
    erdctl.validate(damper, erdctl.simulate(damper, log, faults=["oil=0.5"]), normalise="std")
    found = erdctl.diagnose(log, parameters=damper, effects=["backlash"])
    erdctl.mimic(found, log, "oil=0.5@15:31").write("pwm.mat")
    erdctl.inspect(log).table("records")
    return ", ".join([found.verdict, *found.effects, repr(erdctl.effects("backlash"))])


def wrong() -> None:
    """A number is no log, and a guess no method."""
    erdctl.identify(3)
    erdctl.identify("bench.csv", method="guess")

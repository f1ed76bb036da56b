"""The online emulator of faults in C as a block that FMI can be put around."""

from __future__ import annotations

import math
from dataclasses import replace

from erdctl.export.emulator.source import EmulatorBlock
from erdctl.export.fmu.block import FmuBlock, FmuType, FmuVariable
from erdctl.export.fmu.damper import FACTORS, INPUTS
from erdctl.export.fmu.members import Bounds, of_model, variables
from erdctl.model.parameters import Parameters

# 20 degC: where nobody measures it, the output is not closed.
TEMPERATURE = FmuVariable(name="temperature", unit="degC", title="of the damper", start=20.0)
OUTPUTS = (
    FmuVariable(name="duty_out", title="control for the amplifier"),
    FmuVariable(
        name="limited",
        kind=FmuType.BOOLEAN,
        title="the output is not what was wanted: ceiling, slew limit, temperature or bad inputs",
    ),
    FmuVariable(
        name="out_of_reach",
        kind=FmuType.BOOLEAN,
        title="no duty gives the faulty force now: the yield force would have to push",
    ),
)

# Flags of the status, and what is said of each.
_WORDS = {
    "INPUT": (1, "x, xdot or duty is not finite, or beyond all reason"),
    "STEP": (2, "the step is not finite or not positive"),
    "DUTY": (4, "the duty lies outside 0 to 1, and was limited"),
    "HOT": (8, "too hot, or the temperature is not finite: the output closes"),
    "FACTOR": (16, "a fault factor is not finite, or was limited to 0 to 1"),
    "PARAMETER": (32, "a parameter or limit cannot be used: the output is 0"),
    "STUCK": (64, "x or xdot stands while the other says that the piston moves"),
}
_SUM = "; ".join(f"{number}: {text}" for number, text in _WORDS.values())
STATUS = FmuVariable(
    name="status", kind=FmuType.INTEGER, title=f"0 if all is well; the sum of {_SUM}"
)

_LIMITS: Bounds = {
    "duty_max": (0.0, 1.0),
    "resolution": (0.0, 1.0),
    "slew": (0.0, math.inf),
    "update_period": (0.0, math.inf),
    "temperature_hysteresis": (0.0, math.inf),
}

MEANING = (
    "duty_out at a communication point is the control from that time on, for the inputs as they"
    " were set for the step that ends there: set x, xdot, duty, the factors and the temperature of"
    " the END of the step, call the step, read duty_out. After initialisation it is that of the"
    " first sample, the start time.",
    "duty is what the controller of the healthy damper wants; driven by duty_out in its place, the"
    " healthy damper acts as one whose faults have left f_oil, f_electrical and f_deformation of"
    " its effectiveness (1: healthy).",
    "Bad input never gives NaN. The step then returns a warning, and status says why.",
)


def emulator_block(c: EmulatorBlock, parameters: Parameters) -> FmuBlock:
    """The block of an emulator.

    c : its C, made of the same parameters
    """
    known = {kind.short for kind in c.faults}
    factors = [
        v if v.name.removeprefix("f_") in known else replace(v, title=f"{v.title} (ignored)")
        for v in FACTORS
    ]
    return FmuBlock(
        prefix=c.prefix,
        title="Online emulator of faults of an electro-rheological damper, by erdctl",
        header=c.header,
        source=c.source,
        inputs=(*INPUTS, *factors, TEMPERATURE),
        outputs=OUTPUTS,
        watched=(STATUS,),
        parameters=variables(c.parameters, {**of_model(parameters), **_LIMITS}),
        calls=f"{c.prefix}_faults(s, f_oil, f_electrical, f_deformation);\n"
        f"duty_out = {c.prefix}_step(s, dt, x, xdot, duty, temperature);\n"
        "limited = s->limited;\nout_of_reach = s->out_of_reach;\nstatus = s->status;",
        words={f"{c.prefix}_{name}": text for name, (_, text) in _WORDS.items()},
        notes=MEANING,
    )

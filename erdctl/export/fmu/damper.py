"""A damper in C as a block that FMI can be put around."""

from __future__ import annotations

from dataclasses import replace

from erdctl.export.c.source import CBlock, on_the_vehicle
from erdctl.export.fmu.block import FmuBlock, FmuType, FmuVariable
from erdctl.export.fmu.members import of_model, variables
from erdctl.model.learned.law import LearnedEffect
from erdctl.model.parameters import Parameters

INPUTS = (
    FmuVariable(name="x", unit="m", title="deflection, positive in compression"),
    FmuVariable(name="xdot", unit="m/s", title="speed of deflection, positive in compression"),
    FmuVariable(name="duty", title="control, held from one sample to the next", low=0.0, high=1.0),
)
_FACTORS = (
    FmuVariable(name="f_oil", title="effectiveness left by an oil leakage"),
    FmuVariable(name="f_electrical", title="effectiveness left by an electrical fault"),
    FmuVariable(name="f_deformation", title="effectiveness left by a deformation"),
)
# A healthy damper unless told otherwise.
FACTORS = tuple(replace(v, start=1.0, low=0.0, high=1.0) for v in _FACTORS)
FORCE = FmuVariable(name="force", unit="N", title="damper force, with the sign of Eq. 13")
STATUS = FmuVariable(
    name="status", kind=FmuType.INTEGER,
    title="0 if all is well; the sum of 1: an input is not finite, 2: the step is not positive, "
    "4: the duty was limited, 8: a fault factor was limited",
)  # fmt: skip
INITIAL = (
    FmuVariable(
        name="first_compressing", kind=FmuType.BOOLEAN, start=1.0,
        title="from rest it first moves in compression",
    ),
    FmuVariable(
        name="at_rest", kind=FmuType.INTEGER, start=-1.0, low=-1.0, high=1.0,
        title="1: begins at rest, 0: as a motion turns, -1: whichever its first speed says",
    ),
)  # fmt: skip
# Of a model with a law that counts passes over parts of the stroke.
STROKE = (
    FmuVariable(name="stroke_low", unit="m", title="least deflection of what follows, if known"),
    FmuVariable(name="stroke_high", unit="m", title="the largest; not above: it is not known"),
)
_SWEPT = """if (stroke_low < stroke_high)
    {}_stroke(s, stroke_low, stroke_high);
"""

MEANING = (
    "force at a communication point is the damper's force at that time for the inputs as they were"
    " set for the step that ends there: set x, xdot and duty of the END of the step, call the step,"
    " read force. After initialisation it is the force at the first sample, the start time. A"
    " master that sets the values of the beginning of a step gets the same forces one step late.",
    "duty acts from the communication point for which it is set, and is held until the next, as in "
    "erdctl simulate. Fault factors act on the force at that point.",
    "FMI 2.0: with derivatives of the inputs (fmi2SetRealInputDerivatives) their values at the end "
    "of the step are extrapolated.",
    "Input that is not finite, and a step that is not positive, leave the last force; a duty or "
    "factor beyond 0 to 1 is limited. The step then returns a warning, and status says which.",
    "All memory is allocated with the instance; a step allocates nothing.",
)


def damper_block(c: CBlock, parameters: Parameters) -> FmuBlock:
    """The block of a damper.

    c : its C, made of the same parameters
    """
    effects, _ = on_the_vehicle(parameters.model.effects)
    told = {tell.name for e in effects if e.c is not None for tell in e.c.told}
    warm = "temperature" in told
    swept = "stroke" in told
    left_out = (f"Left out: {'; '.join(c.left_out)}.",) if c.left_out else ()
    return FmuBlock(
        prefix=c.prefix,
        title="Electro-rheological damper, as identified by erdctl",
        header=c.header,
        source=c.source,
        inputs=INPUTS + FACTORS + ((_temperature(parameters),) if warm else ()),
        outputs=(FORCE,),
        watched=(STATUS,),
        parameters=variables(c.parameters, of_model(parameters)),
        initial=INITIAL + (STROKE if swept else ()),
        begin=f"{c.prefix}_begin(s, t, first_compressing != 0.0, (int)at_rest);\n"
        + (_SWEPT.format(c.prefix) if swept else ""),
        calls=(f"{c.prefix}_temperature(s, temperature);\n" if warm else "")
        + f"{c.prefix}_faults(s, f_oil, f_electrical, f_deformation);\n"
        f"force = {c.prefix}_step(s, dt, x, xdot, duty);\n"
        "status = s->status;",
        retune=f"{c.prefix}_retune(s, p);",
        words={
            f"{c.prefix}_{name}": text
            for name, text in (
                (
                    "NOT_FINITE",
                    "an input is not finite or beyond all reason: the last force is held",
                ),
                ("STEP_NOT_POSITIVE", "the step is not positive: the last force is held"),
                ("DUTY_LIMITED", "the duty lies outside 0 to 1, and was limited"),
                ("FAULT_LIMITED", "a fault factor lies outside 0 to 1, and was limited"),
            )
        },
        notes=(*MEANING, *left_out),
    )


def _temperature(parameters: Parameters) -> FmuVariable:
    """Of a model with a law of it; where nobody sets it, the middle of where that was learned."""
    axes = [
        axis
        for effect in parameters.model.effects
        if isinstance(effect, LearnedEffect)
        for axis in effect.law.curve.axes
        if axis.coordinate == "temperature"
    ]
    middle = sum(axes[0].range) / 2.0 if axes else 20.0
    return FmuVariable(name="temperature", unit="degC", title="of the damper", start=middle)

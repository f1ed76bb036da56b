"""What a concealed damper is made of: numbers, each with a value at which it does nothing.

These are named tuples of floats because compiled code reads them by name. `Side` is the paper's
damper in one direction (Eqs. 12-14); the rest is what the paper leaves out.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from erdctl.plant.hooks import Hooks

FOREVER = 1e300  # a time or a stroke that is never reached [s], [m]


class Side(NamedTuple):
    """The paper's parameters for one direction of motion."""

    k_nom: float  # gas stiffness [N/m]
    c_vis: float  # viscous damping [N s/m]
    T_d: float  # time constant of the yield force [s]
    sigma: float  # yield force at full duty [N]
    beta: float  # exponent of the duty [1]


class Physics(NamedTuple):
    """What a damper does beyond the paper, as an engineer would write it down."""

    gap: float = 0.0  # free play between rod and piston [m]
    mount: float = 0.0  # compliance of the mount in series [m/N]
    film: float = 0.0  # what damps the mount, and the play of its joint [N s/m]
    stop_high: float = FOREVER  # deflection at which the bump stop is touched [m]
    stop_low: float = -FOREVER  # and the rebound stop [m]
    stop_rate: float = 0.0  # stiffness of the stops [N/m]
    stop_loss: float = 0.0  # of their damping, by depth and speed (Hunt and Crossley) [s/m]
    stop_depth: float = FOREVER  # over which that levels off, forever in the source [m]

    dead_time: float = 0.0  # between duty and voltage [s]
    slew: float = 0.0  # time that the supply needs over its full range [s]
    threshold: float = 0.0  # duty below which no chains form [1]
    screening: float = 0.0  # 1 / duty at which polarisation is exhausted [1]
    knee: float = 0.0  # sharpness of that, tanh at 0 [1]
    rise: float = 1.0  # factor on T_d while chains form [1]
    decay: float = 1.0  # factor on T_d while they dissolve [1]

    v_y: float = 0.0  # speed over which the yield force builds up [m/s]
    lead: float = 0.0  # deflection counted as speed in it [1/s]
    signed: float = 0.0  # 1: the lag of Eq. 12 acts on the force with its sign
    flow_index: float = 1.0  # exponent of the viscous law [1]
    v_ref: float = 1.0  # speed at which it equals c_vis xdot [m/s]
    turbulent: float = 0.0  # loss with the square of the speed [N s2/m2]
    mass: float = 0.0  # of fluid column and moving parts [kg]
    fluid_spring: float = 0.0  # compliance of the fluid column [m/N]
    void: float = 0.0  # largest void left by a compression stroke [m]
    void_growth: float = 1.0  # void per metre of compression, while there is none yet [1]
    bubbles: float = 0.05  # of the largest void, at which half of the force is back [1]
    heating: float = 0.0  # 1 / heat capacity [K/J]
    cooling: float = 0.0  # 1 / time constant to ambient [1/s]
    thin: float = 0.0  # relative loss of viscosity per kelvin [1/K]
    weaken: float = 0.0  # relative loss of yield stress per kelvin [1/K]

    F_c: float = 0.0  # dry friction of the seal [N]
    F_k: float = 0.0  # kinetic friction of a seal that sticks [N]
    F_s: float = 0.0  # its static friction [N]
    v_s: float = 1.0  # speed over which one goes over into the other [m/s]
    F_p: float = 0.0  # friction of a seal that first bends [N]
    x_p: float = 1.0  # by this much [m]

    preload: float = 0.0  # static gas force [N]
    closing: float = 0.0  # 1 / stroke at which the gas volume vanishes [1/m]
    polytropic: float = 1.4  # exponent of Eq. 3 [1]
    taper: float = 0.0  # relative change of damping per metre of stroke [1/m]
    groove: float = 0.0  # and per square metre [1/m2]

    onset: float = FOREVER  # of the faults, in the record's own time [s]
    ramp: float = 0.0  # over which they come in, each factor linear in time [s]
    oil: float = 1.0  # factor of Eq. 20 after it [1]
    electrical: float = 1.0  # of Eq. 22 [1]
    deformation: float = 1.0  # of Eq. 23 [1]


class Outside(NamedTuple):
    """Physics that no entry of the contract's table describes."""

    bumps: float = 0.0  # drag of an uneven bore [N]
    bump_pitch: float = 1.0  # its longest wave [m]
    bump_phase: float = 0.0  # [rad]
    swing: float = 0.0  # viscosity that swings with the duty, relative [1]
    swings: float = 1.0  # times over the full duty [1]
    settled: float = 0.0  # yield stress lost to sedimentation at the start [1]
    stirring: float = 1.0  # travel that brings it back [m]
    leakage: float = 0.0  # part of the voltage lost to leakage current, in the end [1]
    leakage_time: float = 1.0  # time over which it grows with the voltage on [s]
    ripple: float = 0.0  # relative ripple of the field [1]
    ripple_rate: float = 1.0  # [Hz]
    memory: float = 0.0  # force that remembers the speed [N]
    memory_short: float = 1.0  # [s]
    memory_long: float = 1.0  # [s]
    memory_speed: float = 1.0  # [m/s]
    bleed: float = 0.0  # part of the force left beyond the bleed valve's closing pressure, off at 0
    bleed_opens: float = FOREVER  # compression force that opens it [N]
    bleed_closes: float = FOREVER  # and lets it close again [N]
    chatter: float = 0.0  # stiffness of a seal that sticks and slips [N/m]
    chatter_break: float = 1.0  # stretch at which it breaks loose [m]
    chatter_slip: float = 0.5  # distance that it then springs back [m]
    wear: float = 0.0  # drag of a running-in bore [N]
    wear_travel: float = 1.0  # travel over one spot that takes it off [m]
    wear_span: float = 1.0  # half the stroke that is mapped [m]
    gas_heat: float = 0.0  # stiffness of the gas that heat exchange lets relax [N/m]
    gas_heat_time: float = 1.0  # [s]


class ForceChannel(NamedTuple):
    """What the force channel does to the force."""

    skew: float = 0.0  # recorded later than the motion [s]
    drift: float = 0.0  # of its zero [N/s]
    ring_rate: float = 0.0  # natural frequency of the load cell, off at 0 [Hz]
    ring_damping: float = 1.0  # its damping ratio [1]
    clip_high: float = FOREVER  # ends of the range [N]
    clip_low: float = -FOREVER
    step: float = 0.0  # quantisation [N]


class Own(NamedTuple):
    """Physics from a twin's own file, and its parameters: symbol and value."""

    hooks: Hooks
    values: tuple[tuple[str, float], ...]


class Plant(NamedTuple):
    """A damper, what the paper leaves out of it, and its force channel."""

    compression: Side
    release: Side
    physics: Physics = Physics()
    outside: Outside = Outside()
    channel: ForceChannel = ForceChannel()
    own: tuple[Own, ...] = ()

    def plain(self) -> Plant:
        """The same damper as the paper has it."""
        return Plant(self.compression, self.release)

    def with_physics(self, **values: float) -> Plant:
        """The same with other physics."""
        return self._replace(physics=self.physics._replace(**values))

    def with_outside(self, **values: float) -> Plant:
        """The same with physics from outside the table."""
        return self._replace(outside=self.outside._replace(**values))

    def with_channel(self, **values: float) -> Plant:
        """The same behind another force channel."""
        return self._replace(channel=self.channel._replace(**values))

    def with_own(self, hooks: Hooks, **values: float) -> Plant:
        """The same with physics from a twin's own file."""
        kept = tuple(o for o in self.own if o.hooks.name != hooks.name)
        return self._replace(own=(*kept, Own(hooks, tuple(values.items()))))

    def own_values(self, name: str) -> dict[str, float]:
        """Parameters of the physics from a twin's own file; KeyError if the damper has none."""
        return dict({o.hooks.name: o.values for o in self.own}[name])


def canonical(values: Any) -> Any:
    """The same named tuple with nothing but floats, so that compiled code sees one type."""
    if isinstance(values, tuple):
        return type(values)(*(canonical(v) for v in values))
    return float(values)

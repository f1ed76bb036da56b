"""The parameters of an ER damper from its geometry and fluid, Eqs. 1-5, 8-11 and 14.

    F = P_a(x) A_s + (A_p - A_s) dP_d                                                 (4)
    dP_d = 6 mu L_d / (pi d^3 R_d) Q + c L_d / d tau_y sign(Q)                           (8)

Where the paper's equations do not fit together dimensionally, the physical form stands here and
the docstring names the difference. Source: Sec. 3.1; the static model follows Choi et al. [9].
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array

# 100 % duty on the amplifiers of Table 1.
FULL_SCALE_VOLTAGE = 5000.0


@dataclass(frozen=True, kw_only=True)
class Geometry:
    """Dimensions, gas, fluid and supply of an ER damper, in SI units; `check` validates them.

    A_p : piston area [m^2];  A_s : piston shaft (rod) area [m^2], below A_p
    L_d : length of the annular duct [m];  d : its gap [m];  R_d : its mean radius [m]
    d_e : distance between the electrodes [m], the gap d unless they are coated
    P_0 : absolute gas pressure at x = 0 [Pa];  V_0 : gas volume at x = 0 [m^3]
    gamma : polytropic exponent of the gas [1], 1 (isothermal) to 1.67; the paper calls it a
        "thermal expansion coefficient"
    mu : viscosity with no field [Pa s];  c : velocity profile coefficient [1], about 2 to 3
    alpha : yield stress at a field of 1 V/m [Pa (m/V)^beta];  beta : exponent of the field [1]
    U_m : voltage at full duty [V]
    stroke : largest compression [m], 0 if unknown; the gas must not be used up there
    """

    A_p: float
    A_s: float
    L_d: float
    d: float
    R_d: float
    d_e: float
    P_0: float
    V_0: float
    gamma: float
    mu: float
    c: float
    alpha: float
    beta: float
    U_m: float = FULL_SCALE_VOLTAGE
    stroke: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Derived:
    """The paper's parameters that follow from a geometry, the same for either direction.

    k_nom [N/m], c_vis [N s/m], sigma [N], beta [1]; preload P_0 A_s [N], which Eq. 14 leaves out.
    T_d does not follow from a geometry: Eq. 12 is empirical.
    """

    k_nom: float
    c_vis: float
    sigma: float
    beta: float
    preload: float


def derive(geometry: Geometry, *, file: str | None = None) -> Derived:
    """The paper's parameters of a geometry.

    file : named in the message if the geometry makes no sense.  Raises InputProblem.

    Check: the values of `gas_stiffness`, `viscous_damping`, `full_yield_force` and `preload`, 250,
    85.94, 12 and 25.
    >>> length = {"L_d": 0.1, "d": 1e-3, "R_d": 0.01, "d_e": 1e-3}
    >>> gas = {"A_p": 3.5e-4, "A_s": 0.5e-4, "P_0": 5e5, "V_0": 7e-6, "gamma": 1.4, "stroke": 0.0}
    >>> fluid = {"mu": 0.05, "c": 2.0, "alpha": 0.2, "beta": 0.5, "U_m": 1000.0}
    >>> found = derive(geometry(**length, **gas, **fluid))
    >>> [round(v, 2) for v in (found.k_nom, found.c_vis, found.sigma, found.preload)]
    [250.0, 85.94, 12.0, 25.0]
    """
    check(geometry, file=file)
    try:
        k, c, sigma, P = (
            f(geometry) for f in (gas_stiffness, viscous_damping, full_yield_force, preload)
        )
    except ArithmeticError:  # a power too high, a gap whose cube is 0
        k = c = sigma = P = math.inf
    if not all(map(math.isfinite, (k, c, sigma, P))):
        raise InputProblem(
            "these dimensions give a stiffness, damping or force beyond any number; look for a"
            " wrong unit or power of ten",
            file=file,
        )
    return Derived(k_nom=k, c_vis=c, sigma=sigma, beta=geometry.beta, preload=P)


def check(geometry: Geometry, *, file: str | None = None) -> None:
    """Raise InputProblem unless the geometry is physically possible."""
    g = geometry
    for f in fields(g):
        value = getattr(g, f.name)
        least = 0.0 if f.name == "stroke" else math.nextafter(0.0, 1.0)
        if not (math.isfinite(value) and value >= least):
            expected = "0 or more" if f.name == "stroke" else "more than 0"
            raise InputProblem(f"{f.name} = {value:g}; expected {expected}, in SI units", file=file)
    if g.A_s >= g.A_p:
        raise InputProblem(
            f"shaft area A_s = {g.A_s:g} m^2 is not below piston area A_p = {g.A_p:g} m^2; "
            "are the two exchanged?",
            file=file,
        )
    if g.d >= g.R_d:
        raise InputProblem(
            f"duct gap d = {g.d:g} m is not below its radius R_d = {g.R_d:g} m; "
            "Eq. 5 holds for a thin annulus, are the two exchanged?",
            file=file,
        )
    if g.gamma < 1.0:
        raise InputProblem(
            f"gamma = {g.gamma:g}; expected the polytropic exponent of the gas, 1 or more "
            "(1.4 for air or nitrogen compressed quickly)",
            file=file,
        )
    if g.A_s * g.stroke >= g.V_0:
        raise InputProblem(
            f"a stroke of {g.stroke:g} m displaces A_s stroke = {g.A_s * g.stroke:g} m^3, "
            f"all of the gas volume V_0 = {g.V_0:g} m^3; expected less",
            file=file,
        )


def gas_pressure(geometry: Geometry, x: Array) -> Array:
    """Pressure of the gas chamber, Eq. 3.

        P_a = P_0 (V_0 / (V_0 - A_s x))^gamma

    x : (n,) deflection [m], positive in compression.  Returns (n,) [Pa].
    Raises InputProblem where the shaft displaces all the gas.
    Check: half the volume displaced, gamma = 1: twice P_0; gamma = 1.4: 2^1.4 = 2.639 times.
    >>> half = np.array([0.5])  # of V_0 / A_s
    >>> [gas_pressure(geometry(gamma=gamma), half).round(3).tolist() for gamma in (1.0, 1.4)]
    [[2.0], [2.639]]
    """
    left = 1.0 - geometry.A_s * x / geometry.V_0
    if np.any(left <= 0):
        raise InputProblem(
            f"x reaches {np.max(x):g} m, where A_s x is the whole gas volume V_0; "
            f"expected x below {geometry.V_0 / geometry.A_s:g} m"
        )
    pressure: Array = geometry.P_0 * left**-geometry.gamma
    return pressure


def flow(geometry: Geometry, xdot: Array) -> Array:
    """Volume flow through the duct, Q = (A_p - A_s) xdot.

    Remark 1 takes the flow as "equivalent to" the velocity; the area between them is kept here.

    xdot : (n,) [m/s].  Returns (n,) [m^3/s].
    Check: 3.5 less 0.5 cm^2, 0.1 m/s give 3e-5 m^3/s.
    >>> flow(geometry(A_p=3.5e-4, A_s=0.5e-4), np.array([0.1])).round(9).tolist()
    [3e-05]
    """
    Q: Array = (geometry.A_p - geometry.A_s) * xdot
    return Q


def field(geometry: Geometry, duty: Array) -> Array:
    """Magnitude of the electric field, Eq. 10 without its sign.

        |E| = U / d_e,   U = U_m v

    Eq. 10 has E = -U / d_e, and Eq. 11 raises it to a fractional power, which is complex. A yield
    stress does not depend on the polarity: |E| is meant.

    duty : (n,) [1].  Returns (n,) [V/m].
    Check: 20 % of 5 kV over 1 mm is 1e6 V/m.
    >>> field(geometry(U_m=5000.0, d_e=1e-3), np.array([0.2])).round(3).tolist()
    [1000000.0]
    """
    E: Array = np.abs(voltage(duty, geometry.U_m)) / geometry.d_e
    return E


def yield_stress(geometry: Geometry, E: Array) -> Array:
    """Yield stress of the fluid, Eq. 7: tau_y = alpha |E|^beta.

    E : (n,) [V/m].  Returns (n,) [Pa].
    Check: alpha = 0.2 Pa (m/V)^0.5, beta = 0.5, 1e6 V/m give 200 Pa.
    >>> yield_stress(geometry(alpha=0.2, beta=0.5), np.array([1e6])).round(9).tolist()
    [200.0]
    """
    tau_y: Array = geometry.alpha * np.abs(E) ** geometry.beta
    return tau_y


def pressure_drop(geometry: Geometry, Q: Array, tau_y: Array) -> Array:
    """Pressure drop of the annular duct, Eqs. 5 and 8.

        dP_d = 6 mu L_d / (pi d^3 R_d) Q + c L_d / d tau_y sign(Q)

    A slit of width 2 pi R_d and gap d: 12 mu L_d Q / (2 pi R_d d^3). Eq. 8 omits the sign, which
    Eq. 9 has. Eq. 6 writes tau = mu Q + tau_y; mu multiplies a shear rate [1/s], not a flow, and
    the integration over the gap turns that shear rate into the factors of Eq. 5.

    Q : (n,) [m^3/s];  tau_y : (n,) [Pa].  Returns (n,) [Pa].
    Check: mu = 0.05 Pa s, L_d = 0.1 m, d = 1 mm, R_d = 1 cm, Q = pi 1e-5 m^3/s: 0.03 / 1e-11 *
    1e-5 = 3e4 Pa; tau_y = 200 Pa with c = 2: 4e4 Pa more, 7e4.
    >>> g = geometry(mu=0.05, L_d=0.1, d=1e-3, R_d=0.01, c=2.0)
    >>> pressure_drop(g, np.full(2, np.pi * 1e-5), np.array([0.0, 200.0])).round(6).tolist()
    [30000.0, 70000.0]
    """
    g = geometry
    drop: Array = _resistance(g) * Q + g.c * g.L_d / g.d * tau_y * np.sign(Q)
    return drop


def static_force(geometry: Geometry, x: Array, xdot: Array, duty: Array) -> Array:
    """Force in steady flow, Eqs. 4 and 9.

        F = P_a A_s + (A_p - A_s) dP_d

    Eq. 9 drops both area factors of its viscous term (one from Eq. 4, one from the flow of Eq. 5).
    Unlike Eq. 14 this contains the preload P_0 A_s. The atmosphere on the shaft's end, which
    carries p_atm A_s of it, is left out as in the paper.

    x, xdot, duty : (n,) [m], [m/s], [1].  Returns (n,) [N].
    Check: x = xdot = 0 gives P_0 A_s, 5 bar on 0.5 cm^2 or 25 N.
    >>> at_rest = np.zeros(1)
    >>> static_force(geometry(P_0=5e5, A_s=0.5e-4), at_rest, at_rest, at_rest).round(9).tolist()
    [25.0]
    """
    g = geometry
    drop = pressure_drop(g, flow(g, xdot), yield_stress(g, field(g, duty)))
    force: Array = gas_pressure(g, x) * g.A_s + (g.A_p - g.A_s) * drop
    return force


def viscous_damping(geometry: Geometry) -> float:
    """Damping with no field.

        c_vis = 6 mu L_d (A_p - A_s)^2 / (pi d^3 R_d)

    Below Eq. 13 the paper gives it without the area, [Pa s/m^3], and Table 2 in N s/m^2; in both
    it multiplies a velocity to give a force.

    Returns [N s/m].
    Check: mu = 0.05 Pa s, L_d = 0.1 m, d = 1 mm, R_d = 1 cm, A_p - A_s = 3 cm^2:
    0.03 * 9e-8 / (pi 1e-11) = 270 / pi = 85.94.
    >>> g = geometry(mu=0.05, L_d=0.1, d=1e-3, R_d=0.01, A_p=3.5e-4, A_s=0.5e-4)
    >>> round(viscous_damping(g), 2)
    85.94
    """
    return _resistance(geometry) * (geometry.A_p - geometry.A_s) ** 2


def full_yield_force(geometry: Geometry) -> float:
    """Yield force at full duty, Eq. 11.

        sigma = (A_p - A_s) c L_d / d alpha (U_m / d_e)^beta

    Eq. 11 has (-U_m / d_e)^beta, complex for a fractional beta; see `field`. Table 2 prints no
    unit, and Eqs. 19, 27 and 35 call it delta.

    Returns [N].
    Check: A_p - A_s = 3 cm^2, c = 2, L_d / d = 100, alpha = 0.2, beta = 0.5, 1e6 V per m:
    3e-4 * 200 * 200 = 12.
    >>> g = geometry(A_p=3e-4, A_s=0.0, c=2.0, L_d=0.1, d=1e-3, alpha=0.2, beta=0.5, U_m=1e6)
    >>> round(full_yield_force(g), 9)
    12.0
    """
    g = geometry
    sigma: float = (g.A_p - g.A_s) * g.c * g.L_d / g.d * g.alpha * (g.U_m / g.d_e) ** g.beta
    return sigma


def gas_stiffness(geometry: Geometry) -> float:
    """Stiffness of the gas at x = 0: the k_nom of Eq. 14 as the slope of Eq. 3.

        k_nom = gamma P_0 A_s^2 / V_0

    Returns [N/m].
    Check: gamma = 1.4, 5 bar, A_s = 0.5 cm^2, V_0 = 7 cm^3: 1.4 * 5e5 * 2.5e-9 / 7e-6 = 250.
    >>> round(gas_stiffness(geometry(gamma=1.4, P_0=5e5, A_s=0.5e-4, V_0=7e-6)), 9)
    250.0
    """
    return geometry.gamma * geometry.P_0 * geometry.A_s**2 / geometry.V_0


def preload(geometry: Geometry) -> float:
    """Static force of the gas at x = 0, P_0 A_s [N], which Eq. 14 leaves out.

    Check: 5 bar on 0.5 cm^2 is 25 N.
    >>> round(preload(geometry(P_0=5e5, A_s=0.5e-4)), 9)
    25.0
    """
    return geometry.P_0 * geometry.A_s


def voltage(duty: Array, U_m: float = FULL_SCALE_VOLTAGE) -> Array:
    """Voltage at a duty cycle, U = U_m v (Table 1).

    duty : (n,) [1];  U_m : [V].  Returns (n,) [V].
    Check: 40 % of 5 kV is 2 kV.
    >>> voltage(np.array([0.4])).tolist()
    [2000.0]
    """
    U: Array = U_m * duty
    return U


def _resistance(geometry: Geometry) -> float:
    """dP_d / Q of Eq. 5 [Pa s/m^3]."""
    g = geometry
    return 6 * g.mu * g.L_d / (math.pi * g.d**3 * g.R_d)
